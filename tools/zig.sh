#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Fetches clang with the C libraries of other systems (the wheel ziglang) into build/zig, and makes a compiler's name for each
# target that is asked for: build/zig/bin/TARGET-cc, with zig-ar, zig-ranlib and zig-rc.
#   tools/zig.sh wasm32-wasi x86_64-linux-musl
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)/build/zig
version=0.17.1
if [ "$(cat "$root/.complete" 2>/dev/null)" != "$version" ]; then
    echo "Fetching ziglang $version"
    mkdir -p "$root"
    { python3 -m venv "$root" && "$root/bin/pip" install -q "ziglang==$version"; } >"$root/log" 2>&1 || { tail -n 5 "$root/log" >&2; exit 1; }
    echo "$version" >"$root/.complete"
fi
zig=$("$root/bin/python" -c 'import os, ziglang; print(os.path.join(os.path.dirname(ziglang.__file__), "zig"))')
script() { # left alone where it is there, so that ccache knows it again
    printf '#!/bin/sh\nexec "%s" %s "$@"\n' "$zig" "$2" >"$root/bin/.new"
    cmp -s "$root/bin/.new" "$root/bin/$1" || cp "$root/bin/.new" "$root/bin/$1"
    chmod +x "$root/bin/$1"
}
script zig-ar ar
script zig-ranlib ranlib
script zig-rc rc
for target in "$@"; do
    case $target in
    *-macos) system=$target.11.0 ;; # the oldest that is asked for
    *) system=$target ;;
    esac
    script "$target-cc" "cc -target $system"
    script "$target-c++" "c++ -target $system"
done
