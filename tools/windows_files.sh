#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Names and files as Windows has them: what its program (under wine) reads and writes is what this machine's does.
#   tools/windows_files.sh PROGRAM PROGRAM.exe
set -eu
here=$1
there="sh $(cd "$(dirname "$0")" && pwd)/wine.sh $2"
folder=$(mktemp -d)
trap 'umount "$folder/media" 2>/dev/null || true; rm -rf "$folder"' EXIT
cd "$folder"
long=$(printf '%0120d' 0)
mkdir -p folder.png "with spaces/Übergröße/点群" "$long/$long/$long"
cases=0

# same FILE FILE...: each is the first one, byte by byte.
same() {
    first=$1
    shift
    for file in "$@"; do
        cmp "$first" "$file" || { echo "windows_files.sh: $file is not $first" >&2; exit 1; }
    done
    cases=$((cases + 1))
}
# fails TEXT WORD...: the program fails, and says so.
fails() {
    text=$1
    shift
    if $there "$@" >said 2>&1; then
        echo "windows_files.sh: $*: does not fail" >&2
        exit 1
    fi
    grep -qF "$text" said || { echo "windows_files.sh: $*: says $(cat said), not $text" >&2; exit 1; }
    cases=$((cases + 1))
}

# Spaces, backslashes, a drive, letters beyond ASCII, more than 260 characters.
"$here" generate torus -n 500 -o torus.ply
$there generate torus -n 500 -o 'with spaces\Übergröße\点群\torus.ply'
$there convert "Z:$(echo "$folder" | tr / '\\')\\torus.ply" -o "$long\\$long/$long/torus.ply"
same torus.ply "with spaces/Übergröße/点群/torus.ply" "$long/$long/$long/torus.ply"
"$here" render torus.ply --size 64x48 -o torus.png
$there render "$long/$long\\$long\\torus.ply" --size 64x48 -o 'with spaces\Übergröße\点群.png'
$there render 'with spaces/Übergröße/点群/torus.ply' --size 64x48 -o "$long/$long/$long/torus.png"
same torus.png "with spaces/Übergröße/点群.png" "$long/$long/$long/torus.png"
# Letters that are two units of UTF-16, accents of their own, blanks at the begin.
$there convert torus.ply -o 'with spaces\𝔭 😀.ply'
$there convert 'with spaces\𝔭 😀.ply' -o ' é.ply'
same torus.ply "with spaces/𝔭 😀.ply" " é.ply"
# A file that is there is replaced; nothing else is left in its folder.
$there render torus.ply --size 32x24 -o 'with spaces\Übergröße\点群.png'
"$here" render torus.ply --size 32x24 -o torus.png
same torus.png "with spaces/Übergröße/点群.png"
[ "$(find "with spaces" "$long" -name '.*' | wc -l)" = 0 ] || { find "with spaces" "$long" -name '.*' >&2; exit 1; }

# Files that others name: materials beside a mesh, by backslashes; none outside.
printf 'mtllib with spaces\\look.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >mesh.obj
printf 'newmtl red\nKd 1 0 0\n' >"with spaces/look.mtl"
"$here" convert mesh.obj -o here.ply
$there convert 'Z:'"$(echo "$folder" | tr / '\\')"'\mesh.obj' -o there.ply
same here.ply there.ply
printf 'mtllib C:\\windows\\look.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >foreign.obj
$there convert foreign.obj -o foreign.ply 2>said || true
grep -q "its name is absolute" said || { echo "windows_files.sh: foreign.obj: $(cat said)" >&2; exit 1; }

# A scene file as Windows has them: a byte order mark, ends of lines, '\' between names.
printf '\357\273\277{\r\n"ewa_scene": 1,\r\n"items": [{"file": "with spaces\\\\𝔭 😀.ply"}]\r\n}\r\n' >scene.json
"$here" render scene.json --size 64x48 -o here.png
$there render scene.json --size 64x48 -o there.png
same here.png there.png

