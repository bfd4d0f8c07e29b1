#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# All that docs/gpu.md wants to know of a graphics processor, as Markdown on standard output: gpu_report.sh [FOLDER] >report.md
# FOLDER is where the program and the tests are built, build/release if it is not named; what is missing there is built. Nothing is
# fetched. EWA_GL_DEVICE=N takes the N-th device, of which `ewa info --gpu` has the numbers. Software is given less to do.
# On a device it takes some minutes; the program and the tests take another one to build on 16 processors.
set -eu
cd "$(dirname "$0")/.."
folder=${1:-build/release}
ewa=$folder/cli/ewa
tests="gpu_bytes gpu_device gpu_fallback gpu_frame gpu_gaussians gpu_masks gpu_raster gpu_shaders gpu_sort gpu_sources gpu_volumes cli_gpu"

missing=
for tool in cc:gcc cmake:cmake ninja:ninja-build pkg-config:pkg-config; do
    command -v "${tool%:*}" >/dev/null || missing="$missing ${tool#*:}"
done
if command -v pkg-config >/dev/null; then
    for module in epoxy:libepoxy-dev cmocka:libcmocka-dev zlib:zlib1g-dev; do
        pkg-config --exists "${module%:*}" || missing="$missing ${module#*:}"
    done
fi
if [ -n "$missing" ]; then
    echo "gpu_report.sh: please install these first (names of Debian):$missing" >&2
    exit 1
fi

targets="ewa gpu_probe measure_gaussians measure_volume_speed"
for test in $tests; do targets="$targets test_$test"; done
{
    [ -f "$folder/CMakeCache.txt" ] || cmake -S . -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release
    # shellcheck disable=SC2086
    cmake --build "$folder" -j "$(getconf _NPROCESSORS_ONLN)" --target $targets
} >&2

# fenced COMMAND...: its words, as they are; what it says of failures, too.
fenced() {
    echo '```'
    "$@" 2>&1 || echo "(ended with $?)"
    echo '```'
    echo
}

echo "## $(date -u +%Y-%m-%d), $(uname -srm)"
echo
sed -n 's/^model name[^:]*: //p' /proc/cpuinfo 2>/dev/null | sort | uniq -c | sed 's/^ */Processors: /'
echo "Commit: $(git rev-parse --short HEAD 2>/dev/null || echo unknown)"
echo
if command -v nvidia-smi >/dev/null; then
    fenced nvidia-smi --query-gpu=name,driver_version,clocks.max.sm,power.limit --format=csv
fi

echo "### Devices"
echo
fenced "$ewa" info --gpu
if ! "$ewa" info --gpu >/dev/null 2>&1; then exit 0; fi # why is said by now

"$folder/tools/gpu_probe/gpu_probe"
echo

echo "### Tests"
echo
pattern=$(echo "$tests" | tr ' ' '|')
fenced ctest --test-dir "$folder" -R "^($pattern|gpu_probe)\$" --timeout 600

# More than this does not fit, or is not worth waiting for.
software=$("$ewa" info --gpu | grep -c 'renderer.*, software' || true)
free_gb=$(awk '/^MemAvailable/ { print int($2 / 1e6) }' /proc/meminfo 2>/dev/null || echo 8)
splats=1000000 size=1280x1024 more=10000000
[ "$free_gb" -lt 20 ] || more="$more 100000000"
[ "$software" = 0 ] || { splats=20000 size=320x240 more=100000; }

# bench TITLE ARGUMENT...: its table; its JSON goes into the last section.
json=$(mktemp)
trap 'rm -f "$json"' EXIT
bench() {
    echo "$1"
    echo
    shift
    fenced "$ewa" bench --backend gl --scene plane --workers 1 --stages off --json "$json.one" "$@"
    [ ! -f "$json.one" ] || tr -d '\n' <"$json.one" | sed 's/  */ /g' >>"$json"
    echo >>"$json"
    rm -f "$json.one"
}

echo "### Frames"
echo
echo "Stages by the device's clock, frames by the wall."
echo
bench "$splats surfels, $size" --splats $splats --size $size --pixels 9,25,100
bench "The same by the processor" --splats $splats --size $size --pixels 9,25,100 --backend cpu
bench "With one edge layer" --splats $splats --size $size --pixels 9,25,100 --edge-layers 1
bench "64x64: what does not depend on pixels" --splats $splats --size 64x64 --pixels 9
export EWA_GL_TUNING
EWA_GL_TUNING=tile_px=16 && bench "Tiles of 16x16 (\`EWA_GL_TUNING=tile_px=16\`)" --splats $splats --size $size --pixels 9,25,100
EWA_GL_TUNING=unit=256 && bench "Units of 256 splats (\`EWA_GL_TUNING=unit=256\`)" --splats $splats --size $size --pixels 9,25,100
unset EWA_GL_TUNING
bench "All culled" --scene culled --splats $splats --size 64x64
for count in $more; do bench "$count surfels" --splats "$count" --size $size --pixels 9 --frames 5; done

echo "### Gaussians"
echo
echo "Eleven balls of 90,000 Gaussians of degree 3 (of software one); GAUSSIANS=FILE takes a file instead."
echo
measure=$folder/measure/measure_gaussians copies=11
[ "$software" = 0 ] || copies=1
for by in "" gl; do
    # shellcheck disable=SC2086
    fenced "$measure" "${GAUSSIANS:-ball}" $copies ${size%x*} ${size#*x} 0 0 3 $by
done

echo "### Volumes"
echo
echo "A gyroid of 256^3 voxels (of software 16^3), whole and from near, by the processor and by the device."
echo
side=256
[ "$software" = 0 ] || side=16
for by in "" gl; do
    # shellcheck disable=SC2086
    for view in whole near; do fenced "$folder/measure/measure_volume_speed" $side 0.02 $view $by; done
done

echo "### The paper's table 1"
echo
sh tools/gpu_table.sh "$ewa" "$splats" cpu gl gl-raster
echo
echo "### Figures for programs"
echo
fenced "$folder/tools/gpu_probe/gpu_probe" --json
fenced cat "$json"
