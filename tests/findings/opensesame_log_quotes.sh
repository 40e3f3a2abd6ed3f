#!/usr/bin/env bash
# OpenSesame's log files (opensesame-core): two dialects of CSV under one name and layout.
#
# Up to 4.0.24 a quotation mark in a cell is written as \" (a backslash itself is not escaped), from 4.0.37 on
# as "" (RFC 4180). Nothing in the file says which version wrote it. Python's csv module, which follows RFC 4180,
# reads the older file without an error, with more cells in a row than the header has: every later column is
# shifted. Told of the backslash, it reads the older file right and the newer one wrong: a Windows path's
# backslashes are gone.
#
# Seen: 4.0.24 (4 columns): ['4', '6', '4'] cells; 4.0.37: ['4', '4', '4'] cells.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

for version in 4.0.24 4.0.37; do
  python3 -m pip install -q --no-deps --target "$version" "opensesame-core==$version" 2>/dev/null
  PYTHONPATH="$folder/$version" python3 - "$version" <<'PYTHON'
import os
import sys

from openexp._log.csv import Csv


class Variables(dict):
    """What the log asks of an experiment's variables."""

    def get(self, name, default=None, _eval=True):
        return dict.get(self, name, default)


class Experiment:
    def __init__(self):
        self.var, self.data_files, self.experiment_path = Variables(), [], None


experiment = Experiment()
log = Csv(experiment, os.path.abspath(f"log-{sys.argv[1]}.csv"))
names = ["comment", "logfile", "response", "subject_nr"]
for comment in ('smooth', 'M1 "jerks", "sticks", M2 not', 'none'):
    experiment.var.update(
        comment=comment, logfile="C:\\data\\subject-1.csv", response="left", subject_nr=1
    )
    log.write_vars(names)
log.close()
PYTHON
done

python3 - <<'PYTHON'
import csv


def cells(version, **dialect):
    with open(f"log-{version}.csv", newline="") as file:
        header, *rows = csv.reader(file, **dialect)
    return header, rows


header, older = cells("4.0.24")
assert len(header) == 4
print("4.0.24, RFC 4180:", [str(len(row)) for row in older])
assert [len(row) for row in older] == [4, 6, 4], older
_, newer = cells("4.0.37")
print("4.0.37, RFC 4180:", [str(len(row)) for row in newer])
assert [len(row) for row in newer] == [4, 4, 4], newer
assert newer[1] == ['M1 "jerks", "sticks", M2 not', "C:\\data\\subject-1.csv", "left", "1"]
_, escaped = cells("4.0.24", escapechar="\\", doublequote=False)
assert escaped[1][0] == 'M1 "jerks", "sticks", M2 not', escaped
assert escaped[0][1] == "C:datasubject-1.csv", escaped
print("4.0.24, told of the backslash:", escaped[0][1])
PYTHON
echo "as described"
