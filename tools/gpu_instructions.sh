#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Counts the instructions of the raster pipeline's programs, as table 2 of "Perspective Accurate Splatting" does:
# gpu_instructions.sh [FOLDER OF src/gl]. Needs glslangValidator, spirv-opt and spirv-dis (Debian: glslang-tools, spirv-tools).
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
perspective='s/return (flags.x & flag) != 0u;/return (ELLIPSES \& flag) != 0u;/'

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
    glslangValidator -G --amb --aml -o "$work/raw.spv" "$work/program.$stage" >"$work/log" ||
        { cat "$work/log" >&2; exit 1; }
    spirv-opt --target-env=opengl4.5 -O "$work/raw.spv" -o "$work/program.spv"
    spirv-dis --raw-id "$work/program.spv" | awk -v name="$name" '
        { op = $2 == "=" ? $3 : $1 }
        op ~ /^Op(F|I|S|U)(Add|Sub|Mul|Div|Mod|Rem|Negate)$/ || op ~ /^Op(Dot|VectorTimes|MatrixTimes|Shift|Bitwise|Not$|Convert|Select$|Logical|FOrd|FUnord|IEqual|INotEqual|ULess|UGreater|SLess|SGreater|Any$|All$|DPd)/ || op == "OpExtInst" { arithmetic++ }
        op ~ /^OpImage(Fetch|Sample|QuerySize)/ { texels++ }
        op ~ /^Op(BranchConditional|Switch|Kill|Phi)$/ { control++ }
        END { printf "| %s | %d | %d | %d |\n", name, arithmetic, texels, arithmetic + texels + control }'
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