# Ends of lines, and bytes through pipes and redirections.
printf '0 0 0 255 0 0\r\n1 0 0 0 255 0\r\n0 1 0.5 0 0 255\r\n' >crlf.xyz
printf '0 0 0 255 0 0\n1 0 0 0 255 0\n0 1 0.5 0 0 255\n' >lf.xyz
$there convert crlf.xyz -o crlf.ply
"$here" convert lf.xyz -o lf.ply
$there convert - -o - <lf.xyz >redirected.ply
# shellcheck disable=SC2002
cat crlf.xyz | $there convert - -o - | cat >piped.ply
"$here" convert - -o - <lf.xyz >streamed.ply # with no room for a count that is known late
same lf.ply crlf.ply
same streamed.ply redirected.ply piped.ply
mkdir lf crlf
"$here" convert torus.ply -o lf/torus.ply --ascii
"$here" convert torus.ply -o lf/torus.pcd --ascii
printf '2\n2\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n0 0 1 0.5\n1 0 1 0.5\n0 1 1 0.5\n1 1 1 0.5\n' >lf/scan.ptx
printf 'mtllib look.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >lf/mesh.obj
printf 'newmtl red\nKd 1 0 0\n' >lf/look.mtl
printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n' >lf/mesh.off
printf 'solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n' >lf/mesh.stl
printf 'ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9\n1 2 3\n4 5 6\n7 8 10\n' >lf/grid.asc
printf '# vtk DataFile Version 3.0\npoints\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0\n1 0 0\n0 1 0\nPOLYGONS 1 4\n3 0 1 2\n' >lf/mesh.vtk
for file in lf/*; do sed 's/$/\r/' "$file" >"cr$file"; done
for name in torus.ply torus.pcd scan.ptx mesh.obj mesh.off mesh.stl grid.asc mesh.vtk; do
    "$here" convert "lf/$name" -o here.ply
    $there convert "crlf\\$name" -o there.ply
    same here.ply there.ply
done
"$here" render torus.ply --size 64x48 --elevation 40 -o here.png --save-camera lf/camera.json
sed 's/$/\r/' lf/camera.json >crlf/camera.json
$there render torus.ply --camera 'crlf\camera.json' -o there.png
same here.png there.png
"$here" info --json torus.ply >here.json
$there info --json torus.ply >there.json
same here.json there.json

# What each command writes and says, but for those that the jobs of hash_jobs.sh try.
"$here" generate terrain -n 3000 -o terrain.laz
"$here" generate cube -n 2000 --sharp -o cube.ply
"$here" generate sphere -n 2000 -o sphere.ply
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n' >solid.obj
"$here" render sphere.ply --size 64x48 -o color.png --aov depth=depth.pfm --save-camera camera.json
while read -r file arguments; do
    # shellcheck disable=SC2086
    "$here" $arguments -o "here-$file" >here.txt 2>&1
    # shellcheck disable=SC2086
    $there $arguments -o "there-$file" >there.txt 2>&1 </dev/null
    tr -d '\r' <there.txt | sed 's/there-/here-/g' >said
    same "here-$file" "there-$file"
    same here.txt said
done <<'COMMANDS'
terrain.png  render terrain.laz --size 64x48
terrain.laz  convert terrain.laz --filter z>0
terrain.csv  convert terrain.laz
torus.pcd    convert torus.ply
sharp.ply    features cube.ply
sampled.ply  sample solid.obj
cut.ply      csg cube.ply sphere.ply --op difference
profile.csv  profile terrain.laz --line 0,0;1,1
warped.png   warp color.png depth.pfm --source-camera camera.json --camera camera.json
page.html    page torus.ply
COMMANDS
"$here" info terrain.laz cube.ply solid.obj >here.txt
$there info terrain.laz cube.ply solid.obj | tr -d '\r' >there.txt
same here.txt there.txt

# Files of more than 4 GiB, with holes: a table of nodes, records that begin before what 32 bits count and end behind it, the last
# element of a PLY file, samples of a volume.
"$here" generate terrain -n 20000 -o terrain.laz
"$here" lod terrain.laz -o far.copc.laz
"$here" convert terrain.laz -o near.las
"$here" generate vessels -o near.nrrd --dims 16
python3 - <<'PYTHON'
import gzip, struct
data = bytearray(open("far.copc.laz", "rb").read())
info = struct.unpack_from("<H", data, 94)[0] + 54 + 40
offset, size = struct.unpack_from("<QQ", data, info)
far = (9 << 29) + 64
struct.pack_into("<Q", data, info, far)
with open("far.copc.laz", "wb") as file:
    file.write(data)
    file.seek(far)
    file.write(data[offset:offset + size])
data = open("near.las", "rb").read()
begin = struct.unpack_from("<I", data, 96)[0]
far = (1 << 32) - 2000
with open("far.las", "wb") as file:
    file.write(data[:96] + struct.pack("<I", far) + data[100:begin])
    file.seek(far)
    file.write(data[begin:])
with open("far.ply", "wb") as file:
    file.write(b"ply\nformat binary_little_endian 1.0\nelement hole 1200000000\nproperty float a\nelement vertex 3\n"
               b"property float x\nproperty float y\nproperty float z\nend_header\n")
    file.seek(4800000000, 1)
    file.write(struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0.5))
header, samples = open("near.nrrd", "rb").read().split(b"\n\n", 1)
open("far.nhdr", "wb").write(header.replace(b"gzip", b"raw") + b"\nbyte skip: 4900000000\ndata file: far.raw\n")
with open("far.raw", "wb") as file:
    file.seek(4900000000)
    file.write(gzip.decompress(samples))
PYTHON
"$here" render far.copc.laz --size 64x48 -o here.png
$there render far.copc.laz --size 64x48 -o there.png
same here.png there.png
for name in far.las far.ply; do
    "$here" convert "$name" -o here.ply
    $there convert "$name" -o there.ply
    same here.ply there.ply
done
"$here" volume near.nrrd --size 64x48 -o here.png
$there volume far.nhdr --size 64x48 -o there.png
same here.png there.png
rm far.* # holes in some file systems are none

# What cannot be.
fails "No such file or directory" info missing.ply
fails "a folder" info "with spaces"
fails "cannot create: folder nowhere" render torus.ply -o 'nowhere\torus.png'
fails "is a folder" render torus.ply -o folder.png
fails "'with spaces\\Übergröße\\点群.png': a file, no command" 'with spaces\Übergröße\点群.png'
# Media that cannot be written: root may write files that others may not, but no file system that is read-only.
mkdir media
cp torus.ply media
if [ "$(id -u)" != 0 ]; then
    chmod a-w torus.png
    fails "ermission denied" render torus.ply --size 64x48 -o torus.png
    chmod u+w torus.png
elif mount --bind media media 2>/dev/null && mount -o remount,ro,bind media 2>/dev/null; then
    $there render 'media\torus.ply' --size 64x48 -o media.png
    "$here" render torus.ply --size 64x48 -o torus.png
    same torus.png media.png
    fails "ermission denied" render torus.ply --size 64x48 -o 'media\torus.png'
    umount media
else
    echo "windows_files.sh: read-only media are not tried: nothing may be mounted here"
fi

# The first Ctrl-C is heard: nothing is left behind.
$there generate torus -n 4000000 -o large.ply
mkdir stopped
sh -c "exec $there convert large.ply -o stopped/large.xyz" &
number=$!
while [ -z "$(ls -A stopped)" ]; do sleep 0.1; done
kill -INT $number
if wait $number; then
    echo "windows_files.sh: Ctrl-C is not heard" >&2
    exit 1
fi
[ -z "$(ls -A stopped)" ] || { echo "windows_files.sh: Ctrl-C leaves $(ls -A stopped)" >&2; exit 1; }
echo "windows_files.sh: $((cases + 2)) cases"
