"""Reports, one after the other, until somebody ends it: what a researcher may do while people guide.

Run as ``python -m app.load.reports ANSWERS.csv STUDY.toml OUT``.
"""

import sys

from app.cli.main import run


def main(answers: str, study: str, out: str) -> None:
    """Fit reports for ever."""
    number = 0
    while True:
        number += 1
        run(["report", "--responses", answers, "--study", study, "--out", f"{out}-{number}"])


if __name__ == "__main__":
    main(*sys.argv[1:])
