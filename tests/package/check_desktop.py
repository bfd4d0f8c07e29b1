#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""What a desktop is told of the window: the entry of its menu is valid, it names the types of files that ewa.xml adds and others
that the desktop knows, and a file by each pattern is of the type that is said.

    check_desktop.py SOURCE SCRATCH

Skipped (77) without desktop-file-validate or update-mime-database.
"""
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as tree
from pathlib import Path

KNOWN = {"model/gltf+json", "model/gltf-binary", "model/obj", "model/stl"}  # of shared-mime-info
SPACE = "{http://www.freedesktop.org/standards/shared-mime-info}"


def main():
    folder, scratch = Path(sys.argv[1]) / "viewer/desktop", Path(sys.argv[2])
    for tool in ("desktop-file-validate", "update-mime-database"):
        if not shutil.which(tool):
            print(f"skipped: {tool} is not installed")
            return 77
    found = subprocess.run(["desktop-file-validate", folder / "ewa.desktop"], capture_output=True, text=True, check=False).stdout.splitlines()
    types = tree.parse(folder / "ewa.xml").getroot().findall(f"{SPACE}mime-type")
    wanted = {(kind.get("type"), glob.get("pattern")) for kind in types for glob in kind.findall(f"{SPACE}glob")}
    entry = (folder / "ewa.desktop").read_text()
    named = set(re.search(r"(?m)^MimeType=(.*);$", entry).group(1).split(";"))
    if named != KNOWN | {kind for kind, _ in wanted}:
        found.append(f"ewa.desktop names other types than ewa.xml: {sorted(named ^ (KNOWN | {kind for kind, _ in wanted}))}")
    shutil.rmtree(scratch, ignore_errors=True)
    (scratch / "packages").mkdir(parents=True)
    shutil.copy(folder / "ewa.xml", scratch / "packages")
    subprocess.run(["update-mime-database", scratch], capture_output=True, check=True)
    made = {tuple(line.split(":")[1:3]) for line in (scratch / "globs2").read_text().splitlines() if line[0] != "#"}
    if made != wanted:
        found.append(f"of the types became others: {sorted(made ^ wanted)}")
    picture = tree.parse(folder / "ewa.svg").getroot()
    if not picture.tag.endswith("}svg") or picture.get("viewBox") != "0 0 128 128":
        found.append("ewa.svg is no picture of 128 x 128")
    print("\n".join(found) if found else f"{len(wanted)} patterns")
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())
