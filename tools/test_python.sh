#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Runs the tests of the Python package in a virtual environment of a build folder, with its library and its program:
#   test_python.sh BUILD_FOLDER [LIBRARY [PROGRAM]]
# PYTHON chooses the interpreter. Ends with 77, which CTest counts as skipped, where there is no Python 3.9 with venv, or
# no numpy: neither installed nor to be had.
set -u

build=$1
library=${2:-$build/libewa.so}
program=${3:-$build/cli/ewa}
root=$(cd "$(dirname "$0")/.." && pwd)
python=${PYTHON:-python3}
venv=$build/python_venv

skip() {
    echo "skipped: $*"
    exit 77
}

command -v "$python" >/dev/null 2>&1 || skip "there is no $python"
"$python" -c 'import sys; sys.exit(sys.version_info < (3, 9))' 2>/dev/null || skip "$python is older than 3.9"
"$python" -c 'import venv, ensurepip' 2>/dev/null || skip "$python has no venv"
if ! "$venv/bin/python" -c '' 2>/dev/null; then
    rm -rf "$venv"
    "$python" -m venv --system-site-packages "$venv" >/dev/null 2>&1 || skip "$python -m venv fails"
fi
if ! "$venv/bin/python" -c 'import numpy' 2>/dev/null; then
    "$venv/bin/python" -m pip install -q --disable-pip-version-check --retries 0 --timeout 20 numpy >/dev/null 2>&1 ||
        skip "numpy is not installed and cannot be had"
fi
# Packages whose objects are drawn, small ones, where PyPI can be reached: Debian does not have all of them, and has none for
# interpreters of others. Tests of those that are not there are skipped, and say so.
missing=""
for package in trimesh:trimesh laspy:laspy anywidget:anywidget pandas:pandas PIL:pillow; do
    "$venv/bin/python" -c "import importlib.util, sys; sys.exit(not importlib.util.find_spec('${package%:*}'))" || missing="$missing ${package#*:}"
done
# shellcheck disable=SC2086
[ -z "$missing" ] || "$venv/bin/python" -m pip install -q --disable-pip-version-check --retries 0 --timeout 20 $missing >/dev/null 2>&1
export EWA_LIBRARY="$library" EWA_PROGRAM="$program" PYTHONPATH="$root/python" PYTHONDONTWRITEBYTECODE=1
exec "$venv/bin/python" "$root/python/tests/run.py"
