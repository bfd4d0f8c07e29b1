#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Builds zlib, libdeflate, cJSON, zstd and libspng from Debian's source packages as static libraries for a target that has no
# packages, into build/sysroot/TARGET; nothing is installed, and nothing of them is copied into the tree.
#   tools/dependencies.sh wasm32-wasi [FLAG...]     by the compiler of tools/zig.sh
set -eu
target=$1
shift
root=$(cd "$(dirname "$0")/.." && pwd)/build
bin=$root/zig/bin
sources=$root/sources
prefix=$root/sysroot/$target
packages="zlib=1:1.2.13.dfsg-1 libdeflate=1.14-1 cjson=1.7.15-1+deb12u4 libzstd=1.5.4+dfsg2-5 libspng=0.7.3-3"
wanted="$packages $*"
[ "$(cat "$prefix/.complete" 2>/dev/null)" != "$wanted" ] || exit 0

if [ "$(cat "$sources/.complete" 2>/dev/null)" != "$packages" ]; then
    echo "Fetching Debian's sources"
    rm -rf "$sources"
    mkdir -p "$sources/.apt/lists/partial" "$sources/.apt/archives/partial"
    for suite in bookworm bookworm-updates; do
        echo "deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] http://deb.debian.org/debian $suite main"
    done >"$sources/.apt/sources.list"
    echo "deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] http://deb.debian.org/debian-security bookworm-security main" >>"$sources/.apt/sources.list"
    options="-o APT::Sandbox::User=$(id -un) -o Dir::Etc::sourcelist=$sources/.apt/sources.list -o Dir::Etc::sourceparts=/dev/null -o Dir::State::lists=$sources/.apt/lists -o Dir::Cache=$sources/.apt -o Dir::Cache::archives=$sources/.apt/archives"
    # shellcheck disable=SC2086
    (cd "$sources" && apt-get -q $options update && apt-get -q $options source $packages) >"$sources/log" 2>&1 ||
        { tail -n 5 "$sources/log" >&2; exit 1; }
    rm -rf "$sources/.apt"
    echo "$packages" >"$sources/.complete"
fi

echo "Building libraries for $target"
rm -rf "$prefix"
mkdir -p "$prefix/include/cjson" "$prefix/lib/pkgconfig" "$prefix/objects"

# library NAME MODULE VERSION REQUIRES FLAGS FILE...: one static library and its pkg-config file.
library() {
    name=$1 module=$2 version=$3 requires=$4 flags=$5
    shift 5
    objects=
    for file in "$@"; do
        object=$prefix/objects/$name-$(echo "$file" | tr / _).o
        # shellcheck disable=SC2086
        "$bin/$target-cc" -O2 -fPIC $more $flags -I"$prefix/include" -c "$file" -o "$object" 2>>"$prefix/log" ||
            { tail -n 10 "$prefix/log" >&2; exit 1; }
        objects="$objects $object"
    done
    # shellcheck disable=SC2086
    "$bin/zig-ar" rcs "$prefix/lib/lib$name.a" $objects
    printf 'prefix=%s\nName: %s\nDescription: %s\nVersion: %s\nRequires: %s\nLibs: -L${prefix}/lib -l%s\nCflags: -I${prefix}/include\n' \
        "$prefix" "$module" "$module" "$version" "$requires" "$name" >"$prefix/lib/pkgconfig/$module.pc"
}
more="$*"
cd "$sources"/zlib-*/
cp zlib.h zconf.h "$prefix/include"
library z zlib 1.2.13 "" "" adler32.c compress.c crc32.c deflate.c inffast.c inflate.c inftrees.c trees.c uncompr.c zutil.c
cd "$sources"/libdeflate-*/
cp libdeflate.h "$prefix/include"
library deflate libdeflate 1.14 "" "-I." lib/adler32.c lib/crc32.c lib/deflate_compress.c lib/deflate_decompress.c lib/gzip_compress.c \
    lib/gzip_decompress.c lib/utils.c lib/zlib_compress.c lib/zlib_decompress.c lib/x86/cpu_features.c lib/arm/cpu_features.c
cd "$sources"/cjson-*/
cp cJSON.h "$prefix/include/cjson"
library cjson libcjson 1.7.15 "" "" cJSON.c
cd "$sources"/libzstd-*/
cp lib/zstd.h lib/zstd_errors.h "$prefix/include"
library zstd libzstd 1.5.4 "" "-Ilib -DZSTD_DISABLE_ASM" lib/common/*.c lib/compress/*.c lib/decompress/*.c
cd "$sources"/libspng-*/
cp spng/spng.h "$prefix/include"
library spng spng 0.7.3 zlib "" spng/spng.c
rm -rf "$prefix/objects"
echo "$wanted" >"$prefix/.complete"
