#!/bin/bash
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Draws the textured floor of measure/texture_scene.h with ImageMagick and with ewa, and prints time and error
# of each as rows of a table: compare_texture.sh BUILD_FOLDER [IMAGE...]
#
# Without ImageMagick's convert, only ewa's rows. All run with one thread; times are the processor's for the whole
# process, PNG in and PNG out, the best of three, or of one that takes over three seconds.
set -eu
build=$1
shift
measure=$build/measure/measure_texture
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export OMP_NUM_THREADS=1 MAGICK_THREAD_LIMIT=1

TIMEFORMAT=%U
seconds() {
    best=
    for run in 1 2 3; do
        took=$({ time "$@" >/dev/null 2>&1; } 2>&1)
        if [ -z "$best" ] || [ "$(echo "$took < $best" | bc)" = 1 ]; then best=$took; fi
        [ "$(echo "$took > 3" | bc)" = 1 ] && break
    done
    printf '%.3f' "$best"
}

row() { # NAME PICTURE IMAGE SECONDS
    errors=$("$measure" error "$2" $3 | cut -d'|' -f3-)
    echo "| $1 | $4 |$errors"
}

echo "| picture | method | s | near dB | middle dB | horizon dB | all dB |"
echo "|---|---|---:|---:|---:|---:|---:|"
for image in "" "$@"; do
    points=$("$measure" files "$work" $image)
    name=$(basename "${image:-checker}" .png)
    homography=$("$measure" homography - $image)
    for method in hybrid splat bilinear; do
        time=$(seconds "$build/cli/ewa" texture "$work/texture.png" -o "$work/out.png" --homography "$homography" \
            --size 512x512 --method $method --threads 1 --background 0,0,0)
        row "$name | ewa $method" "$work/out.png" "$image" "$time"
    done
    command -v convert >/dev/null || continue
    time=$(seconds convert "$work/texture.png" -virtual-pixel black -set option:distort:viewport 512x512+0+0 \
        -distort Perspective "$points" "PNG24:$work/out.png")
    row "$name | convert, its EWA" "$work/out.png" "$image" "$time"
    time=$(seconds convert "$work/texture.png" -colorspace RGB -virtual-pixel black \
        -set option:distort:viewport 512x512+0+0 -distort Perspective "$points" -colorspace sRGB "PNG24:$work/out.png")
    row "$name | convert, EWA in linear light" "$work/out.png" "$image" "$time"
    time=$(seconds convert "$work/texture.png" -filter point -interpolate bilinear -virtual-pixel black \
        -set option:distort:viewport 512x512+0+0 -distort Perspective "$points" "PNG24:$work/out.png")
    row "$name | convert, bilinear" "$work/out.png" "$image" "$time"
done
