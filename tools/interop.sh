#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# usage: tools/interop.sh EWA DATA [NAME...]
#
# Compares what ewa reads and writes with what other programs do, value by value: tools/interop/NAME.py, all of them by
# default, each called with EWA and DATA. The packages they need come from PyPI into a virtual environment in build/.
set -eu
ewa=$1
data=$2
shift 2
here=$(dirname "$0")/interop
venv=build/interop
packages="numpy laspy lazrs laszip plyfile pye57 pypcd4"
if [ ! -x "$venv/bin/python" ]; then
    python3 -m venv "$venv" || { echo "skipped: no Python with venv"; exit 0; }
fi
"$venv/bin/python" -c "import numpy, laspy, lazrs, laszip, plyfile, pye57, pypcd4" 2>/dev/null ||
    "$venv/bin/pip" install --quiet $packages || { echo "skipped: no $packages"; exit 0; }
# Large, and not for every Python: what needs it says so when it is not there.
"$venv/bin/python" -c "import open3d" 2>/dev/null || "$venv/bin/pip" install --quiet open3d || true
"$venv/bin/python" -c "import copclib" 2>/dev/null || "$venv/bin/pip" install --quiet copclib || true
failed=0
for script in "$here"/*.py; do
    name=$(basename "$script" .py)
    case " $* " in "  " | *" $name "*) ;; *) continue ;; esac
    echo "== $name"
    "$venv/bin/python" "$script" "$ewa" "$data" || failed=$((failed + 1))
done
[ "$failed" = 0 ] || { echo "$failed of the comparisons failed" >&2; exit 1; }
