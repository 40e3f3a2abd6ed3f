"""Where things are kept by default, and how a file or a folder comes into being whole or not at all."""

import errno
import os
import shutil
import tempfile
from collections.abc import Collection, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import platformdirs

from data.errors import ElbowroomError, InputError

CHECKOUT = Path(__file__).resolve().parent.parent
"""The folder above the packages: a checkout, if it also holds the project's ``pyproject.toml``."""


def default_store() -> Path:
    """The store that is used when none is named.

    ``data/local/elbowroom.sqlite`` in a checkout, else ``elbowroom.sqlite`` in the user's data folder.
    """
    if (CHECKOUT / "pyproject.toml").is_file() and (CHECKOUT / "tests").is_dir():
        return CHECKOUT / "data" / "local" / "elbowroom.sqlite"
    return Path(platformdirs.user_data_dir("elbowroom", appauthor=False)) / "elbowroom.sqlite"


def cannot_write(place: Path, error: OSError) -> ElbowroomError:
    """The one line for a place that cannot be written: full, read-only, forbidden."""
    if error.errno == errno.ENOSPC:
        return ElbowroomError(f"{place}: cannot be written: the disk is full")
    reason = (error.strerror or str(error)).splitlines()[0]
    return ElbowroomError(f"{place}: cannot be written: {reason[0].lower()}{reason[1:]}")


def check_folder(out: Path, marker: str | None = None) -> None:
    """Find out that a folder can be written, before any expensive work starts; nothing stays behind.

    Parameters
    ----------
    out : Path
    marker : str, optional
        As `writing_folder` will be given it, if the whole folder is to be the result.

    Raises
    ------
    InputError
        If the name is taken by something that is no folder, or by a folder with other contents.
    ElbowroomError
        If the folder, or the one it is to be made in, cannot be written.
    """
    _refuse_what_is_no_folder(out)
    if marker is not None:
        _refuse_other_contents(out, marker)
    try:
        nearest = next(place for place in (out, *out.absolute().parents) if place.is_dir())
        with tempfile.TemporaryFile(dir=nearest) as probe:
            probe.write(b"elbowroom")
            probe.flush()
            os.fsync(probe.fileno())
    except OSError as error:
        raise cannot_write(out, error) from None


def atomic_write(path: Path, content: bytes) -> None:
    """Write a file so that its name only ever leads to the whole of it, synced to the disk.

    A link stays a link: the file that it leads to is written.

    Raises
    ------
    InputError
        If the name is that of a device or a pipe, which a file would take the place of.
    ElbowroomError
        If it cannot be written; the name is then as it was before.
    """
    if path.exists() and not path.is_file() and not path.is_dir():
        raise InputError(f"{path}: is a device or a pipe, not a file")
    path = Path(os.path.realpath(path))
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=path.parent, prefix=".partial-", delete=False) as partial:
            try:
                partial.write(content)
                partial.flush()
                os.fsync(partial.fileno())
                Path(partial.name).chmod(0o644)
                Path(partial.name).replace(path)
            except BaseException:
                with suppress(OSError):
                    Path(partial.name).unlink()
                raise
        sync_folder(path.parent)
    except OSError as error:
        raise cannot_write(path, error) from None


def sync_folder(folder: Path) -> None:
    """Put a folder's list of names on the disk, so that a new file survives a power cut."""
    if os.name == "nt":
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


@contextmanager
def writing_folder(out: Path, *, marker: str, owns: Collection[str]) -> Iterator[Path]:
    """A folder to fill that takes the place of ``out`` when the block ends well, and vanishes if not.

    A new ``out`` appears in one step. An existing one keeps whatever the writer does not own: the
    writer's files are replaced one after the other, the marker last, once all of them are complete.

    Parameters
    ----------
    out : Path
        Where the result is to be.
    marker : str
        A file that tells an earlier result of the same kind; a folder with other contents is refused.
    owns : collection of str
        Names in the folder that belong to the writer; those that it did not write this time are removed.

    Raises
    ------
    InputError
        If ``out`` is no folder, or not empty without being an earlier result.
    ElbowroomError
        If the disk is full or the place cannot be written.
    """
    _refuse_what_is_no_folder(out)
    exists = out.is_dir()
    try:
        _refuse_other_contents(out, marker)
        home = out if exists else out.absolute().parent
        home.mkdir(parents=True, exist_ok=True)
        partial = Path(tempfile.mkdtemp(dir=home, prefix=f".{out.name}.partial-"))
    except OSError as error:
        raise cannot_write(out, error) from None
    try:
        yield partial
        if exists:
            _take_over(partial, out, marker, owns)
        else:
            partial.chmod(0o755)
            partial.rename(out)
        sync_folder(home)
    except OSError as error:
        raise cannot_write(out, error) from None
    finally:
        shutil.rmtree(partial, ignore_errors=True)


def _take_over(partial: Path, out: Path, marker: str, owns: Collection[str]) -> None:
    new = {entry.name for entry in partial.iterdir()}
    for name in sorted(new | set(owns), key=lambda name: (name == marker, name)):
        target = out / name
        if target.is_dir() and not target.is_symlink():
            shutil.rmtree(target)
        elif name not in new:
            target.unlink(missing_ok=True)
        if name in new:
            (partial / name).replace(target)


def _visible(folder: Path) -> Iterator[Path]:
    return (entry for entry in folder.iterdir() if not entry.name.startswith("."))


def _refuse_other_contents(out: Path, marker: str) -> None:
    if out.is_dir() and not (out / marker).is_file() and any(_visible(out)):
        raise InputError(
            f"{out}: the folder is not empty and holds no earlier result ({marker}); name another one"
        )


def _refuse_what_is_no_folder(out: Path) -> None:
    for place in (out, *out.parents):
        if place.exists() and not place.is_dir():
            raise InputError(f"{out}: {place} is a file, not a folder")
