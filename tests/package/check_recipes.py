#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Holds the recipes of packaging/ to cmake/: check_recipes.py ROOT.

Each names every library of cmake/dependencies.cmake by its package manager's name, or switches it off; no switch is set that does
not exist; and what a tool of the manager can read here, it reads.
"""
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(sys.argv[1])
RECIPES = {
    "conda": "packaging/conda/recipe.yaml",
    "vcpkg": "packaging/vcpkg/ewa/vcpkg.json",
    "homebrew": "packaging/homebrew/ewa.rb",
    "nix": "packaging/nix/default.nix",
}
SWITCHED_BY = {"vcpkg": "packaging/vcpkg/ewa/portfile.cmake"}
# By switch: what the managers call it, where they do not all say the same.
NAMES = {
    "SPNG": {"": "libspng"},
    "DEFLATE": {"": "libdeflate"},
    "CJSON": {"": "cjson"},
    "JPEG": {"": "libjpeg-turbo", "homebrew": "jpeg-turbo", "nix": "libjpeg"},
    "WEBP": {"": "libwebp", "conda": "libwebp-base", "homebrew": "webp"},
    "TIFF": {"": "libtiff", "vcpkg": "tiff"},
    "E57": {"": "expat", "conda": "libexpat"},
    "ZLIB": {"": "zlib"},
    "ZSTD": {"": "zstd"},
    "BZIP2": {"": "bzip2"},
    "CHOLMOD": {"": "suitesparse", "vcpkg": "suitesparse-cholmod"},
    "MESHOPT": {"": "meshoptimizer"},
    "DRACO": {"": "draco"},
    "CURL": {"": "curl", "conda": "libcurl"},
    "CIVETWEB": {"": "civetweb"},
    "EXR": {"": "openexr"},
    "DWA": {"": "openexr"},
    "LZMA": {"": "xz", "conda": "liblzma-devel", "vcpkg": "liblzma"},
    "GL": {"": "libepoxy"},
    "ASSIMP": {"": "assimp"},
    "WINDOW": {"": "sdl2"},
}
OF_THE_PROGRAM = {"CIVETWEB", "ASSIMP", "WINDOW"}
OWN = {"THREADS", "MMAP"}  # no library


def text_of(name):
    """Without comments."""
    return re.sub(r"(?m)^\s*#.*\n", "", (ROOT / name).read_text(encoding="utf-8"))


def main():
    cmake = "".join(text_of(path) for folder in ("cmake", "import") for path in (ROOT / folder).iterdir()
                    if path.suffix in (".cmake", ".txt"))
    switches = set(re.findall(r"ewa_(?:part|module|library)\(([A-Z]\w*)", cmake)) | set(re.findall(r"set\(EWA_WITH_(\w+) AUTO", cmake))
    faults = [f"{switch} is in no table of this test" for switch in switches - set(NAMES) - OWN]
    faults += [f"{switch} is no switch of cmake/" for switch in (set(NAMES) | OWN) - switches]
    for manager, name in RECIPES.items():
        recipe = text_of(name)
        told = recipe + text_of(SWITCHED_BY[manager]) if manager in SWITCHED_BY else recipe
        named = set(re.findall(r"EWA_WITH_([A-Z]\w*)", told))
        faults += [f"{name}: EWA_WITH_{switch} is no switch" for switch in named - switches]
        left_out = set(re.findall(r"EWA_WITH_([A-Z]\w*)=OFF", told))
        in_list = re.search(r"%w\[([A-Z\w ]+)\]\.map \{ \|part\| \"-DEWA_WITH_", recipe)
        left_out |= set(in_list.group(1).split()) if in_list else set()
        faults += [f"{name}: {switch} is no switch" for switch in left_out - switches]
        if "EWA_BUILD_CLI=OFF" in told:
            left_out |= OF_THE_PROGRAM
        for switch, names in NAMES.items():
            package = names.get(manager, names[""])
            there = re.search(rf"(?m)(?<![\w-]){re.escape(package)}(?![\w-])", recipe)
            if switch not in left_out and not there:
                faults.append(f"{name}: neither {package} nor EWA_WITH_{switch}=OFF")
            if switch in left_out and there and manager != "vcpkg":
                faults.append(f"{name}: {package}, but EWA_WITH_{switch}=OFF")
    json.loads(text_of(RECIPES["vcpkg"]))
    for command in (["ruby", "-c", RECIPES["homebrew"]], ["nix-instantiate", "--parse", RECIPES["nix"]]):
        if shutil.which(command[0]):
            done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
            faults += [f"{command[-1]}: {done.stderr.strip()}"] if done.returncode else []
    print("\n".join(faults) or f"{len(RECIPES)} recipes, {len(switches)} switches")
    return bool(faults)


if __name__ == "__main__":
    sys.exit(main())
