#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Runs every test of one or more build folders, or those with a label (FOLDER:LABEL) or without (FOLDER:-LABEL), and ends with
# one line that counts test cases: "N passed, 0 failed, K skipped". A cmocka program counts as the cases it reports, any other
# test as one.
set -u

log=$(mktemp)
trap 'rm -f "$log"' EXIT
failed=0
for tests in "$@"; do
    folder=${tests%:*}
    label=""
    case $tests in
    *:-*) label="-LE ^${tests##*:-}\$" ;;
    *:*) label="-L ^${tests##*:}\$" ;;
    esac
    echo "== $tests"
    # One more than there are processors: some wait for processes, servers and screens.
    # shellcheck disable=SC2086
    ctest --test-dir "$folder" --output-on-failure -j "$(($(nproc) + 1))" --timeout 900 $label || failed=1
    cat "$folder/Testing/Temporary/LastTest.log" >>"$log"
done

awk -v failed_run="$failed" '
    function finish(state) {
        if (cases + skips + failures == 0) {
            if (state == "passed") passed++
            else if (state == "skipped") skipped++
            else failed++
        } else {
            passed += cases; skipped += skips; failed += failures
            if (state == "failed" && failures == 0) failed++
        }
        cases = skips = failures = 0
    }
    /^\[  PASSED  \] [0-9]+ test/  { cases += $4 }
    /^\[  SKIPPED \] [0-9]+ test/  { skips += $4 }
    /^\[  FAILED  \] [0-9]+ test/  { failures += $4 }
    /^Test Passed\.$/              { finish("passed") }
    /^Test Skipped/                { finish("skipped") }
    /^Test Failed/                 { finish("failed") }
    END {
        if (failed_run && failed == 0) failed = 1
        printf "%d passed, %d failed, %d skipped\n", passed, failed, skipped
        exit failed > 0
    }' "$log"
