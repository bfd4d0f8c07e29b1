# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Figures 2 to 4 of HFR, computed on examples: hfr_geometry.py ORDER.svg ELLIPSE.svg INDEX.svg NAME.table"""
import ctypes
import sys

import numpy as np
from discs import outline
from ewa import _bindings as b
from ewa._library import functions as lib
from style import GREY, OTHER, OURS, PAPER, plt, save, table


def order():
    """A slice of a volume before the eye: the depth unit of each voxel, and splats where a voxel takes over 1.2 pixels."""
    focal_px, figure, axes = 24, *plt.subplots(figsize=(5.6, 3.4))
    x, z = np.meshgrid(np.arange(-9, 10), np.arange(8, 31))
    unit = np.floor(z - 8 + 0.5)
    splat = focal_px / z > 1.2
    for kind, marker, name in ((splat, "o", "splat"), (~splat, ".", "point")):
        axes.scatter(x[kind], z[kind], c=unit[kind], cmap="viridis", vmin=0, vmax=22, marker=marker, s=26, label=name)
    axes.axhline(focal_px / 1.2, color=PAPER, linestyle="--", linewidth=1)
    axes.annotate("farther on, a voxel\nis below 1.2 pixels:\npoints", (10, focal_px / 1.2 + 1), fontsize=7, va="bottom")
    row = x[2]
    ranks = np.argsort(np.argsort(np.hypot(row, z[2]), kind="stable"))
    for place, rank in zip(row, ranks):
        axes.annotate(str(rank + 1), (place, z[2, 0]), fontsize=5, color="white", ha="center", va="center")
    axes.plot(0, 0, "k^")
    axes.annotate("eye", (0.5, 0))
    axes.set(xlabel="x, voxels", ylabel="z, voxels", xlim=(-10, 18), ylim=(-1, 32))
    figure.colorbar(axes.collections[0], label="depth unit, drawn from 0 on")
    axes.legend(loc="lower right", markerscale=1)
    save(figure, sys.argv[1])


def ellipse():
    p, r = np.array([1.1, 0.5, 1.6]), 0.5
    rows = np.outer(p, p)
    dual = b.ewa_conic(xx=r * r - rows[0, 0], xy=-rows[0, 1], xw=-rows[0, 2], yy=r * r - rows[1, 1], yw=-rows[1, 2], ww=r * r - rows[2, 2])
    middle, shape = (ctypes.c_double * 2)(), (ctypes.c_double * 3)()
    assert lib.ewa_dual_conic_ellipse(ctypes.byref(dual), middle, shape) == 0
    # The paper's: the circle where the rays touch, its diameter AB in the plane of the view's axis and the centre's ray.
    length = np.linalg.norm(p)
    touch, radius = p * (1 - r * r / length ** 2), r * np.sqrt(1 - r * r / length ** 2)
    q = p / length
    aside = np.array([0, 0, 1]) - q[2] * q
    aside /= np.linalg.norm(aside)
    ends = [touch + sign * radius * aside for sign in (-1, 1)]
    a, b_, c = [point[:2] / point[2] for point in (*ends, touch)]
    figure, axes = plt.subplots(figsize=(4.4, 3.2))
    axes.plot(*outline(np.array(middle), np.array([[shape[0], shape[1]], [shape[1], shape[2]]])).T, color=OURS, label="the library's ellipse of r² I − p'p")
    around = np.linspace(0, 2 * np.pi, 241)
    other = np.cross(q, aside)
    rim = touch + radius * (np.cos(around)[:, None] * aside + np.sin(around)[:, None] * other)
    axes.plot(*(rim[::6, :2] / rim[::6, 2:]).T, ".", color=GREY, markersize=4, label="where rays touch the sphere")
    axes.plot(*np.stack([a, b_]).T, color=OTHER)
    for name, point, offset in (("A'", a, (4, 4)), ("B'", b_, (-12, -10)), ("C'", c, (-12, 3)), ("middle", (a + b_) / 2, (4, -9))):
        axes.plot(*point, "k.", markersize=6)
        axes.annotate(name, point, xytext=offset, textcoords="offset points")
    axes.plot(0, 0, "+", color="black", markersize=9)
    axes.annotate("P", (0, 0), xytext=(4, -10), textcoords="offset points")
    axes.set_aspect("equal")
    axes.invert_yaxis()
    axes.set(xlabel="x on the plane z = 1", ylabel="y")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, 1.28))
    save(figure, sys.argv[2])
    write = [("centre of the library's ellipse", *(f"{n:.6f}" for n in middle)),
             ("middle of A'B'", *(f"{n:.6f}" for n in (a + b_) / 2)), ("C'", *(f"{n:.6f}" for n in c)),
             ("projection of the sphere's centre", *(f"{n:.6f}" for n in p[:2] / p[2]))]
    table(sys.argv[4], ("on the plane z = 1", "x", "y"), write)


def index():
    figure, axes = plt.subplots(figsize=(4.8, 2.8))
    i = np.linspace(0, 1, 101)
    for alpha, style in ((5, "-"), (15, "--"), (30, ":")):
        half = np.radians(alpha)
        printed = np.sin(np.arctan(i * np.tan(half))) / np.tan(half)
        axes.plot(i, printed - i, style, color=PAPER, label=f"printed (over tan α), α = {alpha}°")
        axes.plot(i, np.sin(np.arctan(i * np.tan(half))) / np.sin(half) - i, style, color=OURS, label=f"over sin α, α = {alpha}°")
    axes.set(xlabel="place i in the ellipse (0: centre, 1: rim)", ylabel="index d − i")
    axes.legend(fontsize=7)
    save(figure, sys.argv[3])


order()
ellipse()
index()
