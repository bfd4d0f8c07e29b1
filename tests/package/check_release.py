#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Releases by tools/release.py, in a repository of its own: what they write, and what they refuse.

    check_release.py SOURCE SCRATCH

Skipped (77) without git.
"""
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

FILES = [".gitignore", "CMakeLists.txt", "pyproject.toml", "page/package.json", "debian/changelog", "CHANGELOG.md", "docs/api.json",
         "docs/options.json", "packaging/conda/recipe.yaml", "packaging/homebrew/ewa.rb", "packaging/nix/default.nix",
         "packaging/vcpkg/ewa/vcpkg.json"]


def main():
    source, scratch = Path(sys.argv[1]), Path(sys.argv[2])
    if not shutil.which("git"):
        print("skipped: git is not installed")
        return 77
    shutil.rmtree(scratch, ignore_errors=True)
    for name in FILES + [str(path.relative_to(source)) for folder, pattern in (("include/ewa", "*.h"), ("python", "**/*.py*"), ("tools", "*.py"))
                         for path in (source / folder).glob(pattern) if "__pycache__" not in path.parts]:
        (scratch / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(source / name, scratch / name)
    environment = {**os.environ, "GIT_CONFIG_GLOBAL": "/dev/null", "GIT_CONFIG_SYSTEM": "/dev/null"}
    for role in ("AUTHOR", "COMMITTER"):
        environment.update({f"GIT_{role}_NAME": "Somebody", f"GIT_{role}_EMAIL": "somebody@localhost"})
    found = []

    def run(*words, status=0, says=""):
        done = subprocess.run(words, cwd=scratch, env=environment, capture_output=True, text=True, check=False)
        if done.returncode != status or says not in done.stdout + done.stderr:
            found.append(f"{' '.join(map(str, words))}: {done.returncode}, wanted {status} and '{says}'\n{done.stdout}{done.stderr}")
        return done.stdout

    def release(*words, status=0, says=""):
        return run(sys.executable, "tools/release.py", *words, status=status, says=says)

    changes = scratch / "CHANGELOG.md"
    changes.write_text("# Changelog\n\n## [Unreleased]\n\n### Added\n\n- Wings.\n", encoding="utf-8")
    major, minor, patch = map(int, re.search(r"ewa VERSION (\d+)\.(\d+)\.(\d+)", (scratch / "CMakeLists.txt").read_text()).groups())
    before, after = f"{major}.{minor}.{patch}", f"{major}.{minor + 1}.0"
    run("git", "init", "--quiet", ".")
    run("git", "add", "--all")
    run("git", "commit", "--quiet", "--message", "Begin")
    release("--check")
    if release("--notes") != "### Added\n\n- Wings.\n":
        found.append("--notes prints something else than what is unreleased")
    release("0.0.9", status=1, says=f"0.0.9 is not later than {before}")
    release("1.0", status=1, says="1.0 is no MAJOR.MINOR.PATCH")
    release(after, "--date", "2027-01-02", says=f"git push origin HEAD v{after}")
    release("--check")
    for name, text in (("CMakeLists.txt", f"project(ewa VERSION {after} "), ("pyproject.toml", f'version = "{after}"'),
                       ("page/package.json", f'"version": "{after}"'), ("include/ewa/base.h", f"EWA_VERSION_MINOR {minor + 1}\n"),
                       ("docs/api.json", f'"EWA_VERSION_MINOR": "{minor + 1}"'), ("python/ewa/_bindings.py", f"EWA_VERSION_MINOR = {minor + 1}\n"),
                       ("debian/changelog", f"ewa ({after}) unstable;"),
                       ("CHANGELOG.md", f"## [Unreleased]\n\n## [{after}] - 2027-01-02\n\n### Added\n\n- Wings.\n")):
        if text not in (scratch / name).read_text(encoding="utf-8"):
            found.append(f"{name} has no {text!r}")
    if run("git", "tag", "--list", "--format=%(contents)") != f"ewa {after}\n\n### Added\n\n- Wings.\n\n":
        found.append("the tag has other notes")
    run("git", "diff", "--quiet", f"v{after}")
    release(f"{major + 1}.0.0", status=1, says="nothing unreleased")
    changes.write_text(changes.read_text(encoding="utf-8").replace("## [Unreleased]\n", "## [Unreleased]\n\n- Feet.\n"), encoding="utf-8")
    release(f"{major + 1}.0.0", status=1, says="something is not committed")
    run("git", "commit", "--quiet", "--all", "--message", "Note feet")
    release(after, status=1, says=f"{after} is not later than {after}")
    text = (scratch / "pyproject.toml").read_text(encoding="utf-8")
    (scratch / "pyproject.toml").write_text(text.replace(f'"{after}"', '"99.0.0"'), encoding="utf-8")
    release("--check", status=1, says="pyproject.toml: 99.0.0")
    print("\n".join(found) if found else "as it should")
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())
