# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""A hierarchy's pictures from coarse to fine: ss_hierarchy.py GRAPH.svg NAME.table SPACING:STATS.json:PICTURE.png ...

The last one is what the others are compared with; it has all points."""
import json
import sys

import ewa
import numpy as np
from style import OURS, plt, save, table

steps = [argument.split(":") for argument in sys.argv[3:]]
pictures = [np.asarray(ewa.read_image(path), float)[..., :3] for _, _, path in steps]
figure, axes = plt.subplots(figsize=(5, 2.8))
rows, times, errors = [], [], []
for (spacing, stats, _), picture in zip(steps, pictures):
    with open(stats) as file:
        facts = json.load(file)
    took_ms = 1000 * (facts["wall_s"]["load"] + facts["wall_s"]["render"])
    error = ((picture - pictures[-1]) ** 2).mean()
    rows.append((spacing, f"{facts['splats']:,}", f"{took_ms:.0f}",
                 "-" if error == 0 else f"{-10 * np.log10(error):.1f}"))
    if error:
        times.append(took_ms)
        errors.append(-10 * np.log10(error))
        axes.annotate(f"{spacing} px", (took_ms, errors[-1]), xytext=(5, -3), textcoords="offset points", fontsize=7)
axes.plot(times, errors, "o-", color=OURS)
axes.set(xlabel="reading and drawing, ms", ylabel="PSNR to all points, dB", xscale="log")
save(figure, sys.argv[1])
table(sys.argv[2], ("spacing on the screen, px", "splats", "ms", "PSNR to all points, dB"), rows)
