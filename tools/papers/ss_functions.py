# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Figures 2 to 5 of SS, computed: ss_functions.py FUNCTIONS.svg NAME.table

In one dimension: samples at irregular places u_k of a line carry Gaussians; the line is seen by a pinhole, x = m(u); the
picture is filtered by a Gaussian of half a pixel and sampled. Then the Jacobian of one splat, by the paper's construction,
by docs/math.md, and by differences of the projection itself."""
import sys

import numpy as np
from discs import affine
from style import GREY, OTHER, OURS, PAPER, plt, save, table

PREFILTER_PX = 0.5


def functions():
    random = np.random.default_rng(4)
    place = (np.arange(14) + random.uniform(0.15, 0.85, 14)) / 14
    weight = 0.5 + 0.4 * np.sin(9 * place) + 0.1 * random.standard_normal(14)
    sigma = 0.6 / 14
    # The line runs from z = 1 to z = 4: a pixel of the right end sees four times as much of it.
    def to_screen(u):
        return 24 * (u - 0.1) / (1 + 3 * u)
    def slope(u):
        return 24 * (1 + 0.3) / (1 + 3 * u) ** 2
    def to_line(x):
        return (x + 2.4) / (24 - 3 * x)
    def bell(t, deviation):
        return np.exp(-0.5 * (t / deviation) ** 2)
    u = np.linspace(0, 1, 1501)
    x = np.linspace(to_screen(0), to_screen(1), 1501)
    basis = bell(u[:, None] - place, sigma)
    warped = bell(to_line(x)[:, None] - place, sigma)
    step = x[1] - x[0]
    taps = np.arange(-3 * PREFILTER_PX, 3 * PREFILTER_PX + step / 2, step)
    pixel = bell(taps, PREFILTER_PX) / bell(taps, PREFILTER_PX).sum()
    filtered = np.stack([np.convolve(column, pixel, mode="same") for column in warped.T], 1)
    # Equation 6: each kernel by its own affine map.
    width = sigma * slope(place)
    kernels = width / np.hypot(width, PREFILTER_PX) * bell(x[:, None] - to_screen(place), np.hypot(width, PREFILTER_PX))
    inside = (x > x[0] + 1.5) & (x < x[-1] - 1.5)
    error = np.abs(kernels @ weight - filtered @ weight)[inside].max() / np.ptp(filtered @ weight)
    figure, axes = plt.subplots(4, 1, figsize=(6.2, 6.4))
    for part, at, shown, color, title in (
            (axes[0], u, basis, OURS, "figure 2: the texture function f(u) is a sum of basis functions"),
            (axes[1], x, warped, PAPER, "figure 3: warped to the screen, g(x) = f(m⁻¹(x))"),
            (axes[2], x, kernels, OTHER, "figure 4: resampling kernels, each warped by its own affine map and filtered")):
        part.plot(at, shown * weight, color=GREY, linewidth=0.7)
        part.plot(at, shown @ weight, color=color)
        part.set_title(title, loc="left")
        part.set_xlabel("place on the line, u" if part is axes[0] else "pixels, x")
    axes[2].plot(x, filtered @ weight, ":", color="black", label=f"the true convolution: {100 * error:.1f} % of the range away at most")
    axes[2].legend(loc="lower left", bbox_to_anchor=(0.25, 0.75))
    axes[2].set_ylim(0, 2.2)
    centers = np.arange(np.ceil(x[0]) + 0.5, x[-1])
    values = np.interp(centers, x, kernels @ weight) / np.interp(centers, x, kernels.sum(1))
    axes[3].plot(x, (kernels @ weight) / kernels.sum(1), color=OTHER, label="over the sum of the kernels (equation 9)")
    axes[3].stem(centers, values, linefmt=GREY, markerfmt="k.", basefmt=" ")
    axes[3].set_title("sampled at the pixels' centres", loc="left")
    axes[3].set_xlabel("pixels, x")
    axes[3].set_ylim(0, 1.3)
    axes[3].legend(loc="upper right")
    save(figure, sys.argv[1])


def jacobian():
    """Figure 5: x0 and x1, the screen's basis vectors, go along the viewing ray to the tangent plane."""
    p, n = np.array([0.4, -0.3, 2.0]), np.array([0.5, 0.3, -0.81])
    n = n / np.linalg.norm(n)
    def to_plane(x, y):
        ray = np.array([x, y, 1])
        return ray * (p @ n) / (ray @ n)
    # The derivative of that map at P: the vectors of the paper, exactly.
    x, y, small = p[0] / p[2], p[1] / p[2], 1e-6
    tilde = [(to_plane(x + small, y) - to_plane(x - small, y)) / (2 * small),
             (to_plane(x, y + small) - to_plane(x, y - small)) / (2 * small)]
    u0 = tilde[0] / np.linalg.norm(tilde[0])
    u1 = np.cross(n, u0)
    paper = np.linalg.inv(np.array([[tilde[0] @ u0, tilde[1] @ u0], [tilde[0] @ u1, tilde[1] @ u1]]))
    def project(a, b):
        q = p + a * u0 + b * u1
        return q[:2] / q[2]
    differences = np.stack([(project(small, 0) - project(-small, 0)) / (2 * small),
                            (project(0, small) - project(0, -small)) / (2 * small)], 1)
    axes = np.stack([u0, u1])
    ours = ((axes[:, :2] * p[2] - np.outer(axes[:, 2], p[:2])) / p[2] ** 2).T
    rows = [(name, *(f"{number:.6f}" for number in matrix.ravel())) for name, matrix in (
        ("the paper's construction, inverted", paper), ("differences of the projection", differences),
        ("docs/math.md section 3, F → 0", ours))]
    shape = affine(p, axes)[1]
    rows.append(("V = J Jᵀ of docs/math.md section 3", *(f"{number:.6f}" for number in shape.ravel())))
    rows.append(("J Jᵀ of the first row", *(f"{number:.6f}" for number in (paper @ paper.T).ravel())))
    table(sys.argv[2], ("J", "∂x/∂u₀", "∂x/∂u₁", "∂y/∂u₀", "∂y/∂u₁"), rows)


functions()
jacobian()
