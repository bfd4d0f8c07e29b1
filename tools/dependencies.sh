#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Builds zlib, libdeflate, cJSON, zstd, libspng and expat (but for WebAssembly bzip2, libwebp, libjpeg-turbo, OpenEXR and cmocka too)
# from Debian's source packages as static libraries for a target that has no packages, into build/sysroot/TARGET; nothing is
# installed, and nothing of them is copied into the tree.
#   tools/dependencies.sh wasm32-wasi [FLAG...]     by the compiler of tools/zig.sh
set -eu
target=$1
shift
root=$(cd "$(dirname "$0")/.." && pwd)/build
bin=$root/zig/bin
sources=$root/sources
prefix=$root/sysroot/$target
further="bzip2=1.0.8-5 libwebp=1.2.4-0.2+deb12u1 libjpeg-turbo=1:2.1.5-2 openexr=3.1.5-5 imath=3.1.6-1 cmocka=1.1.5-2.1 musl=1.2.3-1"
case $target in wasm*) further= ;; esac
packages="zlib=1:1.2.13.dfsg-1 libdeflate=1.14-1 cjson=1.7.15-1+deb12u4 libzstd=1.5.4+dfsg2-5 libspng=0.7.3-3 expat=2.5.0-1+deb12u2"
# For a page, what is small in place of what is fast; of zstd as its README says.
level=-O2 small=
case $target in wasm*) level=-Os small="-DHUF_FORCE_DECOMPRESS_X1 -DZSTD_FORCE_DECOMPRESS_SEQUENCES_SHORT -DZSTD_NO_INLINE -DZSTD_STRIP_ERROR_STRINGS" ;; esac
wanted="$packages $further $* $(cksum <"$0")" # what this script does, too
[ "$(cat "$prefix/.complete" 2>/dev/null)" != "$wanted" ] || exit 0

# fetch FOLDER PACKAGE...: sources by Debian's names and versions.
fetch() {
    folder=$1
    shift
    [ "$(cat "$folder/.complete" 2>/dev/null)" != "$*" ] || return 0
    echo "Fetching Debian's sources"
    rm -rf "$folder"
    mkdir -p "$folder/.apt/lists/partial" "$folder/.apt/archives/partial"
    for suite in bookworm bookworm-updates; do
        echo "deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] http://deb.debian.org/debian $suite main"
    done >"$folder/.apt/sources.list"
    echo "deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] http://deb.debian.org/debian-security bookworm-security main" >>"$folder/.apt/sources.list"
    options="-o APT::Sandbox::User=$(id -un) -o Dir::Etc::sourcelist=$folder/.apt/sources.list -o Dir::Etc::sourceparts=/dev/null -o Dir::State::lists=$folder/.apt/lists -o Dir::Cache=$folder/.apt -o Dir::Cache::archives=$folder/.apt/archives"
    # shellcheck disable=SC2086
    (cd "$folder" && apt-get -q $options update && apt-get -q $options source "$@") >"$folder/log" 2>&1 ||
        { tail -n 5 "$folder/log" >&2; exit 1; }
    rm -rf "$folder/.apt"
    echo "$*" >"$folder/.complete"
}
# shellcheck disable=SC2086
fetch "$sources" $packages
# shellcheck disable=SC2086
[ -z "$further" ] || fetch "$root/sources_further" $further

echo "Building libraries for $target"
rm -rf "$prefix"
mkdir -p "$prefix/include/cjson" "$prefix/lib/pkgconfig" "$prefix/objects"

# A library of macOS shows all that it is linked of and that is not hidden; of Linux and Windows lists say what it shows.
hidden=
case $target in *-macos) hidden="-fvisibility=hidden -DWEBP_EXTERN=extern -DZSTDLIB_VISIBLE= -DZSTDERRORLIB_VISIBLE= -DLIBDEFLATEEXPORT=" ;; esac

