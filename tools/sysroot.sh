#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Unpacks Debian's packages of another architecture, and what they need, into a folder, for emulated runs: nothing is installed, so
# packages that cannot stand beside this machine's own are no trouble, and no rights are needed.
#   tools/sysroot.sh arm64 build/sysroot/arm64 libc6 python3
set -eu
architecture=$1
root=$2
shift 2
packages="$*"
suite=${EWA_SYSROOT_SUITE:-bookworm}
mirror=${EWA_SYSROOT_MIRROR:-http://deb.debian.org/debian}

[ "$(cat "$root/.complete" 2>/dev/null)" != "$packages" ] || exit 0
mkdir -p "$root" && root=$(cd "$root" && pwd)
state=$root/.apt
mkdir -p "$state/lists/partial" "$state/archives/partial" "$state/dpkg" "$state/etc"
: >"$state/dpkg/status"
echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $mirror $suite main" >"$state/etc/sources.list"
apt() {
    apt-get -q -o APT::Architecture="$architecture" -o APT::Architectures="$architecture" \
        -o APT::Sandbox::User="$(id -un)" -o Dir::Etc::sourcelist="$state/etc/sources.list" -o Dir::Etc::sourceparts=/dev/null \
        -o Dir::State="$state" -o Dir::State::lists="$state/lists" -o Dir::State::status="$state/dpkg/status" \
        -o Dir::Cache="$state" -o Dir::Cache::archives="$state/archives" -o Debug::NoLocking=1 "$@"
}
echo "Fetching Debian's packages for $architecture"
apt update >"$state/log" 2>&1 || { tail -n 5 "$state/log" >&2; exit 1; }
# shellcheck disable=SC2086
apt install -y --no-install-recommends --download-only $packages >>"$state/log" 2>&1 || { tail -n 5 "$state/log" >&2; exit 1; }
for package in "$state"/archives/*.deb; do dpkg-deb -x "$package" "$root"; done
# Links to absolute names would lead out of the folder.
find "$root" -type l -lname '/*' | while read -r link; do ln -sfn "$root$(readlink "$link")" "$link"; done
rm -rf "$state"
echo "$packages" >"$root/.complete"
