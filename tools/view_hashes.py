#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Fills in the hashes that the viewer's scripts expect: view_hashes.py EWA FOLDER [PICTURES]

FOLDER holds the files that the scripts name (the test `view_scripts` makes them, in build/release/view). Only lines
"expect-hash ?" are filled in, so that no picture changes unseen: put a question mark where one is to. With PICTURES,
a folder, nothing is changed: every picture that a script expects is saved there, to be looked at.
"""
import pathlib
import re
import subprocess
import sys


def run(program, script, folder):
    command = [program, "view", "--size", "320x240", "--levels", "always", "--script", str(script)]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True).stderr


def fill(program, script, folder):
    for _ in range(script.read_text().count("expect-hash ?")):
        found = re.search(r":(\d+): the picture's hash is: ([0-9a-f]{16})", run(program, script, folder))
        lines = script.read_text().splitlines()
        if not found or lines[int(found.group(1)) - 1] != "expect-hash ?":
            return
        lines[int(found.group(1)) - 1] = "expect-hash " + found.group(2)
        script.write_text("\n".join(lines) + "\n")


def save_pictures(program, script, folder, pictures):
    lines = script.read_text().splitlines()
    for number, line in enumerate(lines):
        if line.startswith("expect-hash"):
            lines[number] = f"shot {pictures}/{script.stem}_{number + 1:02}.png"
    copy = pictures / script.name
    copy.write_text("\n".join(lines) + "\n")
    run(program, copy, folder)
    copy.unlink()


def main():
    program, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    for script in sorted((pathlib.Path(__file__).parent.parent / "tests/viewer/scripts").glob("*.txt")):
        if len(sys.argv) > 3:
            save_pictures(program, script, folder, pathlib.Path(sys.argv[3]).resolve())
        else:
            fill(program, script, folder)
        message = run(program, script, folder).strip() if len(sys.argv) <= 3 else ""
        if message:
            print(f"{script.name}: {message}")


main()