# library NAME MODULE VERSION REQUIRES FLAGS FILE...: one static library and its pkg-config file, by which who uses it gets $seen.
seen=
library() {
    name=$1 module=$2 version=$3 requires=$4 flags=$5
    shift 5
    objects=
    for file in "$@"; do
        object=$prefix/objects/$name-$(echo "$file" | tr / _).o
        # shellcheck disable=SC2086
        $launcher "$bin/$target-cc" $level -fPIC $hidden $more $flags -I"$prefix/include" -c "$file" -o "$object" 2>>"$prefix/log" ||
            { tail -n 10 "$prefix/log" >&2; exit 1; }
        objects="$objects $object"
    done
    # shellcheck disable=SC2086
    "$bin/zig-ar" rcs "$prefix/lib/lib$name.a" $objects
    printf 'prefix=%s\nName: %s\nDescription: %s\nVersion: %s\nRequires: %s\nLibs: -L${prefix}/lib -l%s\nCflags: -I${prefix}/include %s\n' \
        "$prefix" "$module" "$module" "$version" "$requires" "$name" "$seen" >"$prefix/lib/pkgconfig/$module.pc"
}
more="$*"
launcher=${CMAKE_C_COMPILER_LAUNCHER:-} # ccache, where the Makefile has found it
cd "$sources"/zlib-*/
cp zlib.h zconf.h "$prefix/include"
# A macro of macOS makes this zlib believe in a system before it, where streams had no descriptors.
library z zlib 1.2.13 "" -Dfdopen=fdopen adler32.c compress.c crc32.c deflate.c inffast.c inflate.c inftrees.c trees.c uncompr.c zutil.c
cd "$sources"/libdeflate-*/
cp libdeflate.h "$prefix/include"
library deflate libdeflate 1.14 "" "-I." lib/adler32.c lib/crc32.c lib/deflate_compress.c lib/deflate_decompress.c lib/gzip_compress.c \
    lib/gzip_decompress.c lib/utils.c lib/zlib_compress.c lib/zlib_decompress.c lib/x86/cpu_features.c lib/arm/cpu_features.c
