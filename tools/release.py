#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Makes a release of what is committed (docs/versions.md).

    release.py VERSION [--date YYYY-MM-DD]   writes the version where it is told, gives what CHANGELOG.md has as unreleased its
                                             heading, commits, and tags vVERSION with these notes
    release.py --notes [VERSION]             prints the notes of a version; without one, of what is unreleased
    release.py --check                       fails where two files tell different versions

Nothing is pushed: the last line says how. A release is refused where something is not committed, where the version is not a
later one, and where nothing is noted.
"""
import argparse
import datetime
import re
import subprocess
import sys
from email.utils import format_datetime
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

# Where the version is told, each as a pattern around it. What is made from include/ewa/base.h follows by `dump_*.py`.
PLACES = {
    "CMakeLists.txt": r"(project\(ewa VERSION )(\d+\.\d+\.\d+)()",
    "pyproject.toml": r'(\nversion = ")(\d+\.\d+\.\d+)(")',
    "page/package.json": r'("version": ")(\d+\.\d+\.\d+)(")',
    "debian/changelog": r"(\Aewa \()(\d+\.\d+\.\d+)(\))",
    "packaging/conda/recipe.yaml": r'(\n  version: ")(\d+\.\d+\.\d+)(")',
    "packaging/homebrew/ewa.rb": r"(/ewa-)(\d+\.\d+\.\d+)(\.tar\.gz)",
    "packaging/nix/default.nix": r'(\n  version = ")(\d+\.\d+\.\d+)(";)',
    "packaging/vcpkg/ewa/vcpkg.json": r'(\n  "version": ")(\d+\.\d+\.\d+)(")',
}
HEADER = "include/ewa/base.h"


def read(name):
    return (ROOT / name).read_text(encoding="utf-8")


def write(name, text):
    (ROOT / name).write_text(text, encoding="utf-8")


def git(*words, text=None):
    return subprocess.run(["git", "-C", ROOT, *words], input=text, capture_output=True, text=True, check=True).stdout


def told_versions():
    """The version that each file tells."""
    told = {name: re.search(pattern, read(name)).group(2) for name, pattern in PLACES.items()}
    told[HEADER] = ".".join(re.findall(r"#define EWA_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)", read(HEADER)))
    return told


def check():
    told = told_versions()
    if len(set(told.values())) > 1:
        for name, version in told.items():
            print(f"{name}: {version}")
    return len(set(told.values())) > 1


def notes_of(version):
    """What CHANGELOG.md says of a version, without its heading; None where it has none."""
    found = re.search(rf"(?ms)^## \[{re.escape(version)}\][^\n]*\n(.*?)(?=^## \[|\Z)", read("CHANGELOG.md"))
    return found.group(1).strip() if found else None


def set_version(version, day):
    for name, pattern in PLACES.items():
        if name != "debian/changelog":
            write(name, re.sub(pattern, rf"\g<1>{version}\g<3>", read(name)))
    header = read(HEADER)
    for part, number in zip(("MAJOR", "MINOR", "PATCH"), version.split(".")):
        header = re.sub(rf"(#define EWA_VERSION_{part}) \d+", rf"\1 {number}", header)
    write(HEADER, header)
    write("CHANGELOG.md", read("CHANGELOG.md").replace("## [Unreleased]\n", f"## [Unreleased]\n\n## [{version}] - {day}\n", 1))
    packages = read("debian/changelog")
    maintainer = re.search(r"(?m)^ -- (.* <.*>)", packages).group(1)
    packages = re.sub(r"(?s)\Aewa \([^)]*\) UNRELEASED;.*?\n -- [^\n]*\n\n?", "", packages)
    noon = format_datetime(datetime.datetime.combine(day, datetime.time(12), datetime.timezone.utc))
    write("debian/changelog", f"ewa ({version}) unstable; urgency=medium\n\n  * What changed: CHANGELOG.md.\n\n -- {maintainer}  {noon}\n\n"
          + packages)
    for tool in ("dump_api.py", "dump_python.py"):
        subprocess.run([sys.executable, ROOT / "tools" / tool], check=True, stdout=subprocess.DEVNULL)


def release(version, day):
    if git("status", "--porcelain"):
        sys.exit("release: something is not committed")
    if check():
        sys.exit("release: the files above tell different versions")
    before = told_versions()[HEADER]
    if not re.fullmatch(r"\d+\.\d+\.\d+", version):
        sys.exit(f"release: {version} is no MAJOR.MINOR.PATCH")
    first = not git("tag", "--list", "v*").strip()
    numbers, last = (tuple(int(part) for part in text.split(".")) for text in (version, before))
    if numbers < last or (numbers == last and not first):
        sys.exit(f"release: {version} is not later than {before}")
    notes = notes_of("Unreleased")
    if not notes:
        sys.exit("release: CHANGELOG.md has nothing unreleased")
    set_version(version, day)
    git("commit", "--quiet", "--all", "--message", f"Release {version}")
    git("tag", "--annotate", "--cleanup=verbatim", f"v{version}", "--file=-", text=f"ewa {version}\n\n{notes}\n")
    print(f"v{version} is made; to publish it: git push origin HEAD v{version}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("version", nargs="?")
    parser.add_argument("--date", type=datetime.date.fromisoformat, default=datetime.datetime.now(datetime.timezone.utc).date())
    parser.add_argument("--notes", action="store_true")
    parser.add_argument("--check", action="store_true")
    asked = parser.parse_args()
    if asked.check:
        return check()
    if asked.notes:
        notes = notes_of(asked.version or "Unreleased")
        print(notes if notes is not None else "")
        return notes is None
    if not asked.version:
        parser.error("which version?")
    return release(asked.version, asked.date)


if __name__ == "__main__":
    sys.exit(main())
