# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Table 2 of SS from the figures of `ewa bench --json`: ss_frames.py GRAPH.svg NAME.table NAME:PAPER_256:PAPER_512=256.json,512.json ..."""
import json
import sys

from style import OURS, PAPER, plt, save, table

figure, axes = plt.subplots(figsize=(5.2, 2.8))
rows, points, times, theirs = [], [], ([], []), ([], [])
for argument in sys.argv[3:]:
    label, files = argument.rsplit("=", 1)
    name, *paper = label.split(":")
    found = []
    for path in files.split(","):
        with open(path) as file:
            found.append(json.load(file)["results"])
    count = found[0][0]["splats"]
    cells = []
    for k in (0, 1):
        best = {result["threads"]: 1000 / result["lowest_ms"] for result in found[k]}
        cells.append(f"{paper[k]} · " + " · ".join(f"{best[threads]:.1f}" for threads in sorted(best)))
        times[k].append(found[k][0]["lowest_ms"])
        theirs[k].append(1000 / float(paper[k]))
    points.append(count)
    rows.append((name, f"{count:,}", *cells))
order = sorted(range(len(points)), key=points.__getitem__)
for k, style in ((0, "o-"), (1, "s--")):
    size = (256, 512)[k]
    axes.loglog([points[i] for i in order], [theirs[k][i] for i in order], style, color=PAPER, label=f"the paper, {size}²")
    axes.loglog([points[i] for i in order], [times[k][i] for i in order], style, color=OURS, label=f"here, one thread, {size}²")
axes.set(xlabel="points", ylabel="ms per frame")
axes.legend(fontsize=7)
save(figure, sys.argv[1])
threads = sorted({result["threads"] for result in found[0]})
table(sys.argv[2], ("data", "points", *(f"{size} × {size}, frames/s: paper · here, " + " · ".join(f"{n} thread{'s' * (n > 1)}" for n in threads)
                                        for size in (256, 512))), rows)
