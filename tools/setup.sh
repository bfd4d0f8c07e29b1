#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Installs the Debian packages that building and testing need, when they are missing and we may; otherwise prints the
# line to type and fails. Calls no package manager when everything is there.
#   setup.sh [--program] [PACKAGE...]     --program: what the program needs, without window, graphics processors, MPI, Python and tests
set -eu

packages="build-essential cmake ninja-build pkg-config libspng-dev libdeflate-dev libopenexr-dev libcjson-dev libjpeg62-turbo-dev libwebp-dev libtiff-dev libexpat1-dev zlib1g-dev libzstd-dev liblzma-dev libsuitesparse-dev libmeshoptimizer-dev libdraco-dev libbz2-dev libcurl4-openssl-dev libcivetweb-dev"
further="libcmocka-dev libassimp-dev libsdl2-dev libimgui-dev libepoxy-dev libegl-dev libegl-mesa0 libopengl0 libgl1-mesa-dri glslang-tools libopenmpi-dev openmpi-bin python3-venv python3-numpy python3-pandas"
modules="spng libdeflate OpenEXR libcjson libjpeg libwebp libtiff-4 expat zlib libzstd liblzma"
if [ "${1:-}" = --program ]; then
    shift
else
    packages="$packages $further" modules="$modules cmocka"
fi

# A package may be there for several architectures, or for another one alone; where it cannot be there for two, ours would push the
# other out, which nobody has asked for.
missing="" foreign=""
native=$(dpkg --print-architecture 2>/dev/null || true)
for package in $packages "$@"; do
    installed=$(dpkg-query -W -f '${Architecture} ${db:Status-Status} ${Multi-Arch}\n' "$package" 2>/dev/null | grep ' installed ' || true)
    case "
$installed" in
    *"
$native "* | *"
all "*) ;;
    *" installed same"*) missing="$missing $package" ;;
    *" installed "*) foreign="$foreign $package:$native (there for ${installed%% *})" ;;
    *) missing="$missing $package" ;;
    esac
done
if [ -n "$foreign" ]; then
    echo "Packages are there for another architecture alone, and would be replaced:$foreign. If they may be, install them, then try again." >&2
    exit 1
fi
[ -n "$missing" ] || exit 0

# Elsewhere than on Debian, other names may stand for the same things.
if ! command -v apt-get >/dev/null 2>&1; then
    needs_tools=""
    for tool in cc cmake ninja pkg-config; do
        command -v $tool >/dev/null 2>&1 || needs_tools="$needs_tools $tool"
    done
    # shellcheck disable=SC2086
    if [ -z "$needs_tools" ] && pkg-config --exists $modules; then exit 0; fi
    echo "Please install these first (names of Debian):$missing" >&2
    exit 1
fi

if [ "$(id -u)" = 0 ]; then
    run=""
elif command -v sudo >/dev/null 2>&1 && sudo -n true 2>/dev/null; then
    run="sudo -n"
else
    echo "Packages are missing. Please type this, then try again:" >&2
    echo "  sudo apt-get install -y --no-install-recommends$missing" >&2
    exit 1
fi
echo "Installing:$missing"
export DEBIAN_FRONTEND=noninteractive
$run apt-get update -q >/dev/null || true
# shellcheck disable=SC2086
if ! $run apt-get install -y -q --no-install-recommends $missing >/tmp/ewa-setup.$$ 2>&1; then
    tail -n 20 /tmp/ewa-setup.$$ >&2
    rm -f /tmp/ewa-setup.$$
    exit 1
fi
rm -f /tmp/ewa-setup.$$
