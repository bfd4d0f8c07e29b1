#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Counts the instructions of the raster pipeline's programs, as table 2 of "Perspective Accurate Splatting" does, and of the
# compute pipeline's, with its arithmetic native and emulated: gpu_instructions.sh [FOLDER OF src/gl]. Needs glslangValidator, spirv-opt and spirv-dis (Debian: glslang-tools, spirv-tools).
#
# Programs are compiled to SPIR-V, their functions put into one, and simplified. An operation on a vector counts once. "arithmetic"
# is what computes; "texels" what is read of pictures; "all" leaves out what only names, loads, stores or takes apart. Both sides of
# branches count, loops as one turn. "perspective alone" is what a frame of the default kernel runs of a program: the other kernels,
# points and orthographic cameras are branches that all of its surfels take the same way.
set -eu
room=${1:-$(dirname "$0")/../src/gl}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Names of the constants that the library puts before its programs; their values do not matter here.
constants=$(sed -n 's/^ *{"\([A-Z_0-9]*\)", .*}.*/\1/p' "$room/raster_programs.c")

edit=
version=430
perspective='s/return (flags.x & flag) != 0u;/return (ELLIPSES \& flag) != 0u;/'

# count STAGE NAME: of $work/program.STAGE.
count() {
    glslangValidator -G --amb --aml -o "$work/raw.spv" "$work/program.$1" >"$work/log" ||
        { cat "$work/log" >&2; exit 1; }
    spirv-opt --target-env=opengl4.5 -O "$work/raw.spv" -o "$work/program.spv"
    spirv-dis --raw-id "$work/program.spv" | awk -v name="$2" '
        { op = $2 == "=" ? $3 : $1 }
        op ~ /^Op(F|I|S|U)(Add|Sub|Mul|Div|Mod|Rem|Negate)$/ || op ~ /^Op(Dot|VectorTimes|MatrixTimes|Shift|Bitwise|Not$|Convert|Select$|Logical|FOrd|FUnord|IEqual|INotEqual|ULess|UGreater|SLess|SGreater|Any$|All$|DPd)/ || op == "OpExtInst" { arithmetic++ }
        op ~ /^OpImage(Fetch|Sample|QuerySize)/ { texels++ }
        op ~ /^Op(Atomic|SubgroupBallot)/ { control++ }
        op ~ /^Op(BranchConditional|Switch|Kill|Phi)$/ { control++ }
        END { printf "| %s | %d | %d | %d |\n", name, arithmetic, texels, arithmetic + texels + control }'
}

# compile STAGE NAME DEFINES PIECE...
compile() {
    stage=$1 name=$2 defines=$3
    shift 3
    {
        echo "#version 330 core"
        for define in MAX_LIGHTS=8 MAX_LEVELS=33 MAX_MATERIALS=256 $defines; do
            echo "#define ${define%=*} ${define#*=}"
        done
        value=1
        for constant in $constants; do
            value=$((value + 1))
            echo "const float $constant = $value.5;"
        done
        for piece in "$@"; do sed "$edit" "$room/shaders/raster_$piece.glsl"; done
    } >"$work/program.$stage"
    count "$stage" "$name"
}

# compute NAME DEFINES PIECE...: a default frame's.
compute() {
    name=$1 defines=$2
    shift 2
    kernel "$name" "$defines" wide band "$@"
}

# kernel NAME DEFINES PIECE...: any.
kernel() {
    name=$1 defines=$2
    shift 2
    {
        echo "#version $version core"
        [ $version = 430 ] || echo "#extension GL_ARB_shader_ballot : require"
        for define in MAX_LIGHTS=8 MAX_LEVELS=33 MAX_MATERIALS=256 MAX_SECTIONS=8 MERGED_SURFACES=8 CONE_BITS=11 CONE_AXIS=1023 \
            CONE_SINE=1022u RADIUS_SHIFT=15 EYE_DOME_REACH=4 TILE_PX=8 CHANNELS=7 WITH_NORMAL=1 WITH_DEPTH=0 DEPTH_CHANNEL=7u WITH_MATERIAL=0 \
            WITH_OPACITY=0 WITH_CLIPS=0 WITH_NEARS=0 WITH_FINE=0 RAYS=0 $defines; do
            echo "#define ${define%=*} ${define#*=}"
        done
        value=1
        for constant in $(sed -n 's/^ *{"\([A-Z_0-9]*\)", .*}.*/\1/p' "$room/variant.c" "$room/gaussian_programs.c"); do
            value=$((value + 1))
            echo "#define $constant $value.5"
        done
        for piece in "$@"; do sed "$edit" "$room/shaders/$piece.glsl"; done
    } >"$work/program.comp"
    count comp "$name"
}

