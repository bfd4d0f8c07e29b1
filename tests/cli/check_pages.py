#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Types the commands of a page as they stand there, in a folder with small files of the names that docs/cookbook.md says.

    check_pages.py EWA PAGE SCRATCH

Each block of shell has to succeed and to say nothing of a warning, and each file after -o has to be there. Blocks that write films are left
out without ffmpeg.
"""
import glob
import json
import math
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

FILM = re.compile(r"-o \S+\.(mp4|gif|webm|mkv)\b")


def box_stl(low, high):
    """A box as triangles of text."""
    lines = ["solid box"]
    for axis in range(3):
        for end in range(2):
            corners = []
            for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)) if end else ((0, 0), (0, 1), (1, 1), (1, 0)):
                place = [0, 0, 0]
                place[axis], place[(axis + 1) % 3], place[(axis + 2) % 3] = end, u, v
                corners.append(" ".join(str(high if one else low) for one in place))
            for triangle in ((0, 1, 2), (0, 2, 3)):
                lines += ["facet normal 0 0 0", "outer loop", *(f"vertex {corners[k]}" for k in triangle), "endloop", "endfacet"]
    return "\n".join([*lines, "endsolid box", ""])


def gaussians_ply(count):
    """Gaussians in a ring, with the properties that training writes."""
    names = ["x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"]
    rows = []
    for i in range(count):
        angle = 2 * math.pi * i / count
        rows.append(f"{math.cos(angle):.4f} 0 {math.sin(angle):.4f} {math.cos(angle):.3f} 0.2 {math.sin(angle):.3f} 2 -2.5 -2.5 -3 1 0 0 0")
    head = ["ply", "format ascii 1.0", f"element vertex {count}", *(f"property float {name}" for name in names), "end_header"]
    return "\n".join([*head, *rows, ""])


def make_files(run):
    run("ewa generate town -n 20000 --positions-only -o scan.ply")
    run("ewa generate torus -n 8000 --positions-only -o scan2.ply")
    run("ewa generate cube -n 8000 --positions-only -o corner.ply")
    run("ewa generate terrain -n 10000 -o ground.ply")
    run("ewa generate vessels --dims 32 -o head.nrrd")
    run("ewa convert ground.ply -o points.csv")
    rows = [line.split(",") for line in Path("points.csv").read_text().splitlines()]
    rows = [row for row in rows if re.match(r"-?[\d.]", row[0])]
    Path("survey.txt").write_text("x,y,z,classification\n" + "".join(f"{r[0]},{r[1]},{r[2]},{2 if float(r[2]) < 0.1 else 5}\n" for r in rows))
    run("ewa convert survey.txt -o survey.laz")
    Path("points.txt").write_text("".join(f"{r[0]} {r[1]} {r[2]} 7 200 120 40\n" for r in rows))
    Path("part.stl").write_text(box_stl(0.1, 0.6))
    Path("block.stl").write_text(box_stl(0, 0.5))
    Path("trained.ply").write_text(gaussians_ply(300))
    down = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 5], [0, 0, 0, 1]]  # from above; nerfstudio's cameras look along -z
    frames = [{"file_path": f"photo{k}.png", "transform_matrix": [[*row[:3], row[3] + 0.2 * k * (i == 0)] for i, row in enumerate(down)]}
              for k in range(3)]
    Path("transforms.json").write_text(json.dumps({"fl_x": 400, "fl_y": 400, "cx": 160, "cy": 120, "w": 320, "h": 240, "frames": frames}))
    for k in range(3):
        run(f"ewa render ground.ply -o photo{k}.png --camera transforms.json --camera-index {k}")
    shutil.copy("photo0.png", "photo.png")


def main():
    ewa, page, scratch = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve(), Path(sys.argv[3])
    shutil.rmtree(scratch, ignore_errors=True)
    scratch.mkdir(parents=True)
    os.chdir(scratch)
    os.environ["PATH"] = f"{ewa.parent}:{os.environ['PATH']}"
    found = []

    def run(block):
        done = subprocess.run(["sh", "-e", "-c", block], capture_output=True, text=True, check=False)
        if done.returncode or "warning" in done.stderr:
            found.append(f"{block.strip()}\n  {done.returncode}: {done.stderr.strip()}")

    if "cookbook" in page.name:
        make_files(run)
    blocks = re.findall(r"```sh\n(.*?)```", page.read_text(encoding="utf-8"), re.S)
    left_out = 0
    for block in blocks:
        if FILM.search(block) and not shutil.which("ffmpeg"):
            left_out += 1
            continue
        run(block)
        for name in re.findall(r"(?:^| )-o (\S+)", block):
            made = glob.glob(re.sub(r"%\d*d", "*", name))
            if name != "-" and (not made or min(map(os.path.getsize, made)) < 100):
                found.append(f"{block.strip()}\n  no {name}")
    print("\n".join(found) if found else f"{len(blocks) - left_out} blocks, {left_out} left out without ffmpeg")
    return bool(found) or len(blocks) < 10


if __name__ == "__main__":
    sys.exit(main())