cd "$sources"/cjson-*/
cp cJSON.h "$prefix/include/cjson"
seen=-DCJSON_HIDE_SYMBOLS # which a DLL would show
library cjson libcjson 1.7.15 "" "$seen" cJSON.c
seen=
cd "$sources"/libzstd-*/
cp lib/zstd.h lib/zstd_errors.h "$prefix/include"
library zstd libzstd 1.5.4 "" "-Ilib -DZSTD_DISABLE_ASM $small" lib/common/*.c lib/compress/*.c lib/decompress/*.c
cd "$sources"/libspng-*/
cp spng/spng.h "$prefix/include"
seen=-DSPNG_STATIC
library spng spng 0.7.3 zlib "$seen" spng/spng.c
cd "$sources"/expat-*/expat
cp lib/expat.h lib/expat_external.h "$prefix/include"
printf '#define BYTEORDER 1234\n#define HAVE_MEMMOVE 1\n#define XML_NS 1\n#define XML_DTD 1\n#define XML_CONTEXT_BYTES 1024\n#if defined(__APPLE__) || defined(__wasm__)\n#define HAVE_ARC4RANDOM_BUF 1\n#elif !defined(_WIN32)\n#define XML_DEV_URANDOM 1\n#endif\n' >lib/expat_config.h
seen=-DXML_STATIC
library expat expat 2.5.0 "" "$seen -Ilib" lib/xmlparse.c lib/xmlrole.c lib/xmltok.c
seen=
if [ -n "$further" ]; then
    sources=$root/sources_further
    seen=
    # Functions that Windows and macOS would take from their own library, which each version rounds as it likes, and fma(), which for
    # Windows adds in long double and so rounds twice; the toolchain names the library, so that it comes first.
    math="acos asin atan atan2 cbrt fma hypot pow pow_data exp_data __math_divzero __math_divzerof __math_invalid __math_invalidf __math_invalidl
        __math_oflow __math_oflowf __math_uflow __math_uflowf __math_xflow __math_xflowf"
    case $target in
    *-macos) math="$math cos exp log log10 log2 log2_data log_data sin tan __cos __rem_pio2 __rem_pio2_large __sin __tan scalbn" ;;
    *-windows-*) ;;
    *) math= ;;
    esac
    if [ -n "$math" ]; then
        cd "$sources"/musl-*/
        printf '#define __LITTLE_ENDIAN 1\n#define __BYTE_ORDER 1\n' >"$prefix/objects/endian.h"
        : >"$prefix/objects/features.h"
        echo '#define a_clz_64 __builtin_clzll' >"$prefix/objects/atomic.h"
        # shellcheck disable=SC2046
        library musl_math musl_math 1.2.3 "" "-fvisibility=hidden -I$prefix/objects -Isrc/internal -Iarch/generic -Dhidden=" \
            $(printf 'src/math/%s.c ' $math)
    fi
    cd "$sources"/bzip2-*/
    sed 's/^#ifdef _WIN32/#if 0 \/* a static library *\//' bzlib.h >"$prefix/include/bzlib.h" # else it declares pointers into a DLL
    library bz2 bzip2 1.0.8 "" "-include $prefix/include/bzlib.h" blocksort.c huffman.c crctable.c randtable.c compress.c decompress.c bzlib.c
    cd "$sources"/libwebp-*/
    mkdir -p "$prefix/include/webp"
    cp src/webp/*.h "$prefix/include/webp"
    library webp libwebp 1.2.4 "" -I. src/dec/*.c src/dsp/*.c src/enc/*.c src/utils/*.c sharpyuv/*.c
    cd "$sources"/libjpeg-turbo-*/
    cmake -S . -B "$prefix/objects/jpeg" -G Ninja -DCMAKE_TOOLCHAIN_FILE="$root/../cmake/toolchains/$target.cmake" -DCMAKE_BUILD_TYPE=Release \
        ${hidden:+-DCMAKE_C_VISIBILITY_PRESET=hidden -DCMAKE_POLICY_DEFAULT_CMP0063=NEW} -DCMAKE_POSITION_INDEPENDENT_CODE=ON -DENABLE_SHARED=OFF -DWITH_SIMD=OFF -DWITH_TURBOJPEG=OFF -DCMAKE_INSTALL_PREFIX="$prefix" >>"$prefix/log" 2>&1 || { tail -n 10 "$prefix/log" >&2; exit 1; }
    cmake --build "$prefix/objects/jpeg" --target jpeg-static >>"$prefix/log" 2>&1 || { tail -n 10 "$prefix/log" >&2; exit 1; }
    cp jpeglib.h jmorecfg.h jerror.h "$prefix/objects/jpeg/jconfig.h" "$prefix/include"
    cp "$prefix/objects/jpeg/libjpeg.a" "$prefix/lib"
    cp "$prefix/objects/jpeg/pkgscripts/libjpeg.pc" "$prefix/lib/pkgconfig"
    cd "$sources"/openexr-*/src/lib/OpenEXRCore
    mkdir -p "$prefix/include/OpenEXR" "$prefix/lib/cmake/OpenEXR"
    sed 's/^#cmakedefine.*//; s/@OpenEXR_VERSION_MINOR@/1/; s/@OpenEXR_VERSION_PATCH@/5/; s/@[A-Za-z_]*@/3/' ../../../cmake/OpenEXRConfig.h.in \
        >"$prefix/include/OpenEXR/OpenEXRConfig.h"
    cp openexr*.h "$prefix/include/OpenEXR"
    : >IlmThreadConfig.h
    sed 's/^#cmakedefine.*//; s/@[A-Za-z_]*@/3/' "$sources"/imath-*/config/ImathConfig.h.in >ImathConfig.h
    library OpenEXRCore OpenEXRCore 3.1.5 zlib "-I. -I$prefix/include/OpenEXR -I$(echo "$sources"/imath-*/src/Imath)" ./*.c
    cat >"$prefix/lib/cmake/OpenEXR/OpenEXRConfig.cmake" <<'CONFIG'
get_filename_component(prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
add_library(OpenEXR::OpenEXRCore STATIC IMPORTED)
set_target_properties(OpenEXR::OpenEXRCore PROPERTIES IMPORTED_LOCATION "${prefix}/lib/libOpenEXRCore.a"
  INTERFACE_INCLUDE_DIRECTORIES "${prefix}/include;${prefix}/include/OpenEXR" INTERFACE_LINK_LIBRARIES "${prefix}/lib/libz.a")
CONFIG
    cd "$sources"/cmocka-*/
    cp include/cmocka*.h "$prefix/include"
    case $target in *-windows-*) has="-DHAVE_IO_H -DHAVE_MALLOC_H" ;; *) has=-DHAVE_UNISTD_H ;; esac
    case $target in *-musl) seen=-D_UINTPTR_T ;; esac # its header declares the type where this is not seen, which musl has declared
    library cmocka cmocka 1.1.5 "" "$seen -Iinclude -DHAVE_SIGNAL_H -DHAVE_STRUCT_TIMESPEC -DHAVE_INTTYPES_H -DHAVE_STDINT_H $has -DHAVE_STRINGS_H -DHAVE_TIME_H" src/cmocka.c
fi
rm -rf "$prefix/objects"
echo "$wanted" >"$prefix/.complete"
