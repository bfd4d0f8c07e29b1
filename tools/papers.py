#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Makes the pictures, graphs and tables of docs/papers anew by the commands that its pages show, and compares its list
with them.

    papers.py check [FOLDER]              compares items.tsv, the pages and the files they show; needs no program
    papers.py make EWA [PAPER [ITEM]]     runs the commands: pictures, tables and hashes go to docs/papers
    papers.py quick EWA [PAPER [ITEM]]    runs all commands with few points and frames, and compares the hashes

Every row of items.tsv is a section of a page: what the paper says, the commands, what they made, and how it compares. A
block of commands is run in a folder of its item's own; it may call `ewa`, `measure_NAME` (build/release/measure) and `figure NAME`
(tools/papers/NAME.py). What it writes as NAME.png, .svg or .mp4 and the page shows goes beside the page; NAME.table goes
between the page's `<!-- table NAME -->` and `<!-- end -->`. Blocks that name $EWA_DATA are left out when it is not set, those that call a program that is
not there (ffmpeg, glslangValidator) as well.

PNG files are drawn by the program and are the same pixels everywhere: hashes.tsv has the SHA-256 of each picture's
pixels, in full and in quick sizes. Graphs (.svg) and films (.mp4) are other programs' and have none.
"""
import csv
import hashlib
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import zlib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGES = {"pas": "perspective_accurate_splatting.md", "ss": "surface_splatting.md",
         "hfr": "hybrid_forward_resampling.md", "hc": "homogeneous_coordinates.md"}
SKIPPED = 77  # what ctest takes for a test that could not run

#: What the quick run has of an option that says how much there is to do.
QUICK = ((re.compile(r"(-n |--points )(\d+)"), 3000), (re.compile(r"(--turntable |--frames |--splats )(\d+)"), 2),
         (re.compile(r"(--dims )(\d+)"), 24), (re.compile(r"(--workers )(\d+)"), 1), (re.compile(r"(gpu_table )(\d+)"), 3000))

#: What a block needs that has one of these words: a program, or the variable that names a folder.
NEEDS = {"$EWA_DATA": "EWA_DATA", ".mp4": "ffmpeg", "gpu_instructions": "glslangValidator"}

SHELL = """set -eu
ewa() { "$EWA_PROGRAM" "$@"; }
figure() { name=$1; shift; "$EWA_PYTHON" "$EWA_TOOLS/papers/$name.py" "$@"; }
gpu_table() { sh "$EWA_TOOLS/gpu_table.sh" "$EWA_PROGRAM" "$@"; }
gpu_instructions() { sh "$EWA_TOOLS/gpu_instructions.sh"; }
for path in "$EWA_MEASURE"/measure_*; do
    case ${path##*/} in (*[!a-z_]*) continue ;; esac
    eval "${path##*/}() { \\"$path\\" \\"\\$@\\"; }"
done
"""


class Section:
    """A row of the list and what its page has of it."""

    def __init__(self, paper, item, what, text):
        self.paper, self.item, self.what, self.text = paper, item, what, text
        self.blocks = re.findall(r"^```sh\n(.*?)^```$", text, re.M | re.S)
        self.links = re.findall(r"\]\(([^)\s]+)\)", text)
        self.pictures = [name for name in re.findall(r"!\[[^\]]*\]\(([^)\s]+)\)", text) if "/" not in name]
        self.films = [name for name in self.links if name.endswith(".mp4") and "/" not in name]
        #: Names of files in the commands, `$name` in them standing for anything.
        self.named = [re.sub(r"\\\$\\?\{?\w+\\?\}?", r"\\w+", re.escape(word)) for block in self.blocks
                      for word in re.findall(r"[\w.${}-]+\.(?:png|svg|mp4|table)", block)]
        self.tables = re.findall(r"^<!-- table (\w+) -->$", text, re.M)

    def makes(self, name):
        """Whether a command names that file."""
        return any(re.fullmatch(pattern, name) for pattern in self.named)


def read_sections(folder):
    """The sections of all pages in the order of the list, with an empty text where a page has none."""
    with open(folder / "items.tsv", newline="") as file:
        rows = list(csv.DictReader(file, delimiter="\t"))
    pages = {paper: (folder / name).read_text() if (folder / name).exists() else "" for paper, name in PAGES.items()}
    found = {paper: dict(re.findall(r'^<a id="([\w-]+)"></a>\n(.*?)(?=^<a id=|\Z)', text, re.M | re.S))
             for paper, text in pages.items()}
    sections = [Section(row["paper"], row["item"], row["what"], found[row["paper"]].pop(row["item"], ""))
                for row in rows]
    return sections, [(paper, item) for paper, left in found.items() for item in left]


def problems_of(section, folder):
    text = section.text
    if not text:
        return ["the page has no section of it"]
    wrong = []
    if not re.search(r"^\*\*The paper", text, re.M):
        wrong.append("does not say what the paper says (**The paper**: ...)")
    if not section.blocks:
        wrong.append("has no command")
    if not section.pictures and not section.tables and not re.search(r"^\|---", text, re.M):
        wrong.append("has no picture, graph or table")
    if not re.search(r"^\*\*Here: (equal|better|different)", text, re.M):
        wrong.append("has no verdict (**Here: equal, better or different**)")
    for alt in re.findall(r"!\[([^\]]*)\]\(", text):
        if len(alt) < 12:
            wrong.append(f"a picture's alt text is '{alt}'")
    for name in section.pictures + section.films:
        if not (folder / name).exists():
            wrong.append(f"shows {name}, which is not there")
        if not section.makes(name):
            wrong.append(f"shows {name}, which no command makes")
    for name in section.tables:
        if not section.makes(f"{name}.table"):
            wrong.append(f"has the table {name}, which no command makes")
    return wrong


def check(folder):
    """Prints what the list and the pages do not agree in; returns how much that is."""
    sections, strays = read_sections(folder)
    lines = [f"{PAGES[paper]}: section {item} is in no list" for paper, item in strays]
    index = (folder / "README.md").read_text()
    for section in sections:
        name = f"{section.paper} {section.item}"
        lines += [f"{name}: {problem}" for problem in problems_of(section, folder)]
        if f"({PAGES[section.paper]}#{section.item})" not in index:
            lines.append(f"{name}: is not in the index of README.md")
    shown = {name for section in sections for name in section.pictures + section.films}
    made = {path.name for path in folder.iterdir() if path.suffix in (".png", ".svg", ".mp4")}
    lines += [f"{name}: no page shows it" for name in sorted(made - shown)]
    hashed = set(read_hashes(folder))
    lines += [f"hashes.tsv: {name} has no hash" for name in sorted(name for name in shown - hashed if name.endswith(".png"))]
    lines += [f"hashes.tsv: {name} is shown nowhere" for name in sorted(hashed - shown)]
    print("\n".join(lines + [f"{len(sections)} items, {len(lines)} problems"]))
    return len(lines)


def read_hashes(folder):
    path = folder / "hashes.tsv"
    if not path.exists():
        return {}
    with open(path, newline="") as file:
        return {row["picture"]: (row["full"], row["quick"]) for row in csv.DictReader(file, delimiter="\t")}


def write_hashes(folder, hashes):
    with open(folder / "hashes.tsv", "w", newline="") as file:
        rows = csv.writer(file, delimiter="\t", lineterminator="\n")
        rows.writerow(("picture", "full", "quick"))
        rows.writerows((name, *hashes[name]) for name in sorted(hashes))


def pixels_hash(path):
    """SHA-256 of a PNG's size and rows: the same whatever compressed them."""
    data, place, rows = path.read_bytes(), 8, b""
    head = data[16:29]
    while place < len(data):
        length, kind = int.from_bytes(data[place:place + 4], "big"), data[place + 4:place + 8]
        rows += data[place + 8:place + 8 + length] if kind == b"IDAT" else b""
        place += length + 12
    return hashlib.sha256(head + zlib.decompress(rows)).hexdigest()


def shortened(block):
    for pattern, most in QUICK:
        block = pattern.sub(lambda found: f"{found[1]}{min(int(found[2]), most)}", block)
    return block


def interpreter():
    """A Python that has numpy and matplotlib: this one, or that of the system's packages; None: there is none."""
    for path in (sys.executable, "/usr/bin/python3"):
        if Path(path).exists() and subprocess.run([path, "-c", "import numpy, matplotlib"], capture_output=True).returncode == 0:
            return path
    return None


def has(what):
    return bool(os.environ.get(what)) or shutil.which(what) is not None


def run_section(section, program, python, work, quick):
    """Runs the blocks of an item; returns whether all of them could be run."""
    environment = dict(os.environ, EWA_PYTHON=python, EWA_PROGRAM=str(program), EWA_TOOLS=str(ROOT / "tools"), EWA_PAGES=str(ROOT / "docs" / "papers"),
                       EWA_MEASURE=str(program.parent.parent / "measure"),
                       EWA_LIBRARY=str(program.parent.parent / "libewa.so"),
                       PYTHONPATH=str(ROOT / "python"), PYTHONDONTWRITEBYTECODE="1")
    if quick:
        environment["EWA_QUICK"] = "1"
    whole = True
    for block in section.blocks:
        missing = [what for word, what in NEEDS.items() if word in block and not has(what)]
        if missing:
            print(f"{section.paper} {section.item}: a block is left out, for want of {missing[0]}", flush=True)
            whole = False
            continue
        script = SHELL + (shortened(block) if quick else block)
        status = subprocess.run(["sh", "-c", script], cwd=work, env=environment).returncode
        if status:
            sys.exit(f"{section.paper} {section.item}: its commands failed with {status}")
    return whole


def put_table(page, name, rows):
    """Replaces what a page has between the marks of a table."""
    text = page.read_text()
    before, mark, rest = text.partition(f"<!-- table {name} -->\n")
    page.write_text(f"{before}{mark}\n{rows.strip()}\n\n<!-- end -->{rest.partition('<!-- end -->')[2]}")


def take_results(section, work, folder, hashes, whole):
    """Moves what an item's commands made into the folder of the pages."""
    for name in section.pictures + section.films:
        made = work / name
        if not made.exists():
            if whole:
                sys.exit(f"{section.paper} {section.item}: {name} was not made")
            continue
        if made.suffix == ".png":
            hashes[name] = (pixels_hash(made), hashes.get(name, ("", ""))[1])
        shutil.copyfile(made, folder / name)
    for name in section.tables:
        if (work / f"{name}.table").exists():
            put_table(folder / PAGES[section.paper], name, (work / f"{name}.table").read_text())
        elif whole:
            sys.exit(f"{section.paper} {section.item}: the table {name}.table was not made")


def quick_hashes(section, program, python):
    """Runs an item with few of everything; returns the hashes of its pictures, and what was not made."""
    with tempfile.TemporaryDirectory() as work:
        whole = run_section(section, program, python, Path(work), True)
        made = {path.name: path for path in Path(work).iterdir()}
        wanted = section.pictures + section.films + [f"{name}.table" for name in section.tables]
        missing = [name for name in wanted if name not in made] if whole else []
        # Pictures of files from elsewhere are what those files are.
        from_data = [block for block in section.blocks if "$EWA_DATA" in block]
        hashes = {name: pixels_hash(made[name]) for name in section.pictures if name.endswith(".png") and name in made
                  and not any(name in block for block in from_data)}
        return hashes, missing


def run(program, python, folder, paper, item, quick):
    """Runs items; returns how many problems there were."""
    sections, _ = read_sections(folder)
    shown = {name for section in sections for name in section.pictures}
    hashes = {name: pair for name, pair in read_hashes(folder).items() if name in shown}
    wrong, count = [], 0
    for section in sections:
        if (paper and section.paper != paper) or (item and section.item != item):
            continue
        count += 1
        name = f"{section.paper} {section.item}"
        start_s, used_s = time.monotonic(), sum(os.times()[2:4])
        if not quick:
            with tempfile.TemporaryDirectory() as work:
                whole = run_section(section, program, python, Path(work), False)
                take_results(section, Path(work), folder, hashes, whole)
        found, missing = quick_hashes(section, program, python)
        wrong += [f"{name}: {picture} was not made" for picture in missing]
        for picture, pixels in found.items():
            if quick and hashes.get(picture, ("", ""))[1] != pixels:
                wrong.append(f"{name}: the pixels of {picture} are others than those of hashes.tsv")
            hashes[picture] = (hashes.get(picture, ("", ""))[0], pixels)
        if not quick:
            write_hashes(folder, hashes)
        print(f"{name}: {time.monotonic() - start_s:.1f} s, {sum(os.times()[2:4]) - used_s:.1f} s of processors", flush=True)
    if not count:
        sys.exit(f"no such item: {paper} {item}; docs/papers/items.tsv has them all")
    print("\n".join(wrong + [f"{count} items, {len(wrong)} problems"]))
    return len(wrong)


def main():
    words = sys.argv[1:]
    folder = ROOT / "docs" / "papers"
    if words[:1] == ["check"]:
        return 1 if check(Path(words[1]) if len(words) > 1 else folder) else 0
    if words[:1] not in (["make"], ["quick"]) or len(words) < 2:
        sys.exit(__doc__)
    python = interpreter()
    if not python:
        print("left out: there is no Python with numpy and matplotlib")
        return SKIPPED
    program = Path(words[1]).resolve()
    paper, item = (words[2:] + ["", ""])[:2]
    return 1 if run(program, python, folder, paper, item, words[0] == "quick") else 0


if __name__ == "__main__":
    sys.exit(main())
