#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Whether comments still have the form that they were given: what a formatter that knows no lists does to them.

    check_comments.py [ROOT]

Read are the comments of include/, src/, cli/, bench/ and viewer/. Fails, and lists, for

- lists ("- ..."): lines of an item that are not indented under it, up to an empty line or the next item;
- tables ("| ... |"): rows that do not begin and end with a bar, or have more or fewer columns than the row above;
- rules ("----") on a line of their own, torn off the heading that they belong to;
- a lone word that the next line goes on from, torn off its line.

.clang-format says "ReflowComments: false" so that this does not come back.
"""
import re
import sys
from pathlib import Path

COMMENT = re.compile(r"^\s*(///?)(?![/<]) ?(.*)$")


def check(path, shown, found):
    mark, item, columns, before = None, None, None, ""
    lines = path.read_text().splitlines()
    for number, line in enumerate(lines, 1):
        match = COMMENT.match(line)
        if not match or match.group(1) != mark or not match.group(2).strip():
            item = columns = None
            before = ""
        mark = match.group(1) if match else None
        if not match or not match.group(2).strip():
            continue
        text = match.group(2)
        start = re.match(r" *- ", text)
        if start:
            item = start.end()
        elif item is not None and not re.match(rf" {{{item}}}\S", text):
            found.append(f"{shown}:{number}: not indented as its item of a list")
        bars = text.count("|")
        if columns or (bars > 2 and re.match(r"\|[ -]", text)):
            if not (text.startswith("|") and text.rstrip().endswith("|")) or (columns or bars) != bars:
                found.append(f"{shown}:{number}: no row of its table")
            columns = columns or bars
        else:
            columns = None
        if re.fullmatch(r"-{8,}", text.strip()):
            found.append(f"{shown}:{number}: a rule without its heading")
        after = COMMENT.match(lines[number]) if number < len(lines) else None
        torn = re.fullmatch(r"[\w()'-]+,?", text.strip()) and len(before) > 80
        if torn and after and after.group(1) == mark and re.match(r"\w", after.group(2)):
            found.append(f"{shown}:{number}: a lone word")
        before = line


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent).resolve()
    files = sorted(path for room in ("include", "src", "cli", "bench", "viewer") for end in ("*.[ch]", "*.cpp") for path in (root / room).rglob(end))
    found = []
    for path in files:
        check(path, str(path.relative_to(root)), found)
    print("\n".join(found), end="\n" if found else "")
    if found or not files:
        sys.exit(f"{len(found)} places in {len(files)} files")
    print(f"{len(files)} files")


main()