# compute_more EDIT NAME: batches of visibility, edited.
compute_more() {
    before=$edit
    edit="$edit; $1"
    compute "$2" "$own PASS=1" scene splat masks passes
    edit=$before
}

vertex="scene project payload"
echo "| program | arithmetic | texels | all |"
echo "|---|---|---|---|"
for pass in 1 2; do
    plain="PASS=$pass SINGLE=0 WITH_CLIPS=0 RAYS=0 NEAR=0"
    lines="PASS=$pass SINGLE=0 WITH_CLIPS=1 RAYS=0 NEAR=0"
    # shellcheck disable=SC2086
    {
        compile vert "vertex, pass $pass" "$plain" $vertex vertex
        edit=$perspective
        compile vert "vertex, pass $pass, perspective alone" "$plain" $vertex vertex
        edit=
        compile vert "vertex, pass $pass, clip lines" "$lines" $vertex lines vertex
        compile frag "fragment, pass $pass" "$plain" scene splat
        edit=$perspective
        compile frag "fragment, pass $pass, perspective alone" "$plain" scene splat
        edit=
        compile frag "fragment, pass $pass, clip lines" "$lines" scene splat
    }
done
edit=$perspective
# shellcheck disable=SC2086
compile frag "fragment, one pass, perspective alone" "PASS=2 SINGLE=1 WITH_CLIPS=0 RAYS=0 NEAR=0" scene splat
edit=
# shellcheck disable=SC2086
compile frag "fragment, pass 2, raycast kernel" "PASS=2 SINGLE=0 WITH_CLIPS=0 RAYS=1 NEAR=0" scene splat
# shellcheck disable=SC2086
compile vert "vertex, pass 2, at the eye's plane" "PASS=2 SINGLE=0 WITH_CLIPS=0 RAYS=0 NEAR=1" $vertex near vertex
compile frag "fragment, pass 2, at the eye's plane" "PASS=2 SINGLE=0 WITH_CLIPS=0 RAYS=0 NEAR=1" scene splat
compile frag "pass 3, surface" "STAGE=0 WITH_CLIPS=0" surface
compile frag "pass 3, surface, clip lines" "STAGE=0 WITH_CLIPS=1" surface
compile frag "pass 3, picture" "STAGE=5 WITH_CLIPS=0" surface
for arithmetic in native emulated; do
    with=$([ $arithmetic = native ] && echo 1 || echo 0)
    own="FUSED=$with DIVIDES=$with ROOTS=$with DOUBLE_QUOTIENTS=$with"
    compute "culling, $arithmetic" "$own PASS=0" scene packet cull
    compute "set-up, $arithmetic" "$own PASS=0" scene packet setup
    compute "lists, $arithmetic" "$own PASS=0" scene fill
    # What is done for a splat of a tile, without pixels; then with a row of its mask more, and with a bit of a row more.
    edit='s/next_splat(word, bits, slot);) /false;) /'
    compute "batches of visibility, $arithmetic" "$own PASS=1" scene splat masks passes
    compute "batches of accumulation, $arithmetic" "$own PASS=2" scene splat masks sums passes
    row='row_mask(r, from_center.x, from_center.y + float(y)'
    compute_more "s/$row)/($row) \\& $row + 1.0))/" "a row more, $arithmetic"
    compute_more 's/\(atomicOr(reached.*\);$/{ \1; bits \&= bits - 1u; \1; }/' "a bit more, $arithmetic"
    # In place of bits that are set one by one, a row told to its eight pixels by ballots. All lanes take part in these, in all rows.
    version=450
    ballot='own = lane == PIXELu ? unpackUint2x32(ballotARB((bits \& 1u << PIXELu) != 0u)).x : own;'
    told=
    for pixel in 0 1 2 3 4 5 6 7; do told="$told $(echo "$ballot" | sed "s/PIXEL/$pixel/g")"; done
    compute_more "s/^ *for (; bits != 0u.*\$/{ uint own = 0u, lane = gl_SubGroupInvocationARB; $told if (lane < 8u) reached[at + lane] = own; }/" \
        "a row by ballots, $arithmetic"
    version=430
    edit=
    compute "visibility, $arithmetic" "$own PASS=1" scene splat masks passes
    compute "accumulation, $arithmetic" "$own PASS=2" scene splat masks sums passes
    compute "first surface, $arithmetic" "$own PASS=3" sums surface
    compute "edges, $arithmetic" "$own PASS=4" scene splat masks sums passes surface edges
    compute "picture, $arithmetic" "$own PASS=5" sums codes surface
    compute "eye-dome lighting, $arithmetic" "$own PASS=6" codes eye_dome
    compute "averages, $arithmetic" "$own PASS=7" average
    # Gaussians; what a splat of a list takes without marks, and without pixels; a row of its marks.
    for detail in bare deep; do
        splat="$own DEEP=$([ $detail = deep ] && echo 1 || echo 0) DOTS=0 AMONG=0 STAGE=0"
        kernel "Gaussians, $detail, $arithmetic" "$splat" wide scan gaussian_frame gaussian_project
        kernel "compositing, $detail, $arithmetic" "$splat" wide scan gaussian_frame codes share_below gaussian_draw
        edit='s/while (bits != 0u \&\& open)/while (false)/'
        kernel "compositing without looks, $detail, $arithmetic" "$splat" wide scan gaussian_frame codes share_below gaussian_draw
        edit="$edit; s/^ *mark(thread.*//"
        kernel "and without marks, $detail, $arithmetic" "$splat" wide scan gaussian_frame codes share_below gaussian_draw
        edit=
    done
    kernel "compositing among surfaces, $arithmetic" "$own DEEP=1 DOTS=0 AMONG=1 STAGE=0" wide scan gaussian_frame codes share_below gaussian_draw
