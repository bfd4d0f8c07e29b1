#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Films of the window's keyframes have the bytes of those that ewa render makes of the saved scene: numbered pictures, and a film
# where ffmpeg is installed: film.sh EWA FOLDER
set -eu
ewa=$1
rm -rf "$2"
mkdir -p "$2"
cd "$2"
fail() {
    echo "film: $1" >&2
    exit 1
}

"$ewa" generate torus --points 4000 -o torus.ply -q
cat >session.txt <<SCRIPT
do open torus.ply
refuse film
do color 0 z
do move 0 0.5,0,0
do keyframe add
refuse film shown_%d.png
do turn 40 10
settle
do keyframe add
do zoom 2
settle
do keyframe add
refuse keyframe go 3
refuse keyframe delete first
refuse film shown.txt
refuse film shown_%d.png 1
refuse film shown_%d.png 5 0x9
do film shown here_%d.png 5
expect-said film shown here_%d.png 5 160x120
do scene save scene.json
do keyframe save keys.json
expect-said keyframes 3 keys.json
do keyframe go 0
do keyframe delete 1
do keyframe delete all
refuse keyframe save keys.json
SCRIPT
command -v ffmpeg >/dev/null 2>&1 && sed -i 's/^do scene save/do film shown.mp4 5\n&/' session.txt
"$ewa" view --size 160x120 --script session.txt -q || fail "the script ends with $?"
"$ewa" render scene.json --path keys.json --frames 5 -o drawn_%d.png -q
for i in 0 1 2 3 4; do
    cmp "shown here_$i.png" drawn_$i.png || fail "frame $i differs"
done
# The scene file has the keyframes, too.
"$ewa" render scene.json --path scene.json --frames 5 -o own_%d.png -q
cmp own_3.png drawn_3.png || fail "keyframes of the scene file are others"
! cmp -s "shown here_0.png" "shown here_1.png" || fail "nothing moves"
if [ -f shown.mp4 ]; then
    "$ewa" render scene.json --path keys.json --frames 5 -o drawn.mp4 -q
    cmp shown.mp4 drawn.mp4 || fail "the films differ"
fi

# One that is given up leaves nothing behind.
cat >stopped.txt <<SCRIPT
do open torus.ply
wait 1
do keyframe add
do keyframe add
do film stopped_%d.png 1000
frame
frame
refuse keyframe add
refuse film again_%d.png
do cancel
expect-message stopped_%d.png: the film was given up
frame
do film $([ -f shown.mp4 ] && echo stopped.mp4 || echo more_%d.png) 1000
frame
do film stop
SCRIPT
"$ewa" view --size 160x120 --script stopped.txt --timings -q >/dev/null || fail "giving up ends with $?"
[ -f stopped_0.png ] && ! [ -f stopped_999.png ] || fail "numbered pictures were not given up"
! ls | grep -v '^stopped_\|txt$' | grep stopped || fail "a film that was given up is left"
