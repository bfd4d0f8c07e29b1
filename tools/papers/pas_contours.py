# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Figure 2 of PAS: isocontours of one Gaussian under strong perspective, exact, by the conic, by the affine map; and how
far the last two are off over the tilt: pas_contours.py CONTOURS.svg ERROR.svg NAME.table"""
import sys

import numpy as np
from discs import affine, furthest, outline, projected, tilted
from style import GREY, OTHER, OURS, PAPER, QUICK, bare, plt, save, table

RADIUS, PLACE, CONTOURS = 0.45, (0.25, 0.2, 1.0), (1, 2, 3)  # a disc as large as half of its distance; F = 3
FOCAL_PX = 512


def contours():
    figure, axes = plt.subplots(3, 3, figsize=(6.6, 5.4))
    for row, tilt in zip(axes, (0, 45, 68)):
        center, vectors = tilted(tilt, PLACE, RADIUS / CONTOURS[-1])
        rim_middle, rim_shape = projected(center, vectors, CONTOURS[-1])
        affine_middle, affine_shape = affine(center, vectors)
        for part, title, color in zip(row, ("exact", "the conic (PAS)", "affine (Heckbert, SS)"), (OTHER, OURS, PAPER)):
            for level in CONTOURS:
                middle, shape = {"exact": lambda: projected(center, vectors, level),
                                 "the conic (PAS)": lambda: (rim_middle, rim_shape * (level / CONTOURS[-1]) ** 2),
                                 "affine (Heckbert, SS)": lambda: (affine_middle, affine_shape * level ** 2)}[title]()
                if title != "exact" and level == CONTOURS[-1]:
                    part.plot(*outline(rim_middle, rim_shape).T, color="#bbbbbb", linewidth=3)
                part.plot(*outline(middle, shape).T, color=color)
                part.plot(*middle, ".", color=color, markersize=3)
            part.plot(*(center[:2] / center[2]), "+", color="black")
            bare(part)
            if tilt == 0:
                part.set_title(title)
        lows, highs = zip(*(part.dataLim.get_points() for part in row))
        low, high = np.min(lows, 0) - 0.02, np.max(highs, 0) + 0.02
        for part in row:
            part.set(xlim=(low[0], high[0]), ylim=(high[1], low[1]))
        row[0].text(-0.05, 0.5, f"tilt {tilt}°", transform=row[0].transAxes, rotation=90, va="center", ha="right")
    save(figure, sys.argv[1])


def errors(radius, tilts):
    """Of a disc before the eye, in pixels at a focal length of FOCAL_PX: rim of the conic, rim of the affine map, its
    centre as the conic has it from the true one."""
    found = []
    for tilt in tilts:
        center, vectors = tilted(tilt, PLACE, radius)
        exact = projected(center, vectors, 1)
        if exact is None:
            break
        # Points of the rim itself, projected one by one.
        around = np.linspace(0, 2 * np.pi, 91)
        rim = center + np.stack([np.cos(around), np.sin(around)], 1) @ vectors
        rim = rim[:, :2] / rim[:, 2:]
        off_center = np.hypot(*(exact[0] - center[:2] / center[2]))
        found.append((tilt, furthest(rim, *exact), furthest(rim, *affine(center, vectors)), off_center))
    tilts, *lengths = np.array(found).T
    return tilts, [FOCAL_PX * length for length in lengths]


def main():
    contours()
    figure, axes = plt.subplots(figsize=(5.2, 3))
    rows = []
    for radius, width in ((0.45, 1.8), (0.1, 1.0), (0.01, 0.5)):
        tilts, (conic, flat, middle) = errors(radius, np.arange(1, 86, 1 if not QUICK else 20))
        axes.semilogy(tilts, flat, color=PAPER, linewidth=width)
        axes.semilogy(tilts, middle, color=GREY, linewidth=width, linestyle="--")
        axes.semilogy(tilts, np.maximum(conic, 1e-13), color=OURS, linewidth=width)
        axes.annotate(f"r/z = {radius}", (tilts[len(tilts) // 5], flat[len(tilts) // 5]), xytext=(0, 4), textcoords="offset points", fontsize=7)
        for tilt in (1, 30, 60, 80):
            if tilt in tilts:
                at = list(tilts).index(tilt)
                rows.append((radius, f"{tilt}°", f"{conic[at]:.1e}", f"{flat[at]:.3g}", f"{middle[at]:.3g}"))
    axes.set(xlabel="tilt of the disc against the picture, degrees", ylabel="pixels off, focal length 512 px")
    axes.plot([], [], color=PAPER, label="rim, affine map")
    axes.plot([], [], color=GREY, linestyle="--", label="centre, conic")
    axes.plot([], [], color=OURS, label="rim, conic (rounding)")
    axes.legend(loc="center right")
    save(figure, sys.argv[2])
    table(sys.argv[3], ("radius / distance", "tilt", "rim by the conic, px off", "rim by the affine map, px off",
                        "centre by the conic, px off"), rows)


main()
