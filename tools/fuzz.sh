#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Builds the fuzz targets with clang and runs each for some seconds from its corpus: fuzz.sh SECONDS [TARGET...]. What is found
# is kept in build/fuzz/found; a line a target says how many inputs were tried, and how much of the library they reach.
set -eu
cd "$(dirname "$0")/.."
seconds=$1
shift
cmake --preset fuzz >/dev/null
if [ $# -eq 0 ]; then
    cmake --build build/fuzz --target fuzz_targets >/dev/null
    for program in build/fuzz/tests/fuzz/fuzz_*; do
        [ -x "$program" ] && [ -f "$program" ] && set -- "$@" "$(basename "$program" | sed 's/^fuzz_//')"
    done
else
    for name in "$@"; do cmake --build build/fuzz --target "fuzz_$name" >/dev/null; done
fi
failed=""
for name in "$@"; do
    found=build/fuzz/found/$name
    mkdir -p "$found"
    dictionary=tests/fuzz/$name.dict
    # The targets' contexts hold 64 MiB: what takes far more, or as long, is a finding too.
    # shellcheck disable=SC2046
    if "build/fuzz/tests/fuzz/fuzz_$name" -max_total_time="$seconds" -timeout=20 -malloc_limit_mb=160 -rss_limit_mb=1500 \
        -print_final_stats=1 -artifact_prefix="$found-" $([ -f "$dictionary" ] && echo "-dict=$dictionary") \
        "$found" "tests/fuzz/corpus/$name" >"$found.log" 2>&1; then
        runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$found.log")
        echo "$name: $runs inputs, $(grep -o 'cov: [0-9]*' "$found.log" | tail -n 1), nothing found"
    else
        tail -n 40 "$found.log"
        failed="$failed $name"
    fi
done
[ -z "$failed" ] || { echo "Found something:$failed"; exit 1; }
