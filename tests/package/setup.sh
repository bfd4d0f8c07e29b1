#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# tools/setup.sh on machines with packages of two architectures, by lists of packages that dpkg reads in place of its own, and an
# apt-get that only says what it is asked.
#   setup.sh SOURCES FOLDER
set -eu
command -v dpkg-query >/dev/null || { echo "skipped: no dpkg-query"; exit 77; }
setup=$1/tools/setup.sh folder=$2
rm -rf "$folder"
mkdir -p "$folder/bin" "$folder/dpkg"
printf '#!/bin/sh\necho "asked: $*" >>"%s/asked"\n' "$folder" >"$folder/bin/apt-get"
printf '#!/bin/sh\nshift\nexec "$@"\n' >"$folder/bin/sudo"
chmod +x "$folder/bin/apt-get" "$folder/bin/sudo"
native=$(dpkg --print-architecture)
case $native in arm64) other=amd64 ;; *) other=arm64 ;; esac

# there ARCHITECTURE MULTI-ARCH PACKAGE...: as installed.
there() {
    architecture=$1 kind=$2
    shift 2
    for package in "$@"; do
        printf 'Package: %s\nStatus: install ok installed\nArchitecture: %s\nMulti-Arch: %s\nVersion: 1\nMaintainer: x <x@x>\nDescription: x\n\n' \
            "$package" "$architecture" "$kind"
    done >>"$folder/dpkg/status"
}
# gives STATUS TEXT [OPTION]: what setup.sh says and asks; nothing where the text is empty.
gives() {
    rm -f "$folder/asked"
    status=0
    DPKG_ADMINDIR=$folder/dpkg PATH=$folder/bin:$PATH sh "$setup" ${3:-} >"$folder/said" 2>&1 || status=$?
    cat "$folder/asked" >>"$folder/said" 2>/dev/null || true
    [ "$status" = "$1" ] && if [ -n "$2" ]; then grep -qF -e "$2" "$folder/said"; else [ ! -s "$folder/said" ]; fi && return
    echo "setup.sh gives $status: $(cat "$folder/said"); not $1: $2" >&2
    exit 1
}
all=$(sed -n 's/^\(packages\|further\)="\([a-z].*\)"$/\2/p' "$setup")
# shellcheck disable=SC2086
set -- $all
# Every package twice, those without code once: nothing is asked.
there "$native" same "$@"
there "$other" same "$@"
gives 0 ""
# Of the program: the window's are not asked for.
sed -i "/^Package: libsdl2-dev\$/,/^\$/d" "$folder/dpkg/status"
gives 0 "" --program
gives 0 "install -y -q --no-install-recommends libsdl2-dev"
there "$native" same libsdl2-dev
# One for the other architecture alone, that can stand beside ours: ours is asked for, and nothing else.
sed -i "/^Package: zlib1g-dev\$/{N;N;s/Architecture: $native/Architecture: $other/}" "$folder/dpkg/status"
gives 0 "install -y -q --no-install-recommends zlib1g-dev"
[ "$(grep -c 'asked: install' "$folder/said")" = 1 ]
# One that cannot: a clear line.
sed -i "/^Package: libopenexr-dev\$/,/^\$/d" "$folder/dpkg/status"
there "$other" no libopenexr-dev
gives 1 "would be replaced: libopenexr-dev:$native (there for $other)"
[ ! -e "$folder/asked" ]
