#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Builds the fuzz targets with clang and runs each for some seconds from its corpus: fuzz.sh SECONDS
set -eu
cd "$(dirname "$0")/.."
cmake --preset fuzz >/dev/null
cmake --build build/fuzz >/dev/null
for program in build/fuzz/tests/fuzz/fuzz_*; do
    [ -x "$program" ] && [ -f "$program" ] || continue
    name=$(basename "$program" | sed 's/^fuzz_//')
    found=build/fuzz/found/$name
    mkdir -p "$found"
    dictionary=tests/fuzz/$name.dict
    echo "== $name"
    # shellcheck disable=SC2046
    if "$program" -max_total_time="$1" -max_len=4096 -artifact_prefix="$found-" \
        $([ -f "$dictionary" ] && echo "-dict=$dictionary") "$found" "tests/fuzz/corpus/$name" \
        >"$found.log" 2>&1; then
        tail -n 1 "$found.log"
    else
        tail -n 40 "$found.log"
        exit 1
    fi
done
