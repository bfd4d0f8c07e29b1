#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Whether the operating system is called in one place, src/base/platform_*.c, and files are opened in one way: what a file or a
folder names by src/io/referenced_file.c, what a caller names by src/io/file.c.

    check_opens.py [ROOT]

Read are the sources of src/. Fails, and lists, for

- headers of the system, and calls of the C library that open, rename or remove something, outside of the files of SYSTEM;
- calls of ewa_file_map() and ewa_file_open_pieces(), which open whatever they are told to, outside of the files of CALLER, which
  take their path from a caller of the library and have not put it together.

Who needs a file that another file or a folder names calls ewa_referenced_file_map(), _part() or _find().
"""
import re
import sys
from pathlib import Path

#: Files that may call the system.
SYSTEM = {"src/base/platform_posix.c", "src/base/platform_unix.c", "src/base/platform_wasm.c", "src/base/platform_windows.c",
          "src/base/pool.c"}
#: Files whose paths are those that a caller gave, or of temporary files that the library has made.
CALLER = {"src/io/camera/file.c", "src/io/cloud/cloud_file.c", "src/io/cloud/stream.c", "src/io/file.c",
          "src/io/gaussian/gaussian_file.c", "src/io/gaussian/levels_file.c", "src/io/image/image_file.c", "src/io/las/copc_nodes.c",
          "src/io/mesh/materials.c",
          "src/io/mesh/model_file.c", "src/io/polygon_text.c", "src/io/volume/file.c", "src/io/volume/transfer_file.c",
          "src/lod/part.c", "src/scene/file.c"}

HEADERS = re.compile(r"^\s*#\s*include\s*<((?:sys/\w+|unistd|fcntl|dirent|dlfcn|pthread|threads|sched|semaphore|signal|poll|spawn|"
                     r"time|malloc|glob|ftw|langinfo|locale|windows|winsock2|io|direct|process|emscripten)\.h)>")
OPENS = re.compile(r"(?<![\w.>])(open|openat|openat2|creat|fopen|freopen|fdopen|opendir|fdopendir|scandir|mkstemp|tmpfile|tmpnam|"
                   r"popen|shm_open|execv\w*|posix_spawn\w*|fork|system|rename|remove|unlink|strerror_r|strerror)\s*\(")
MAPS = re.compile(r"(?<!\w)(ewa_file_map|ewa_file_open_pieces)\s*\(")
NO_CODE = re.compile(r"//[^\n]*|/\*.*?\*/|\"(?:\\.|[^\"\\\n])*\"", re.S)


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent).resolve()
    found, seen = [], set()
    for path in sorted([*(root / "src").rglob("*.[ch]"), *(root / "src").rglob("*.cpp")]):
        shown = path.relative_to(root).as_posix()
        text = NO_CODE.sub(lambda match: "\n" * match.group().count("\n"), path.read_text())
        for number, line in enumerate(text.splitlines(), 1):
            for pattern, allowed, way in ((HEADERS, SYSTEM, "is a header of the system"), (OPENS, SYSTEM, "calls the system by itself"),
                                          (MAPS, CALLER, "maps a path that is no caller's")):
                for match in pattern.finditer(line):
                    seen.add(shown)
                    if shown not in allowed | {"src/io/file.h"}:  # which declares them
                        found.append(f"{shown}:{number}: {match.group(1)} {way}: see tools/check_opens.py")
    if len(sys.argv) < 2 or (root / "CMakeLists.txt").exists():
        found += [f"{shown}: is listed in tools/check_opens.py and opens nothing" for shown in sorted((SYSTEM | CALLER) - seen)]
    print("\n".join(found))
    print(f"{len(found)} lines")
    sys.exit(1 if found else 0)


main()
