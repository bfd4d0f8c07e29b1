# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Section 7 of SS, inside of a plane: how even the sum q of the resampling kernels is on regular and irregular grids (unity), and
what a threshold on it takes for an edge (tau): ss_coverage.py unity|tau GRAPH.svg NAME.table

q0 is what a covered pixel expects (docs/math.md section 7): of the paper's truncated kernels 1 - 1/e, so that its threshold
0.4 is 0.63 q0."""
import sys

import ewa
import numpy as np
from style import OURS, PAPER, QUICK, plt, save, table

SIDE_PX, GRID = 256, 30 if QUICK else 100
SETTINGS = (("the paper's", 2 ** 0.5, 1.0, 1.0, 0.4 / (1 - np.exp(-1)), PAPER), ("ours", 3.0, 0.35, 0.38, 0.45, OURS))
JITTERS = ((0, "-"), (0.5, "--"), (1, ":"))
camera = ewa.Camera.look_at((0, -0.3, 1.2), (0, 0, 0), (0, 1, 0), fov=45, size=(SIDE_PX, SIDE_PX))


def coverage(cutoff, prefilter, sigma, jitter):
    """q / q0 of every pixel."""
    cloud = ewa.generate("plane", GRID * GRID, jitter=jitter, radius_scale=sigma * cutoff)
    surfels = cloud.surfels(cutoff=cutoff, close_gaps=False)
    return ewa.render(surfels, camera, planes="coverage", prefilter_px=prefilter).coverage.ravel()


what, rows = sys.argv[1], []
figure, parts = plt.subplots(1, 2, figsize=(7, 2.6), sharey=True)
thresholds = np.linspace(0.05, 1, 96)
for part, (name, cutoff, prefilter, sigma, tau, color) in zip(parts, SETTINGS):
    for jitter, style in JITTERS:
        q = coverage(cutoff, prefilter, sigma, jitter)
        numbers = (name, f"{cutoff:.3g}, {prefilter:g}, {sigma:g}", jitter)
        if what == "unity":
            part.hist(q, bins=np.linspace(0, 2.2, 111), density=True, histtype="step", color=color, linestyle=style, label=f"jitter {jitter}")
            rows.append((*numbers, f"{q.mean():.3f}", f"{100 * q.std() / q.mean():.1f} %", f"{q.min():.2f} to {q.max():.2f}"))
        else:
            shares = [100 * (q < threshold).mean() for threshold in thresholds]
            part.plot(thresholds, shares, color=color, linestyle=style, label=f"jitter {jitter}")
            rows.append((*numbers, f"{tau:.2f}", f"{100 * (q < tau).mean():.2f} %", f"{min(1, q.min() / tau):.2f}"))
    part.axvline(tau, color="black", linewidth=0.8)
    part.set(xlabel="q / q0" if what == "unity" else "threshold on q / q0; the line: what is used",
             title=f"{name}: F {cutoff:.3g}, h {prefilter:g} px, σ {sigma:g} spacings")
    part.legend()
parts[0].set_ylabel("density of the pixels inside" if what == "unity" else "pixels inside with α < 1, %")
save(figure, sys.argv[2])
head = ("numbers", "F, h px, σ/spacing", "jitter")
table(sys.argv[3], (*head, "mean q/q0", "deviation", "range") if what == "unity" else (*head, "threshold on q/q0", "pixels with α < 1", "lowest α"), rows)
