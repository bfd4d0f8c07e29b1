#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Whether figures that were measured say where they are from.

    check_figures.py [ROOT]

Read are README.md and docs/*.md but for docs/math.md, whose numbers are definitions, and docs/cli.md, whose numbers are options (docs/papers has
a test of its own, `papers`). A figure is a number with a unit of time, memory, rate, decibels, share or ratio in prose or a table, and a table
whose head names such a unit. Its section has to have

- a command that makes figures (programs of build/, measure/, bench/ and tools/, `make ...`, `--timings`), or
- a test that holds it (test `name`), or
- a date; then the page says on what machine.

What stands before the first part (###) of a section counts for its parts, and a paragraph "Figures on this page ..." before the first section for the whole
page. Numbers that nobody measured (limits, settings, definitions) are listed in tests/house/figures.txt; a line there that no page has any more fails, too.
"""
import re
import sys
from pathlib import Path

FIGURE = re.compile(
    r"(?<![\w.,/^-])\d(?:[\d.,]*\d)?(?: (?:k|M|G))? ?(?:(?:to|and|of|/) \d(?:[\d.,]*\d)? ?)?"
    r"(?:(?:ns|µs|us|ms|s|min|h|kB|KB|MB|GB|KiB|MiB|GiB|dB|fps|%)(?![\w/]*[A-Za-z(])|(?:frames|pictures|points|surfels|rays)(?: a second|/s)|[MGk]/s|[MG]pix/s|x(?! ?[\w/+])|times (?:as|faster|slower|less|more))")
HEAD = re.compile(r"(?m)^\|.*\b(?:ms|s|dB|MB|MiB|GB)\b.*\|$(?=\n\|[ :|-]+\|$)")
COMMAND = re.compile(r"\b(?:measure|test)_\w+|build/\w+/(?:measure|bench|tests|cli)/\w+|(?:measure|tools|bench|examples|tests)/[\w/]+\.(?:py|sh|mjs|txt)|`make \w+|^make \w+|--timings|`?ewa bench", re.M)
TEST = re.compile(r"\b[Tt]ests? (?:\([^)]*\) )?`[\w-]+`")
DATE = re.compile(r"\b\d{1,2} (?:January|February|March|April|May|June|July|August|September|October|November|December) 20\d\d\b|\b20\d\d-\d\d-\d\d\b")
MACHINE = re.compile(r"Xeon|EPYC|H100|H200|[Pp]rocessors?\b|\bcores?\b|[Mm]achine|qemu|wine|llvmpipe")
DEFINITIONS = {"docs/math.md", "docs/cli.md"}


def blank(match):
    return re.sub(r"[^\n]", " ", match.group())


def sections(text):
    """(first line, text without code, whole text and what stands before its first part) of each section and of each of its parts (###)."""
    prose = re.sub(r"(?ms)^```.*?^```", blank, text)
    starts = [0] + [m.start() for m in re.finditer(r"(?m)^##+ ", prose)] + [len(text)]
    prose = re.sub(r"`[^`\n]*`|\]\([^)]*\)", blank, re.sub(r"(?m)^    .*", blank, prose))
    above = ""
    for begin, end in zip(starts, starts[1:]):
        whole = text[begin:end]
        above = above if whole.startswith("###") else whole
        yield text.count("\n", 0, begin) + 1, prose[begin:end], whole + above


def figures_of(flat, prose):
    """The places of figures: numbers with units, and tables whose heads name a unit."""
    return [m.span() for m in FIGURE.finditer(flat)] + [m.span() for m in HEAD.finditer(prose)]


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent).resolve()
    listed = {}
    exceptions = root / "tests/house/figures.txt"
    for line in exceptions.read_text().splitlines() if exceptions.exists() else ():
        if line and not line.startswith("#"):
            page, words = line.split("\t")
            listed.setdefault(page, {})[words] = False
    found, counted = [], 0
    for path in [root / "README.md", *sorted((root / "docs").glob("*.md"))]:
        page = str(path.relative_to(root))
        if page in DEFINITIONS or not path.exists():
            continue
        text = path.read_text()
        head = re.search(r"(?ms)^Figures on this page.*?(?=^$)", next(iter(sections(text)))[2])
        for first, prose, whole in sections(text):
            flat = re.sub(r"\s", " ", prose)
            for words in listed.get(page, ()):
                for match in list(re.finditer(" +".join(map(re.escape, words.split(" "))), flat)):
                    listed[page][words] = True
                    flat = flat[:match.start()] + blank(match) + flat[match.end():]
            figures = figures_of(flat, prose)
            counted += len(figures)
            for both in (whole, head.group() if head else ""):
                if COMMAND.search(both) or TEST.search(both) or DATE.search(both) and MACHINE.search(text):
                    break
            else:
                found += [f"{page}:{first + prose.count(chr(10), 0, a)}: {flat[max(0, a - 40):b + 15].strip()}" for a, b in figures]
    for page, words in ((page, words) for page, all in listed.items() for words, seen in all.items() if not seen):
        found.append(f"tests/house/figures.txt: {page} does not say \"{words}\"")
    print("\n".join(found))
    if found:
        sys.exit(f"{len(found)} figures that do not say where they are from")
    print(f"{counted} figures")


main()
