#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Renders a point file, or a landscape of our own, and says where the picture is: demo.sh EWA FOLDER [FILE]
set -eu
ewa=$1
folder=$2
file=${3:-}

mkdir -p "$folder"
if [ -z "$file" ]; then
    file=$folder/terrain.ply
    # Bare positions and colours, as a scanner delivers them: normals and radii are estimated on the way.
    "$ewa" generate terrain --points 1000000 --positions-only -o "$file"
fi
name=$(basename "$file")
picture=$folder/${name%.*}.png
"$ewa" render "$file" -o "$picture" --verbose
echo "The picture is $(cd "$(dirname "$picture")" && pwd)/$(basename "$picture")"
if [ -x "$(dirname "$ewa")/../viewer/sdl/ewa-view" ]; then window=""; else window="make, then "; fi
echo "To look around in it: $window$ewa view $file"