done
for arithmetic in native emulated; do
    with=$([ $arithmetic = native ] && echo 1 || echo 0)
    own="FUSED=$with DIVIDES=$with ROOTS=$with MAX_SPAN=512"
    # Records of points alone; pixels, then with a look at a point more, and at a splat.
    edit='s/p.is_splat = p.slice < point_slice;/p.is_splat = false;/'
    kernel "volumes: points to records, $arithmetic" "$own" wide volume_scene volume_place
    edit=
    kernel "volumes: voxels to records, $arithmetic" "$own" wide volume_scene volume_place
    kernel "volumes: units of splats, $arithmetic" "$own" wide volume_scene volume_buckets
    kernel "volumes: order of splats, $arithmetic" "$own" wide volume_scene volume_sort
    kernel "volumes: pixels, $arithmetic" "$own" wide volume_scene codes share_below volume_draw
    edit='s/for (uint bits = pixel_bits\(.*\)bits != 0u;/for (uint bits = pixel_bits\1false;/'
    kernel "volumes: pixels without looks at points, $arithmetic" "$own" wide volume_scene codes share_below volume_draw
    edit='s/^\( *\)else draw_splat(SPLAT_WORDS \* item);/\1else { draw_splat(SPLAT_WORDS * item); draw_splat(SPLAT_WORDS * (item ^ 1u)); }/'
    kernel "volumes: pixels, two looks at a splat more, $arithmetic" "$own" wide volume_scene codes share_below volume_draw
    edit=
done
for stage in 0 1 2; do kernel "sort, stage $stage" "STAGE=$stage" scan sort; done
for stage in 0 1 2 3; do
    kernel "lists of Gaussians, stage $stage" "FUSED=1 DIVIDES=1 ROOTS=1 DOUBLE_QUOTIENTS=1 DEEP=0 DOTS=0 AMONG=0 STAGE=$stage" wide scan gaussian_frame gaussian_list
done
