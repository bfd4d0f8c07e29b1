# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Table 2 of SS by `ewa bench`: ss_frames.py GRAPH.svg TABLE.table NAME:PAPER_256:PAPER_512=FILE ...

A frame's time is that of the processor, on one thread: of a run of several frames less one of one frame. So it holds on a
machine that does other work, too."""
import json
import os
import resource
import subprocess
import sys

from style import OURS, PAPER, QUICK, plt, save, table

FRAMES = 2 if QUICK else 4


def run(path, side, frames, *more):
    """Processor seconds of a run, and what it measured."""
    def used():
        usage = resource.getrusage(resource.RUSAGE_CHILDREN)
        return usage.ru_utime + usage.ru_stime
    before = used()
    command = [os.environ["EWA_PROGRAM"], "bench", path, "--size", f"{side}x{side}", "--workers", "1", "--frames", str(frames),
               "--stages", "off", "--json", "-", *more]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    return used() - before, json.loads(text)["results"][0]


def frame_s(path, side, *more):
    one, _ = run(path, side, 1, *more)
    several, measured = run(path, side, FRAMES, *more)
    return max(several - one, 1e-4) / (FRAMES - 1), measured["splats"]


figure, axes = plt.subplots(figsize=(5.2, 2.8))
rows, points, here, theirs = [], [], ([], []), ([], [])
for argument in sys.argv[3:]:
    label, path = argument.rsplit("=", 1)
    name, *paper = label.split(":")
    cells = []
    for k, side in ((0, 256), (1, 512)):
        seconds, count = frame_s(path, side)
        plain, _ = frame_s(path, side, "--edge-layers", "1")
        here[k].append(1000 * seconds)
        theirs[k].append(1000 / float(paper[k]))
        cells += [paper[k], f"{1 / seconds:.2g}", f"{1 / plain:.2g}"]
    points.append(count)
    rows.append((name, f"{count:,}", *cells))
order = sorted(range(len(points)), key=points.__getitem__)
for k, style in ((0, "o-"), (1, "s--")):
    size = (256, 512)[k]
    axes.loglog([points[i] for i in order], [theirs[k][i] for i in order], style, color=PAPER, label=f"the paper, {size}²")
    axes.loglog([points[i] for i in order], [here[k][i] for i in order], style, color=OURS, label=f"here, one thread, {size}²")
axes.set(xlabel="points", ylabel="ms per frame")
axes.legend(fontsize=7)
save(figure, sys.argv[1])
table(sys.argv[2], ("data", "points", *(f"{size}²: {what}" for size in (256, 512) for what in ("paper, frames/s", "here", "here, one edge layer"))), rows)
