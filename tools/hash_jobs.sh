#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Runs twenty small jobs of the program over generated data, and prints a line for each: its name and the hash of what it
# wrote. The same lines on every machine (docs/machines.md).
#   tools/hash_jobs.sh [--minimal | --without x] [--like OTHER] PROGRAM [ARGUMENT...]      such as qemu-aarch64-static -L build/sysroot/arm64 build/arm64/cli/ewa
# With --minimal, only what a program without any library can do, pictures as PFM: not what libdeflate compresses (z), gzip
# unpacks (g) or OpenEXR writes (x); --without leaves out the kinds of job that it names. With --like, what differs from the lines of
# another program alone, or how many are the same.
set -eu
minimal= without=- kinds=
case ${1:-} in
--minimal) minimal=yes without=gx kinds=$1; shift ;;
--without) without=$2 kinds="$1 $2"; shift 2 ;;
esac
[ $# -gt 0 ] || { echo "usage: tools/hash_jobs.sh [--minimal] [--like OTHER] PROGRAM [ARGUMENT...]" >&2; exit 2; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
if [ "$1" = --like ]; then
    # shellcheck disable=SC2086
    sh "$0" $kinds "$2" >"$folder/other"
    shift 2
    # shellcheck disable=SC2086
    sh "$0" $kinds "$@" >"$folder/these"
    diff "$folder/other" "$folder/these" && echo "$(wc -l <"$folder/these") jobs: the same bytes"
    exit
fi

cat >"$folder/jobs" <<'JOBS'
- torus.ply       generate torus -n 20000
- bare.ply        generate torus -n 20000 --positions-only
- terrain.las     generate terrain -n 20000
- terrain.laz     generate terrain -n 20000
- cube.ply        generate cube -n 5000 --sharp
g vessels.nrrd    generate vessels --dims 40
- board.ply       generate checker -n 20000 --procedure marble
- surfels.ply     surfels bare.ply --shape ellipse
z terrain.copc.laz lod terrain.laz
- torus.png       render torus.ply --size 320x240
x torus.exr       render torus.ply --size 320x240
- bare.png        render bare.ply --size 320x240 --edl 1
- glass.png       render torus.ply --size 320x240 --opacity 0.5
- sharp.png       render cube.ply --size 320x240 --view iso
- marble.png      render board.ply --size 320x240 --shading phong
- octree.png      render terrain.copc.laz --size 320x240 --color-by z
g both.png        render torus.ply vessels.nrrd --size 320x240
g volume.png      volume vessels.nrrd --size 320x240
- texture.png     texture torus.png --size 300x200 --corners 20,30,280,10,290,190,5,170
- affine.png      render torus.ply --size 320x240 --kernel affine --edge-layers 1
JOBS
[ -z "$minimal" ] || sed -i 's/\.png/.pfm/g' "$folder/jobs"
[ "$without" = - ] || sed -i "/^[$without]/d" "$folder/jobs"
while read -r kind file command arguments; do
    # shellcheck disable=SC2086
    (cd "$folder" && "$@" "$command" $arguments -o "$file" >said 2>&1) </dev/null ||
        { echo "$file: $command $arguments" >&2; cat "$folder/said" >&2; exit 1; }
    [ "$minimal$kind" = yesz ] || printf '%s\t%s\n' "$file" "$(md5sum <"$folder/$file" | cut -c1-32)"
done <"$folder/jobs"
