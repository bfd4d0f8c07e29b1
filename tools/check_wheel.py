#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Looks into a wheel of tools/wheel.sh, whose library may be for a machine that is not here: is it what its name says?

  check_wheel.py WHEEL

The processor and the system's version are those of the name, it needs nothing but that system's own libraries and none of their
newer functions, shows names of ewa's alone, and comes with the licences of what is linked into it. Needs `lief`.
"""
from __future__ import annotations

import hashlib
import re
import struct
import sys
import zipfile
from pathlib import PurePosixPath

import lief

# Of each system: what a library may need.
LIBRARIES = {
    "manylinux": r"lib(c|m|dl|pthread|rt)\.so\.[0-9]|ld-linux-(x86-64|aarch64)\.so\.[0-9]",
    "musllinux": r"libc\.so|libc\.musl-(x86_64|aarch64)\.so\.1",
    "macosx": r"/usr/lib/libSystem\.B\.dylib",
    "win": r"(?i)(kernel32|advapi32|shell32|ntdll|api-ms-win-crt-[a-z]+-l1-1-0)\.dll",
}
LICENCES = ("zlib", "libdeflate", "cjson", "libzstd", "libspng", "bzip2", "expat", "libwebp", "libjpeg-turbo", "openexr")
MOST_BYTES = 5_000_000
LINKERS = ("__dso_handle", "_mh_dylib_header")  # names that a linker gives a library of macOS


def check_elf(library: lief.ELF.Binary, system: str, version: tuple[int, ...], machine: str) -> list[str]:
    """What is wrong with a library of Linux; prints the newest version of the C library that it needs."""
    wrong = []
    if library.header.machine_type.name != {"x86_64": "X86_64", "aarch64": "AARCH64"}[machine]:
        wrong.append(f"it is for {library.header.machine_type.name}")
    versions = [tuple(int(part) for part in entry.name[6:].split("."))
                for need in library.symbols_version_requirement for entry in need.get_auxiliary_symbols()
                if re.fullmatch(r"GLIBC_[0-9.]+", entry.name)]
    if system == "manylinux":
        print(f"  needs glibc {'.'.join(map(str, max(versions)))}")
        if max(versions) > version:
            wrong.append(f"it needs glibc {max(versions)}")
    elif versions:
        wrong.append("it needs glibc")
    if library.has(lief.ELF.DynamicEntry.TAG.RPATH) or library.has(lief.ELF.DynamicEntry.TAG.RUNPATH):
        wrong.append("it has a path to look for libraries")
    return wrong


def is_signed(data: bytes, at: int) -> bool:
    """Whether the signature that begins `at` bytes into a library of macOS is that of its pages."""
    _, _, count = struct.unpack_from(">III", data, at)
    for entry in range(count):
        kind, offset = struct.unpack_from(">II", data, at + 12 + 8 * entry)
        if kind != 0:  # a directory of the code
            continue
        first, _, _, pages, end = struct.unpack_from(">IIIII", data, at + offset + 16)
        size, method, _, log2_page = struct.unpack_from("BBBB", data, at + offset + 36)
        first += at + offset
        return method == 2 and all(
            hashlib.sha256(data[page << log2_page:min(page + 1 << log2_page, end)]).digest() == data[first + page * size:first + page * size + size]
            for page in range(pages))
    return False


def check_macho(library: lief.MachO.Binary, data: bytes, version: tuple[int, ...], machine: str) -> list[str]:
    """What is wrong with a library of macOS; prints the oldest system that it is for."""
    wrong = []
    own = [entry.name for entry in library.libraries if entry.command == lief.MachO.LoadCommand.TYPE.ID_DYLIB]
    if own != ["@rpath/libewa.dylib"]:
        wrong.append(f"it calls itself {', '.join(own)}")
    if library.header.cpu_type.name != {"x86_64": "X86_64", "arm64": "ARM64"}[machine]:
        wrong.append(f"it is for {library.header.cpu_type.name}")
    oldest = tuple(library.build_version.minos[:2]) if library.has_build_version else tuple(library.version_min.version[:2])
    print(f"  for macOS {'.'.join(map(str, oldest))}")
    if oldest > version:
        wrong.append(f"it is for macOS {oldest}")
    if machine == "arm64" and not (library.has_code_signature and is_signed(data, library.code_signature.data_offset)):
        wrong.append("it is not signed as it is, which Apple's processors ask for")
    return wrong


def check(path: str) -> list[str]:
    """What is wrong with a wheel."""
    name = PurePosixPath(path).name
    tag = re.fullmatch(r"libewa-[^-]+-py3-none-(manylinux|musllinux|macosx|win)_?(?:([0-9]+)_([0-9]+)_)?(x86_64|aarch64|arm64|amd64)\.whl", name)
    if not tag:
        return [f"{name} is none of its names"]
    system, machine = tag[1], tag[4]
    version = (int(tag[2] or 0), int(tag[3] or 0))
    with zipfile.ZipFile(path) as wheel:
        files = wheel.namelist()
        libraries = [file for file in files if re.search(r"\.(so|dylib|dll|pyd)(\.|$)", file)]
        if len(libraries) != 1:
            return [f"it has {len(libraries)} libraries: {', '.join(libraries)}"]
        data = wheel.read(libraries[0])
        described = wheel.read(next(file for file in files if file.endswith(".dist-info/WHEEL"))).decode()
    size = sum(info.compress_size for info in zipfile.ZipFile(path).infolist())
    print(f"{name}: {size:,} bytes, {libraries[0]} of {len(data):,}")
    wrong = []
    if f"Tag: py3-none-{name.split('-py3-none-')[1][:-4]}\n" not in described:
        wrong.append("its file WHEEL has another tag than its name")
    if size >= MOST_BYTES:
        wrong.append("it has 5 MB or more")
    licences = {PurePosixPath(file).stem for file in files if ".dist-info/licenses/" in file}
    wrong += [f"it lacks the licence of {wanted}" for wanted in LICENCES if not any(have.startswith(wanted) for have in licences)]
    library = lief.parse(list(data))
    if isinstance(library, lief.MachO.FatBinary):
        library = library.at(0)
    if isinstance(library, lief.ELF.Binary) and system in ("manylinux", "musllinux"):
        wrong += check_elf(library, system, version, machine)
        shown = [symbol.name for symbol in library.exported_symbols]
    elif isinstance(library, lief.MachO.Binary) and system == "macosx":
        wrong += check_macho(library, data, version, machine)
        shown = [symbol.name[1:] for symbol in library.exported_symbols if symbol.name[1:] not in LINKERS]
    elif isinstance(library, lief.PE.Binary) and system == "win":
        if library.header.machine.name != "AMD64":
            wrong.append(f"it is for {library.header.machine.name}")
        shown = [entry.name for entry in library.get_export().entries]
    else:
        return [f"{libraries[0]} is {type(library).__module__}"]
    needed = library.libraries if system != "win" else [entry.name for entry in library.imports]
    if system == "macosx":
        needed = [entry for entry in needed if entry.command != lief.MachO.LoadCommand.TYPE.ID_DYLIB]
    needed = [entry if isinstance(entry, str) else entry.name for entry in needed]
    print(f"  needs {', '.join(sorted(needed))}; shows {len(shown)} names")
    wrong += [f"it needs {entry}" for entry in needed if not re.fullmatch(LIBRARIES[system], entry)]
    others = sorted(entry for entry in shown if not entry.startswith("ewa_"))
    if others:
        wrong.append(f"it shows {len(others)} names of others, such as {others[0]}, {others[-1]}")
    if "ewa_version" not in shown:
        wrong.append("it does not show ewa_version")
    return wrong


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    faults = check(sys.argv[1])
    for fault in faults:
        print(f"check_wheel.py: {fault}", file=sys.stderr)
    sys.exit(1 if faults else 0)
