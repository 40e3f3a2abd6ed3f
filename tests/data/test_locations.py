"""Files and folders come into being whole or not at all."""

import errno
import os
from pathlib import Path

import pytest

from data.errors import ElbowroomError, InputError
from data.locations import atomic_write, check_folder, default_store, writing_folder


def fill(folder: Path, **files: str) -> None:
    for name, text in files.items():
        (folder / name.replace("_", ".")).write_text(text)


def listing(folder: Path) -> dict[str, str]:
    return {p.name: p.read_text() for p in folder.iterdir() if p.is_file()}


@pytest.mark.parametrize("exists", [False, True])
def test_a_folder_is_there_with_everything_in_it(tmp_path, exists):
    out = tmp_path / "a" / "out"
    if exists:
        out.mkdir(parents=True)
    with writing_folder(out, marker="m.txt", owns=("m.txt", "a.txt")) as folder:
        fill(folder, m_txt="1", a_txt="2")
        assert not (out / "m.txt").exists()
    assert listing(out) == {"m.txt": "1", "a.txt": "2"}
    assert [p.name for p in out.parent.iterdir()] == ["out"]


@pytest.mark.parametrize("exists", [False, True])
def test_a_failure_leaves_things_as_they_were(tmp_path, exists):
    out = tmp_path / "out"
    if exists:
        out.mkdir()
        fill(out, m_txt="old", a_txt="old")

    def write_and_fail() -> None:
        with writing_folder(out, marker="m.txt", owns=("m.txt",)) as folder:
            fill(folder, m_txt="new")
            raise KeyError

    with pytest.raises(KeyError):
        write_and_fail()
    assert [p.name for p in tmp_path.iterdir()] == (["out"] if exists else [])
    if exists:
        assert listing(out) == {"m.txt": "old", "a.txt": "old"}


def test_what_the_writer_owns_and_did_not_write_again_is_removed(tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    fill(out, m_txt="old", a_txt="old", mine_txt="mine")
    (out / "d").mkdir()
    with writing_folder(out, marker="m.txt", owns=("m.txt", "a.txt", "d")) as folder:
        fill(folder, m_txt="new")
    assert listing(out) == {"m.txt": "new", "mine.txt": "mine"}
    assert not (out / "d").exists()


def test_an_interrupted_replacement_keeps_the_marker_of_the_earlier_result(tmp_path, monkeypatch):
    out = tmp_path / "out"
    out.mkdir()
    fill(out, m_txt="old", z_txt="old")
    replace = Path.replace

    def fails_at_z(path: Path, target: Path) -> Path:
        if path.name == "z.txt":
            raise OSError(errno.EIO, "Input/output error")
        return replace(path, target)

    monkeypatch.setattr(Path, "replace", fails_at_z)
    with (
        pytest.raises(ElbowroomError, match="input/output error"),
        writing_folder(out, marker="m.txt", owns=("m.txt", "z.txt")) as folder,
    ):
        fill(folder, m_txt="new", z_txt="new")
    assert listing(out) == {"m.txt": "old", "z.txt": "old"}


def test_a_full_disk_is_one_line_with_exit_code_1(tmp_path):
    with (
        pytest.raises(ElbowroomError, match=r"out: cannot be written: the disk is full$") as raised,
        writing_folder(tmp_path / "out", marker="m", owns=()),
    ):
        raise OSError(errno.ENOSPC, "No space left on device")
    assert raised.value.exit_code == 1
    assert list(tmp_path.iterdir()) == []


def test_a_name_taken_by_a_file_is_wrong_input(tmp_path):
    (tmp_path / "file").touch()
    for out in (tmp_path / "file", tmp_path / "file" / "below"):
        with pytest.raises(InputError, match="is a file, not a folder"):
            check_folder(out)
        with (
            pytest.raises(InputError, match="is a file, not a folder"),
            writing_folder(out, marker="m", owns=()),
        ):
            pass


def test_a_place_where_nothing_can_be_written_is_a_failure():
    for write in (
        lambda: check_folder(Path("/proc/out")),
        lambda: atomic_write(Path("/proc/out"), b""),
        lambda: writing_folder(Path("/proc/out"), marker="m", owns=()).__enter__(),
    ):
        with pytest.raises(ElbowroomError, match="cannot be written") as raised:
            write()
        assert raised.value.exit_code == 1


def test_checking_a_folder_leaves_nothing_behind(tmp_path):
    check_folder(tmp_path / "new" / "folder")
    check_folder(tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_a_file_is_replaced_whole_or_not_at_all(tmp_path, monkeypatch):
    path = tmp_path / "file"
    atomic_write(path, b"old")

    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    with pytest.raises(ElbowroomError, match="the disk is full"):
        atomic_write(path, b"new")
    assert path.read_bytes() == b"old"
    assert [p.name for p in tmp_path.iterdir()] == ["file"]


def test_the_default_store_of_a_checkout_is_in_it():
    assert default_store() == Path(__file__).resolve().parents[2] / "data" / "local" / "elbowroom.sqlite"


def test_the_default_store_of_an_installation_is_the_users(tmp_path, monkeypatch):
    monkeypatch.setattr("data.locations.CHECKOUT", tmp_path)
    assert default_store().name == "elbowroom.sqlite"
    assert Path.home() in default_store().parents


def test_a_file_never_takes_the_place_of_a_pipe(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    with pytest.raises(InputError, match="is a device or a pipe, not a file"):
        atomic_write(pipe, b"new")
    assert pipe.is_fifo()
    assert list(tmp_path.iterdir()) == [pipe]


def test_a_link_stays_and_the_file_that_it_leads_to_is_written(tmp_path):
    (tmp_path / "folder").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "folder" / "file")
    atomic_write(tmp_path / "link", b"new")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "folder" / "file").read_bytes() == b"new"
