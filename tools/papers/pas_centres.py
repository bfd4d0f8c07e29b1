# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Section 4.4 of PAS: how far the centre of a projected ellipse lies from the projected centre: pas_centres.py GRAPH.svg NAME.table"""
import sys

import numpy as np
from discs import projected, tilted
from style import QUICK, plt, save, table

FOCAL_PX, TILTS = 512, np.arange(0, 90, 30 if QUICK else 2)
figure, axes = plt.subplots(figsize=(4.8, 2.8))
rows = []
for radius_px in (1, 10, 100):
    off = []
    for tilt in TILTS:
        center, axis = tilted(tilt, (0.25, 0.2, 1.0), radius_px / FOCAL_PX)
        off.append(FOCAL_PX * np.hypot(*(projected(center, axis, 1)[0] - center[:2] / center[2])))
    axes.semilogy(TILTS[1:], off[1:], label=f"radius {radius_px} px")
    rows.append((radius_px, f"{max(off):.2g}", f"{100 * max(off) / radius_px:.2g} %", f"{TILTS[int(np.argmax(off))]}°"))
axes.set(xlabel="tilt of the disc against the picture, degrees", ylabel="pixels off")
axes.set_ylim(1e-5, 1e3)
axes.legend(loc="upper right", ncol=3)
save(figure, sys.argv[1])
table(sys.argv[2], ("radius, px", "largest distance, px", "of the radius", "at a tilt of"), rows)
