#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# An octree that another program cuts short while it is shown: the window says so once and goes on with what it has:
# cut_short.sh EWA FOLDER
set -eu
ewa=$1
folder=$2
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"
fail() {
    echo "cut short: $1" >&2
    sed 's/^/  complained: /' complained >&2
    exit 1
}
"$ewa" generate terrain --points 300000 --positions-only -o ground.ply 2>complained
"$ewa" lod ground.ply -o ground.copc.laz 2>complained
{
    echo settle
    echo shot before.png
    tries=600
    until [ -s before.png ]; do
        tries=$((tries - 1))
        [ $tries -gt 0 ] || break
        sleep 0.1
    done
    sleep 0.3 # until it is written
    truncate -s 20000 ground.copc.laz
    # Near and in a larger window, so that nodes are wanted that are not there.
    echo resize 320 240
    echo do zoom 12
    echo settle
    echo shot after.png
    echo do view top
    echo settle
    echo shot top.png
} | "$ewa" view ground.copc.laz --levels always --supersampling 1 --size 80x60 --script - --timings >printed 2>complained ||
    fail "the exit status is $?"
for picture in before after top; do
    [ -s $picture.png ] || fail "no $picture.png"
done
cmp -s before.png after.png && fail "nothing has come nearer"
[ "$(grep -c 'ground.copc.laz' complained)" = 1 ] || fail "not one line"
grep -q 'ground.copc.laz: .*shorter' complained || fail "other words"
echo "the window goes on"
