#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Runs mypy --strict over the Python package, and stubtest over it with its stubs, both installed side by side; installs mypy
# into build/python_types (needs a package index). What needs PyTorch or anywidget is checked where these are.
set -eu
cd "$(dirname "$0")/.."
venv=build/python_types
[ -x $venv/bin/stubtest ] || { "${PYTHON:-python3}" -m venv $venv && $venv/bin/pip install -q mypy numpy typing_extensions; }
$venv/bin/mypy --strict
place=$($venv/bin/python -c 'import sysconfig; print(sysconfig.get_path("purelib"))')
rm -rf "$place/ewa" "$place/ewa-stubs"
cp -r python/ewa "$place/ewa"
cp -r python/stubs/ewa-stubs "$place/ewa-stubs"
for module in torch:torch notebook:anywidget; do
    $venv/bin/python -c "import ${module#*:}" 2>/dev/null || echo "ewa.${module%:*}"
done >$venv/allowlist
EWA_LIBRARY=${EWA_LIBRARY:-$PWD/build/release/libewa.so}
export EWA_LIBRARY
stubtest=$PWD/$venv/bin/stubtest
allowlist=$PWD/$venv/allowlist
cd $venv
# The sources, which were checked above, use what is private and so in no stub.
printf '[mypy]\n[mypy-ewa.*]\nignore_errors = True\n' >stubtest.ini
"$stubtest" --mypy-config-file stubtest.ini --allowlist "$allowlist" --ignore-unused-allowlist ewa
