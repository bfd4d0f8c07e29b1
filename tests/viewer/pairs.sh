#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# A picture of the window that rests is what ewa render makes of the saved scene, byte for byte, of every pair of kinds, two of
# one kind among them; and with the same options of the look, what ewa render draws: pairs.sh EWA FOLDER
set -eu
ewa=$1
rm -rf "$2"
mkdir -p "$2"
cd "$2"
fail() {
    echo "pairs: $1" >&2
    exit 1
}

"$ewa" generate sphere --points 800 -o points.ply -q
"$ewa" generate torus --points 800 --positions-only -o scan.las -q
"$ewa" generate terrain --points 1000 --positions-only -o other.laz -q
printf 'v -1 -1 -1\nv 1 -1 -1\nv 0 1 -1\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n' >mesh.obj
"$ewa" generate terrain --points 8000 --seed 2 -o ground.ply -q
"$ewa" lod ground.ply -o levels.copc.laz -q
"$ewa" generate ball --dims 16 -o volume.nrrd -q
# Gaussians by the 14 numbers that files of them have at least.
awk 'BEGIN {
    print "ply\nformat ascii 1.0\nelement vertex 300"
    split("x y z f_dc_0 f_dc_1 f_dc_2 opacity scale_0 scale_1 scale_2 rot_0 rot_1 rot_2 rot_3", name, " ")
    for (i = 1; i <= 14; i++) print "property float " name[i]
    print "end_header"
    for (i = 0; i < 300; i++) print (i % 10) / 5 - 1, int(i / 10) / 15 - 1, (i % 7) / 7, (i % 3) - 1, (i % 5) / 5, -1, 1, -2.5, -2.5, -3, 1, 0, 0, 0
}' >gaussians.ply

"$ewa" convert gaussians.ply -o lod-meta.json -q
kinds="points.ply scan.las other.laz mesh.obj levels.copc.laz gaussians.ply volume.nrrd lod-meta.json"
: >session.txt
pairs=""
later=$kinds
for one in $kinds; do
    for other in $later; do
        pairs="$pairs $one-$other"
        printf 'do open %s\ndo open %s\ndo turn 20 10\nsettle\ndo shot %s.png\ndo scene save %s.json\ndo close 1\ndo close 0\n' \
            "$one" "$other" "$one-$other" "$one-$other" >>session.txt
    done
    later=${later#* }
done
"$ewa" view --size 96x72 --levels always --script session.txt -q >/dev/null || fail "the script ends with $?"
count=0
for pair in $pairs; do
    "$ewa" render "$pair.json" -o drawn.png -q
    cmp "$pair.png" drawn.png || fail "$pair differs"
    count=$((count + 1))
done
[ $count = 36 ] || fail "$count pairs"
! cmp -s points.ply-scan.las.png points.ply-volume.nrrd.png || fail "all pictures are the same"

# How things are shown is said to both alike.
printf 'settle\ndo shot look.png\n' >look.txt
look() {
    "$ewa" view $1 --size 96x72 --script look.txt -q >/dev/null || fail "view $1 ends with $?"
    "$ewa" render $1 --size 96x72 -o drawn.png -q
    cmp look.png drawn.png || fail "the look of $1 differs"
    "$ewa" render ${1%% *} --size 96x72 -o plain.png -q
    ! cmp -s plain.png drawn.png || fail "$1 is drawn as without options"
}
look "points.ply --color-by z --colormap turbo --range 10%,90% --background 0.1,0.2,0.3 --radius-scale 1.2"
look "scan.las --edl 1 --kernel affine --light 1,1,1 --light 0,0,0,0.5,0,0 --ambient 0.3 --clip-plane 1,0,0,0.1"
look "mesh.obj --shading none --color-by y --opacity 0.5 --layers exact --clip-plane 0,0,-1,0.5 --clip-plane 1,1,0,0.5 --tau 0.3"
look "levels.copc.laz --levels always --color-by z --lod-spacing 4 --cull back"
look "gaussians.ply --projection exact --gaussian-display points --background black"
look "gaussians.ply --surface --color-by x --close-gaps off --prefilter 1"
look "volume.nrrd --transfer fog --opacity-scale 3 --shading phong"
look "points.ply --title Sphere --axes --scale-bar --color-by z --color-bar"
# The box that cuts is seen in the window, with its handles, and not in what is saved.
printf 'do box -2,-2,-2,2,2,0.3\nsettle\ndo shot box.png\nshot window.png\ndo scene save box.json\n' >box.txt
"$ewa" view points.ply --size 96x72 --script box.txt -q >/dev/null || fail "a box that cuts ends with $?"
"$ewa" render box.json -o drawn.png -q
cmp box.png drawn.png || fail "a picture of what a box cuts differs"
! cmp -s window.png drawn.png || fail "the box is not seen in the window"
said=$("$ewa" view points.ply --color-by warmth --size 96x72 --script look.txt 2>&1 >/dev/null)
case $said in *"no attribute 'warmth'"*) ;; *) fail "an attribute that is not there: $said" ;; esac
"$ewa" render points.ply --size 96x72 -o drawn.png -q
cmp look.png drawn.png || fail "what has not the attribute is not as without --color-by"
echo "$count pairs"
