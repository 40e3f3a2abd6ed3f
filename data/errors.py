"""The errors of every package, each with the exit code the command line gives it."""


class ElbowroomError(Exception):
    """Something the user can act on, said in one plain line.

    Attributes
    ----------
    exit_code : int
        What the command line exits with: 1, the job failed.
    """

    exit_code = 1


class InputError(ElbowroomError):
    """Wrong input: the line names where and what is valid, and nothing was written."""

    exit_code = 2


def one_of(what: str, given: object, valid: list[str] | tuple[str, ...]) -> InputError:
    """The error for a name that does not exist, listing those that do."""
    return InputError(f"{what}: {given!r} is not one of: {', '.join(valid)}")
