#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Runs a program for Windows under wine, with a configuration of its own in build/wine, without a screen and without wine's messages.
#   tools/wine.sh PROGRAM.exe [ARGUMENT...]
set -eu
WINEPREFIX=$(cd "$(dirname "$0")/.." && pwd)/build/wine
mkdir -p "$WINEPREFIX"
export WINEPREFIX WINEDEBUG=-all WINEDLLOVERRIDES="mscoree,mshtml=" DISPLAY=
exec wine "$@"
