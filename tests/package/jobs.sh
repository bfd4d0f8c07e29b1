#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# What the twenty jobs of tools/hash_jobs.sh write is what docs/machines.md tells of every machine. Where a change is meant to change
# them, the table changes with it.
#   jobs.sh SOURCES DEFLATE_VERSION PROGRAM...
set -eu
sources=$1 deflate=$2
shift 2
[ "$deflate" = 1.14 ] || { echo "skipped: libdeflate $deflate packs otherwise than 1.14, which docs/machines.md is about"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
sed -n 's/^| `\([^`]*\)` | `\([0-9a-f]\{16\}\)` .*/\1 \2/p' "$sources/docs/machines.md" >"$folder/told"
sh "$sources/tools/hash_jobs.sh" "$@" | awk '{ print $1, substr($2, 1, 16) }' >"$folder/written"
[ "$(wc -l <"$folder/told")" = 20 ] && diff "$folder/told" "$folder/written"
