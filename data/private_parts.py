"""Parts of other packages that are no public interface: one plain line where an installed version lacks them.

Which version has them is known only by looking. Each place that uses such a part says so by `require`, and
``tests/test_private_parts.py`` looks at all of them.
"""

from importlib import metadata

from data.errors import ElbowroomError


def installed_version(package: str) -> str:
    """The installed version of a distribution; "of unknown version" without metadata."""
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return "of unknown version"


def unsuitable(package: str, lacks: str, install: str = "") -> ElbowroomError:
    """The error for an installed package that lacks a part.

    Parameters
    ----------
    package : str
        The distribution's name.
    lacks : str
        What it lacks, e.g. ``no MjModel._address``.
    install : str
        The requirement that is known to work, if another one than Elbowroom's own.
    """
    remedy = f"pip install '{install}'" if install else "install an earlier version of it"
    return ElbowroomError(
        f"{package} {installed_version(package)} is installed, which Elbowroom cannot use ({lacks}): {remedy}"
    )


def require(package: str, owner: object, *names: str, install: str = "") -> None:
    """Make sure that parts are there before they are used.

    Raises
    ------
    ElbowroomError
        Naming the package, its version and the first part that it lacks.
    """
    for name in names:
        if not hasattr(owner, name):
            of = getattr(owner, "__qualname__", getattr(owner, "__name__", type(owner).__qualname__))
            raise unsuitable(package, f"it has no {of}.{name}", install)
