#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Manual pages: mandoc finds nothing wrong with them, and they show every option that docs/cli.md has.

    check_manual.py EWA SOURCE

Skipped (77) without mandoc.
"""
import re
import shutil
import subprocess
import sys
from pathlib import Path


def output_of(*words, text=None):
    return subprocess.run(words, input=text, capture_output=True, text=True, check=False).stdout


def check_page(name, page, options):
    """What is wrong with one page."""
    found = [line for line in output_of("mandoc", "-T", "lint", "-W", "warning", text=page).splitlines()
             if "missing date" not in line]  # the program has none
    shown = re.sub(".\b", "", output_of("mandoc", "-T", "ascii", text=page))
    found += [f"does not show {option}" for option in options if not re.search(rf"(?m)^ .*{re.escape(option)}(?![\w-])", shown)]
    if not re.search(rf"NAME\n +{re.escape(name)} +- ", shown):
        found.append("has no name")
    return [f"{name}(1): {line}" for line in found]


def main():
    if not shutil.which("mandoc"):
        print("skipped: mandoc is not installed")
        return 77
    ewa, source = sys.argv[1], Path(sys.argv[2])
    found, commands = [], []
    for part in re.split(r"(?m)^## ewa ", (source / "docs/cli.md").read_text())[1:]:
        commands.append(part.split()[0])
        rows = re.findall(r"(?m)^\| `([^`]*--[^`]*)` \|", part)
        options = [option for row in rows for option in re.findall(r"--[a-z][\w-]*", row)]
        found += check_page(f"ewa-{commands[-1]}", output_of(ewa, "--help-man", commands[-1]), options)
    found += check_page("ewa", output_of(ewa, "--help-man"), [f"ewa-{command}" for command in commands] + ["--help-man"])
    page = (source / "mpi/ewa-mpi.1.in").read_text()
    usage = (source / "mpi/main.c").read_text().split("usage[]")[1].split(";")[0]
    found += check_page("ewa-mpi", page, sorted(set(re.findall(r"--[a-z][\w-]*", usage))))
    print("\n".join(found) if found else f"{len(commands) + 2} pages")
    return bool(found) or len(commands) < 10


if __name__ == "__main__":
    sys.exit(main())
