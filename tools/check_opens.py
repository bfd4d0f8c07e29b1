#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Whether files are opened in one way: what a file or a folder names by src/io/referenced_file.c, what a caller names by
src/io/file.c.

    check_opens.py [ROOT]

Read are the sources of src/. Fails, and lists, for

- calls of the system that open something, outside of the files of SYSTEM;
- calls of ewa_file_map() and ewa_file_open_pieces(), which open whatever they are told to, outside of the files of CALLER, which
  take their path from a caller of the library and have not put it together.

Who needs a file that another file or a folder names calls ewa_referenced_file_map(), _part() or _find().
"""
import re
import sys
from pathlib import Path

#: Files that may call the system.
SYSTEM = {"src/io/file.c", "src/io/nameless.c", "src/io/referenced_file.c", "src/io/spool.c"}
#: Files whose paths are those that a caller gave, or of temporary files that the library has made.
CALLER = {"src/io/camera/file.c", "src/io/cloud/cloud_file.c", "src/io/cloud/stream.c", "src/io/file.c",
          "src/io/gaussian/gaussian_file.c", "src/io/image/image_file.c", "src/io/las/copc_nodes.c", "src/io/mesh/materials.c",
          "src/io/mesh/model_file.c", "src/io/polygon_text.c", "src/io/volume/file.c", "src/io/volume/transfer_file.c",
          "src/lod/part.c", "src/scene/file.c"}

OPENS = re.compile(r"(?<![\w.>])(open|openat|openat2|creat|fopen|freopen|fdopen|opendir|fdopendir|scandir|mkstemp|tmpfile|"
                   r"popen|shm_open|execv\w*|posix_spawn\w*|fork|system)\s*\(")
MAPS = re.compile(r"(?<!\w)(ewa_file_map|ewa_file_open_pieces)\s*\(")
NO_CODE = re.compile(r"//[^\n]*|/\*.*?\*/|\"(?:\\.|[^\"\\\n])*\"", re.S)


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent).resolve()
    found, seen = [], set()
    for path in sorted([*(root / "src").rglob("*.[ch]"), *(root / "src").rglob("*.cpp")]):
        shown = path.relative_to(root).as_posix()
        text = NO_CODE.sub(lambda match: "\n" * match.group().count("\n"), path.read_text())
        for number, line in enumerate(text.splitlines(), 1):
            for pattern, allowed, way in ((OPENS, SYSTEM, "opens a file by itself"),
                                          (MAPS, CALLER, "maps a path that is no caller's")):
                for match in pattern.finditer(line):
                    seen.add(shown)
                    if shown not in allowed | {"src/io/file.h"}:  # which declares them
                        found.append(f"{shown}:{number}: {match.group(1)}() {way}: see tools/check_opens.py")
    if len(sys.argv) < 2 or (root / "CMakeLists.txt").exists():
        found += [f"{shown}: is listed in tools/check_opens.py and opens nothing" for shown in sorted((SYSTEM | CALLER) - seen)]
    print("\n".join(found))
    print(f"{len(found)} lines")
    sys.exit(1 if found else 0)


main()
