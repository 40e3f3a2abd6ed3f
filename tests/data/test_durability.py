"""A store on a bad day: two processes at once, a killed one, a full disk, a wrong place."""

import os
import signal
import sqlite3
import subprocess
import sys
import threading
from contextlib import closing
from pathlib import Path

import pytest
from sqlalchemy import event

from data.errors import ElbowroomError, InputError
from data.store import Store
from data.study_file import study_text

JOIN = """
import sys
from data.store import Store
with Store.open(sys.argv[1]) as store:
    study = store.study()
    print("ready", flush=True)
    sys.stdin.readline()
    print(*[store.next_number(study, "human") for _ in range(20)])
"""

WRITE_UNTIL_KILLED = """
import sys
from datetime import UTC, datetime
from data.records import Participant
from data.store import Store
at = datetime(2026, 1, 1, tzinfo=UTC)
with Store.open(sys.argv[1]) as store:
    study = store.study()
    for number in range(1, 100_000):
        with store.transaction():
            store.add_participant(study, Participant(f"p{number}", number, "human", at))
            store.log("test", "joined", {"participant": f"p{number}"}, at)
        print(number, flush=True)
"""

OPEN = """
import sys
from data.store import Store
print("ready", flush=True)
sys.stdin.readline()
Store.open(sys.argv[1]).close()
"""


def python(code: str, *arguments: object) -> "subprocess.Popen[str]":
    root = Path(__file__).resolve().parents[2]
    return subprocess.Popen(
        [sys.executable, "-c", code, *map(str, arguments)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env=os.environ | {"PYTHONPATH": str(root)},
    )


def run_together(code: str, path: Path, processes: int = 2) -> list[str]:
    """The output of several processes that begin their work at once."""
    started = [python(code, path) for _ in range(processes)]
    for process in started:
        assert process.stdout.readline() == "ready\n"
    for process in started:
        process.stdin.write("go\n")
        process.stdin.flush()
    outputs = [process.communicate(timeout=120)[0] for process in started]
    assert [process.returncode for process in started] == [0] * processes
    return outputs


def test_two_processes_that_join_at_once_get_different_numbers(store, study):
    store.add_study(study, study_text("carmichael2017"))
    numbers = [int(n) for output in run_together(JOIN, store.address.file) for n in output.split()]
    assert sorted(numbers) == list(range(1, 41))


def test_two_processes_can_make_the_same_store_at_once(tmp_path):
    run_together(OPEN, tmp_path / "new.sqlite", 3)
    with Store.open(tmp_path / "new.sqlite", create=False) as store:
        assert store.studies() == ()


def test_a_new_store_waits_for_whoever_is_making_it(tmp_path):
    path = tmp_path / "study.sqlite"
    with closing(sqlite3.connect(path, check_same_thread=False, isolation_level=None)) as maker:
        maker.execute("CREATE TABLE making (it)")
        maker.execute("BEGIN IMMEDIATE")
        maker.execute("DROP TABLE making")
        done = threading.Timer(0.3, lambda: maker.execute("COMMIT"))
        done.start()
        Store.open(path).close()
        done.join()


def test_a_process_killed_while_it_writes_leaves_all_it_acknowledged(store, study):
    stored = store.add_study(study, study_text("carmichael2017"))
    store.close()
    process = python(WRITE_UNTIL_KILLED, store.address.file)
    acknowledged = 0
    while acknowledged < 25:
        acknowledged = int(process.stdout.readline())
    process.send_signal(signal.SIGKILL)
    acknowledged = int((process.communicate()[0].split() or [acknowledged])[-1])
    with Store.open(store.address.file, create=False) as reopened:
        people = len(reopened.participants(stored))
        assert people in (acknowledged, acknowledged + 1)
        assert len(reopened.audit_log()) == people
        assert reopened.verify_audit().is_intact
    with closing(sqlite3.connect(store.address.file)) as database:
        assert database.execute("PRAGMA integrity_check").fetchone() == ("ok",)


def test_a_full_disk_is_one_line_and_leaves_what_was_there(store, fill):
    stored = fill(store, 1)
    before = store.responses_table(stored).sha256
    store.close()
    with closing(sqlite3.connect(store.address.file)) as database:
        # Pages that a migration left free would be room.
        database.execute("VACUUM")

    @event.listens_for(store._engine, "connect")
    def no_room(connection, _):
        pages = connection.execute("PRAGMA page_count").fetchone()[0]
        connection.execute(f"PRAGMA max_page_count = {pages}")

    with pytest.raises(
        ElbowroomError, match=r"study\.sqlite: cannot be written: the disk is full$"
    ) as raised:
        fill(store, 20)
    assert raised.value.exit_code == 1
    assert store.responses_table(stored).sha256 == before


def test_a_read_only_store_is_one_line(store, fill):
    fill(store, 1)
    store.close()
    event.listen(store._engine, "connect", lambda c, _: c.execute("PRAGMA query_only = ON"))
    with pytest.raises(ElbowroomError, match=r"study\.sqlite: cannot be written: it is read-only$"):
        fill(store, 2)


def test_a_damaged_store_is_one_line(store, fill):
    fill(store, 2)
    store.close()
    content = bytearray(store.address.file.read_bytes())
    content[4096:] = b"\x07" * (len(content) - 4096)
    store.address.file.write_bytes(content)
    with pytest.raises(ElbowroomError) as raised:
        Store.open(store.address.file).studies()
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize(
    ("place", "message"),
    [
        ("mysql://user:secret@host/db", "valid: a path, sqlite:///PATH, postgresql"),
        ("sqlite://", "names no file"),
        ("sqlite:///:memory:", "names no file"),
        ("postgresql://", "cannot be used; valid:"),
        ("nonsense:store", "no database URL; valid:"),
        ("://", "no database URL; valid:"),
        ("", "is no path"),
        ("{tmp}", "is a folder"),
        ("{tmp}/text.sqlite", "not an Elbowroom store"),
        ("{tmp}/text.sqlite/below.sqlite", "no such store"),
        ("{tmp}/missing.sqlite", "no such store"),
        ("{tmp}/empty.sqlite", "it is empty"),
        ("/dev/null", "not an Elbowroom store"),
    ],
)
def test_a_wrong_place_is_one_line_of_wrong_input(tmp_path, place, message):
    (tmp_path / "text.sqlite").write_text("not a database, but some text")
    (tmp_path / "empty.sqlite").touch()
    with pytest.raises(InputError, match=message) as raised:
        Store.open(place.format(tmp=tmp_path), create=False)
    assert "\n" not in str(raised.value)
    assert "secret" not in str(raised.value)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["empty.sqlite", "text.sqlite"]


def test_a_store_is_not_made_below_a_file(tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(InputError, match=r"is not a folder$"):
        Store.open(tmp_path / "file" / "study.sqlite")


def test_a_folder_where_nothing_can_be_made_is_a_failure_and_not_wrong_input():
    with pytest.raises(ElbowroomError) as raised:
        Store.open("/proc/no/such/study.sqlite")
    assert raised.value.exit_code == 1
    assert "\n" not in str(raised.value)


def test_a_path_and_its_url_are_the_same_store(tmp_path, study):
    path = tmp_path / "a folder" / "my study.sqlite"
    with Store.open(path) as store:
        store.add_study(study, study_text("carmichael2017"))
    with Store.open(f"sqlite:///{path}", create=False) as store:
        assert len(store.studies()) == 1
        assert store.recordings_folder == path.with_name("my study.recordings")
