#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Makes the pictures of docs/gallery anew from the commands that docs/gallery/README.md shows: gallery.sh EWA
#
# Blocks that name $EWA_DATA, a folder with scans that are not ours to distribute, are left out when it is not set;
# those that call ffmpeg, to put pictures side by side, when it is not installed; those that open a window, without
# Xvfb, xdotool and ImageMagick; those of a page, without node, Chromium and the modules of `make wasm`.
set -eu
program=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
tools=$(cd "$(dirname "$0")" && pwd)
gallery=$(cd "$(dirname "$0")/../docs/gallery" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# 1 where all these programs are installed.
have() {
    for name; do command -v "$name" >/dev/null || return 0; done
    echo 1
}
have_ffmpeg=$(have ffmpeg)
have_screen=$(have Xvfb xdotool import)
have_browser=$(have node chromium convert)
[ -f "$(dirname "$program")/../../wasm/page/page.wasm.gz" ] || have_browser=""

awk -v have_browser="$have_browser" -v have_data="${EWA_DATA:+1}" -v have_ffmpeg="$have_ffmpeg" -v have_screen="$have_screen" '
    /^```sh$/ { inside = 1; block = ""; next }
    /^```$/ && inside {
        inside = 0
        if (block ~ /\$EWA_DATA/ && !have_data) print "skipped, for EWA_DATA is not set:\n" block >"/dev/stderr"
        else if (block ~ /ffmpeg/ && !have_ffmpeg) print "skipped, for want of ffmpeg:\n" block >"/dev/stderr"
        else if (block ~ /Xvfb/ && !have_screen) print "skipped, for want of a screen:\n" block >"/dev/stderr"
        else if (block ~ /page_shot/ && !have_browser) print "skipped, for want of a browser, or of make wasm:\n" block >"/dev/stderr"
        else printf "%s", block
        next
    }
    inside { block = block $0 "\n" }' "$gallery/README.md" >"$work/commands"

ewa() { "$program" "$@"; }
frustum() { "$(dirname "$program")/../examples/frustum" "$@"; }
make_environment() { python3 "$tools/make_environment.py" "$@"; }
page_shot() { node --no-warnings "$tools/page_shot.mjs" "$@"; }
measure_acquire() { "$(dirname "$program")/../measure/measure_acquire" "$@"; }
measure_layers() { "$(dirname "$program")/../measure/measure_layers" "$@"; }
measure_warp() { "$(dirname "$program")/../measure/measure_warp" "$@"; }
measure_textured() { "$(dirname "$program")/../measure/measure_textured" "$@"; }
# mpirun -n N ewa-mpi COMMAND ...: as it is, or by one process where there is no MPI, which makes the same bytes.
mpirun() {
    ranks=$2
    shift 3
    if command -v mpiexec >/dev/null && [ -x "$(dirname "$program")/../mpi/ewa-mpi" ]; then
        OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 \
            mpiexec -n "$ranks" "$(dirname "$program")/../mpi/ewa-mpi" "$@"
    else
        "$program" "$@"
    fi
}
cd "$work"
set -x
. ./commands
set +x
for picture in *.png; do
    size=$(wc -c <"$picture")
    [ "$size" -le 204800 ] || echo "warning: $picture has $size bytes, over 200 KiB" >&2
    mv "$picture" "$gallery/"
done
