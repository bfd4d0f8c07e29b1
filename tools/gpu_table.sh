#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Prints table 1 of "Perspective Accurate Splatting" with this machine's figures beside the paper's: million splats per second,
# of two sizes of picture, one pass and three: gpu_table.sh EWA [SPLATS [BACKEND...]]. On software, 20000 splats take a minute.
set -eu
ewa=$1
splats=${2:-1000000}
shift
[ $# -eq 0 ] || shift
[ $# -gt 0 ] || set -- cpu gl gl-raster

echo "| $splats splats, 10^6 per second | 512x512, 1 pass | 3 passes | 1280x1024, 1 pass | 3 passes |"
echo "|---|---|---|---|---|"
for backend in "$@"; do
    row="| \`$backend\` |"
    for size in 512x512 1280x1024; do
        for passes in 1 3; do
            speed=$("$ewa" bench --scene peer --splats "$splats" --size $size --passes $passes --backend "$backend" \
                --stages off --json - 2>/dev/null | sed -n 's/.*"splats_per_s": \([0-9.]*\).*/\1/p' | sort -g | tail -1)
            row="$row $(echo "$speed" | awk '{ printf "%.3g", $1 / 1e6 }') |"
        done
    done
    echo "$row"
done
echo "| the paper, Cg | 2.9 | 1.4 | 2.8 | 1.2 |"
echo "| the paper, assembler | 11.2 | 3.1 | 10.4 | 2.8 |"
