#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Runs mypy --strict and stubtest over the Python package; installs mypy into build/python_types (needs a package index). What
# needs PyTorch or anywidget is run by stubtest where these are.
set -eu
cd "$(dirname "$0")/.."
venv=build/python_types
[ -x $venv/bin/stubtest ] || { "${PYTHON:-python3}" -m venv $venv && $venv/bin/pip install -q mypy numpy typing_extensions; }
$venv/bin/mypy --strict
for module in torch:torch notebook:anywidget; do
    $venv/bin/python -c "import ${module#*:}" 2>/dev/null || echo "ewa.${module%:*}"
done >$venv/allowlist
PYTHONPATH=python MYPYPATH=python $venv/bin/stubtest --mypy-config-file pyproject.toml --allowlist $venv/allowlist ewa
