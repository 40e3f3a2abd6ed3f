#!/usr/bin/env bash
# Frictionless (5.21.0) changes what other CSV readers in the same process accept.
#
# The first CSV file that it opens raises Python's csv.field_size_limit from 131,072 to 2,147,483,646 characters,
# for the whole process and for good; importing it does not. So what a reader based on Python's csv makes of a
# valid file with a long cell depends on whether something was validated before in the same process.
#
# Seen: 131072 131072 2147483646; "field larger than field limit (131072)", then 1 row.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q 'frictionless==5.21.0' 2>/dev/null

venv/bin/python - <<'PYTHON'
import csv
from pathlib import Path

Path("long.csv").write_text("mode,comment\nM1," + "a" * 200_000 + "\n")
Path("good.csv").write_text("mode,comment\nM1,fine\n")


def read():
    with open("long.csv", newline="") as file:
        return list(csv.reader(file))[1:]


before = csv.field_size_limit()
try:
    read()
    raise SystemExit("the file was read before")
except csv.Error as error:
    refusal = str(error)
import frictionless

imported = csv.field_size_limit()
assert frictionless.validate("good.csv").valid
after = csv.field_size_limit()
rows = read()
print(before, imported, after)
print(refusal, "; then", len(rows), "row")
assert (before, imported) == (131_072, 131_072)
assert after == 2_147_483_646, after
assert "larger than field limit" in refusal
assert len(rows) == 1
PYTHON
echo "as described"
