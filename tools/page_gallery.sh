#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# A gallery for a browser: a page of pictures, each of which leads to the view that it is of (docs/page.md). Scenes are made here, and every
# file is of that folder; `ewa serve` or any other web server shows it. Skipped where there are no modules (make wasm).
#   tools/page_gallery.sh build/release/cli/ewa build/page_gallery
set -eu
ewa=$1
out=$2
page=$(cd "$(dirname "$0")/../page" && pwd)
scratch=$out.new
rm -rf "$out" "$scratch"
mkdir -p "$scratch"
trap 'rm -rf "$scratch"' EXIT
make() { "$ewa" generate "$@" -q; }
make torus -n 100000 -o "$scratch/torus.ply"
if ! "$ewa" page "$scratch/torus.ply" --folder "$out" -q 2>"$scratch/said.txt"; then
    grep -q 'make wasm' "$scratch/said.txt" || { cat "$scratch/said.txt" >&2; exit 1; }
    echo "No gallery for a browser: make wasm makes the modules that it needs"
    exit 0
fi
mkdir "$out/data" "$out/pictures"
mv "$scratch/torus.ply" "$out/data"
# In place of the page of one file, the one that shows what its address names.
rm -f "$out/scene.json" "$out/torus.ply"
cp "$page/index.html" "$out/view.html"
cp "$page/index.js" "$page/page.css" "$out"

make terrain -n 100000 -o "$out/data/terrain.laz"
make town -n 200000 -o "$scratch/town.ply"
"$ewa" lod "$scratch/town.ply" -o "$out/data/town.copc.laz" -q
make csg --sharp -n 20000 -o "$out/data/part.ply"
make vessels --dims 64 -o "$out/data/vessels.nrrd"
# A screen of three panels with a picture, which is one of the town.
"$ewa" render "$out/data/town.copc.laz" -o "$out/data/town.jpg" --size 960x320 --background "#304050" -q
cat >"$out/data/screen.obj" <<'MESH'
mtllib screen.mtl
usemtl town
v -1.5 0 0.3
v -0.5 0 0
v 0.5 0 0.3
v 1.5 0 0
v -1.5 1 0.3
v -0.5 1 0
v 0.5 1 0.3
v 1.5 1 0
vt 0 0
vt 0.3333 0
vt 0.6667 0
vt 1 0
vt 0 1
vt 0.3333 1
vt 0.6667 1
vt 1 1
f 1/1 2/2 6/6 5/5
f 2/2 3/3 7/7 6/6
f 3/3 4/4 8/8 7/7
MESH
printf 'newmtl town\nmap_Kd town.jpg\n' >"$out/data/screen.mtl"

# scene NAME ITEM TITLE: a scene file, its picture, and an entry of the page.
entries=
scene() {
    printf '{"ewa_scene": 1, "items": [%s]}\n' "$2" >"$out/data/$1.json"
    "$ewa" render "$out/data/$1.json" -o "$out/pictures/$1.png" --size 400x300 -q
    entries="$entries
<a href=\"view.html?src=data/$1.json\"><img src=\"pictures/$1.png\" width=\"400\" height=\"300\" alt=\"\"><span>$3</span></a>"
}
scene torus '{"file": "torus.ply"}' 'Points with normals: PLY'
scene terrain '{"file": "terrain.laz", "color_by": "z"}' 'A terrain in the colours of its heights: LAZ'
scene town '{"file": "town.copc.laz", "levels": "always"}' 'A town, of which only what is seen is fetched: COPC'
scene part '{"file": "part.ply"}' 'Sharp edges by clip lines: PLY'
scene vessels '{"file": "vessels.nrrd"}' 'A volume: NRRD'
scene screen '{"file": "screen.obj"}' 'A mesh with a picture: OBJ, JPEG'

cat >"$out/index.html" <<PAGE
<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src 'self' data:; style-src 'self'; base-uri 'none'; form-action 'none'">
<title>ewa: a gallery</title>
<link rel="icon" href="data:,">
<link rel="stylesheet" href="gallery.css">
</head>
<body>
<h1>Drawn in your browser</h1>
<p>Each picture leads to the same in a view that turns, measures and picks. Or <a class="word" href="view.html">drop a file of yours</a>: it stays on this computer.</p>
<main>$entries
</main>
</body>
</html>
PAGE
cat >"$out/gallery.css" <<'STYLE'
:root { color-scheme: light dark; font: 16px/1.5 system-ui, sans-serif; }
body { margin: 0 auto; max-width: 1280px; padding: 16px; }
main { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 320px), 1fr)); gap: 16px; }
main a { display: block; color: inherit; text-decoration: none; border: 1px solid #8886; border-radius: 10px; overflow: hidden; }
main a:hover, main a:focus-visible { outline: 3px solid #0b57d0; }
img { display: block; width: 100%; height: auto; background: #fff; }
span { display: block; padding: 8px 12px; }
STYLE
echo "$out/index.html, by: ewa serve $out"
