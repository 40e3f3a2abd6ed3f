"""The command line: which commands there are, and how an error becomes one plain line."""

import sys
import traceback
from collections.abc import Sequence

import typer

from app.cli import (
    calibrate,
    convert,
    demo,
    doctor,
    exchange,
    load,
    power,
    report,
    reproduce,
    serve,
    simulate,
    study,
    sweep,
    trial,
)
from data.errors import ElbowroomError
from data.private_parts import installed_version

OWN_PACKAGES = ("app", "analysis", "data", "sim_trials")
"""A failed import of one of these is a fault of Elbowroom, not of what is installed."""

cli = typer.Typer(
    name="elbowroom",
    help="Find out which robot controller people prefer, and why.",
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
)
cli.command("demo")(demo.demo)
cli.command("serve")(serve.serve)
cli.command("simulate")(simulate.simulate)
cli.command("trial")(trial.trial)
cli.command("sweep")(sweep.sweep)
cli.command("power")(power.power)
cli.command("load")(load.load)
cli.command("calibrate")(calibrate.calibrate)
cli.command("reproduce")(reproduce.reproduce)
cli.command("report")(report.report)
cli.command("convert")(convert.convert)
cli.command("export")(exchange.export)
cli.command("import")(exchange.import_)
cli.add_typer(study.cli, name="study")
cli.command("doctor")(doctor.doctor)


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line and exit: 0 done, 1 failed, 2 wrong input."""
    sys.exit(run(arguments))


def run(arguments: Sequence[str] | None = None) -> int:
    """Run one command; whatever the user can act on is one line on stderr and an exit code."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    try:
        code = cli(args=given or ["--help"], prog_name="elbowroom", standalone_mode=False)
    except (typer.Abort, KeyboardInterrupt):
        return _fail("interrupted", 130)
    except typer.TyperException as error:
        message = getattr(error, "format_message", error.__str__)
        return _fail(message(), 2)
    except ElbowroomError as error:
        return _fail(str(error), error.exit_code)
    except ImportError as error:
        package = _package_that_failed(error)
        if package in OWN_PACKAGES:
            raise
        version = installed_version(package)
        return _fail(f"{package} {version} cannot be imported: {error} (`elbowroom doctor` says more)", 1)
    except BrokenPipeError:
        return 1
    return code if isinstance(code, int) else 0


def _package_that_failed(error: ImportError) -> str:
    """The top-level package that cannot be imported: the one named, else the one that raised."""
    if error.name:
        return error.name.partition(".")[0]
    frames = list(traceback.walk_tb(error.__traceback__))
    return str(frames[-1][0].f_globals.get("__name__", "")).partition(".")[0]


def _fail(message: str, code: int) -> int:
    print(f"elbowroom: {' '.join(message.split())}", file=sys.stderr)
    return code
