# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""The figures and the worked examples of HC by the library's own functions:
homogeneous.py COORDINATES.svg PLANE.svg W.svg PERSPECTIVE.svg NAME.table"""
import ctypes
import sys

import numpy as np
from ewa import _bindings as b
from ewa._library import functions as lib
from style import GREY, OTHER, OURS, PAPER, bare, plt, save, table

D, F, SX, SY = 1.0, 4.0, 0.8, 0.6


def vec3(*numbers):
    return b.ewa_vec3(*numbers)


def vec4(*numbers):
    return b.ewa_vec4(*numbers)


def numbers_of(vector):
    return np.array([getattr(vector, name) for name, _ in vector._fields_])


def mat(kind, rows):
    made = kind()
    for i, row in enumerate(rows):
        for j, number in enumerate(row):
            made.m[i][j] = number
    return made


def divided(point):
    """Euclidean coordinates, None for a direction."""
    count = len(numbers_of(point)) - 1
    out = (ctypes.c_double * count)()
    call = lib.ewa_point2_divide if count == 2 else lib.ewa_point3_divide
    return np.array(out) if call(point, out) == 0 else None


TRIANGLE = (b.ewa_vec3 * 3)(vec3(1, 1, 1), vec3(7, 2, 1), vec3(3, 6, 1))
#: [P] of the section "Perspective Space", rows.
PERSPECTIVE = mat(b.ewa_mat4, [[1 / SX, 0, 0, 0], [0, 1 / SY, 0, 0], [0, 0, 1 / (D * (1 - D / F)), 1 / D], [0, 0, -1 / (1 - D / F), 0]])


def weights_of(point):
    weights = (ctypes.c_double * 3)()
    assert lib.ewa_triangle_barycentric(TRIANGLE, point, weights) == 0
    return np.array(weights)


def distances_of(point):
    distances = (ctypes.c_double * 3)()
    assert lib.ewa_triangle_distances(TRIANGLE, point, distances) == 0
    return np.array(distances)


def coordinates():
    figure, parts = plt.subplots(1, 3, figsize=(7.2, 2.6))
    corners = np.array([numbers_of(corner)[:2] for corner in TRIANGLE])
    p = vec3(3.5, 2.8, 1)
    place, weights, distances = divided(p), weights_of(p), distances_of(p)
    for part in parts:
        part.plot(*corners[[0, 1, 2, 0]].T, color="black", linewidth=1)
        part.plot(*place, "o", color=OURS, markersize=4)
        for name, corner, offset in zip("abc", corners, ((-8, -8), (4, -4), (0, 4))):
            part.annotate(name, corner, xytext=offset, textcoords="offset points")
        bare(part)
    for corner, weight in zip(corners, weights):
        parts[0].plot(*np.stack([place, corner]).T, color=GREY, linewidth=0.8)
        parts[0].plot(*corner, "o", color=PAPER, markersize=22 * weight)
    parts[0].set_title("weights " + ", ".join(f"{weight:.3f}" for weight in weights))
    for k, color in enumerate((OURS, PAPER, OTHER)):
        parts[1].fill(*np.stack([place, corners[(k + 1) % 3], corners[(k + 2) % 3]]).T, color=color, alpha=0.35)
    parts[1].set_title("areas over the whole: the same")
    for k, color in enumerate((OURS, PAPER, OTHER)):
        start, end = corners[(k + 1) % 3], corners[(k + 2) % 3]
        along = (end - start) / np.linalg.norm(end - start)
        foot = start + along * ((place - start) @ along)
        parts[2].plot(*np.stack([place, foot]).T, color=color)
    parts[2].set_title("distances " + ", ".join(f"{distance:.3f}" for distance in distances))
    save(figure, sys.argv[1])


def projective_plane():
    """Lines through s meet the plane w = 1 in points; a parallel one in none."""
    figure = plt.figure(figsize=(6.4, 2.9))
    axes = figure.add_subplot(1, 2, 1, projection="3d")
    x, y = np.meshgrid([-1.5, 1.5], [-1.5, 1.5])
    axes.plot_surface(x, y, np.ones_like(x), color=OURS, alpha=0.2)
    for direction, color in (((0.6, 0.4, 1), PAPER), ((-0.7, 0.5, 1), OTHER), ((0.2, -0.9, 1), GREY)):
        end = divided(vec3(*direction))
        axes.plot(*np.stack([(0, 0, 0), 1.3 * np.array(direction)]).T, color=color)
        axes.scatter(*end, 1, color=color, s=14)
    axes.plot((0, 1.6), (0, 0.6), (0, 0), color="black", linestyle="--")
    axes.set_title("lines through s, points on w = 1;\ndashed: w = 0, a direction", fontsize=8)
    sphere = figure.add_subplot(1, 2, 2, projection="3d")
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 25), np.linspace(0, np.pi / 2, 9))
    sphere.plot_wireframe(np.cos(u) * np.sin(v), np.sin(u) * np.sin(v), np.cos(v), color="#bbbbbb", linewidth=0.4)
    for turn in np.linspace(0, 2 * np.pi, 7)[:-1]:
        point = np.array([np.cos(turn) * 0.7, np.sin(turn) * 0.7, np.sqrt(1 - 0.49)])
        image = divided(vec3(*point))
        sphere.plot(*np.stack([point, (*image, 1)]).T, color=PAPER, linewidth=0.9)
        sphere.scatter(*point, color=OURS, s=10)
        sphere.scatter(*image, 1, color=PAPER, s=10)
    sphere.set_title("points of the unit sphere, divided by w", fontsize=8)
    for part in (axes, sphere):
        part.set_axis_off()
    save(figure, sys.argv[2])


def towards_infinity():
    figure, axes = plt.subplots(figsize=(4.6, 3))
    for w in (4, 2, 1, 0.5):
        x, y = divided(vec3(2, 3, w))
        axes.plot(x, y, "o", color=OURS)
        axes.annotate(f"[2, 3, {w:g}]", (x, y), xytext=(6, -4), textcoords="offset points")
    axes.annotate("", (4.7, 7.05), (4.05, 6.08), arrowprops={"arrowstyle": "->", "color": PAPER})
    axes.annotate("[2, 3, 0]: a direction", (4.7, 7.05), xytext=(-92, 0), textcoords="offset points", color=PAPER)
    axes.plot((0, 4), (0, 6), color=GREY, linewidth=0.7)
    axes.set(xlabel="x/w", ylabel="y/w", xlim=(0, 7), ylim=(0, 7.6))
    save(figure, sys.argv[3])


def perspective():
    figure, parts = plt.subplots(1, 3, figsize=(8.2, 2.6))
    # Figures 4 and 5: a cube before the eye, from the side, and on the screen.
    cube = np.array([(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (1.8, 2.8)]) + (0.2, 0.3, 0)
    edges = [(i, j) for i in range(8) for j in range(i) if np.isclose(np.abs(cube[i] - cube[j]).sum(), 1)]
    images = np.array([divided(lib.ewa_point3_transform(vec4(*point, 1), ctypes.byref(PERSPECTIVE))) for point in cube])
    for i, j in edges:
        parts[0].plot(cube[[i, j], 2], cube[[i, j], 1], color="black", linewidth=0.9)
        parts[1].plot(images[[i, j], 0], images[[i, j], 1], color="black", linewidth=0.9)
    for point, image in zip(cube, images):
        parts[0].plot((0, point[2]), (0, point[1]), color=GREY, linewidth=0.5)
        parts[0].plot(D, image[1] * SY, ".", color=PAPER)
    parts[0].plot((D, D), (-SY, SY), color=OURS)
    parts[0].set(title="figure 5: the side, y' = yD/z", xlabel="z", ylabel="y")
    parts[1].set(title="figure 4: on the screen", xlim=(-1, 1), ylim=(-1, 1), xlabel="x'", ylabel="y'")
    parts[1].set_aspect("equal")
    # Figure 6: the frustum is the box -1..1 of perspective space, taken back.
    back = b.ewa_mat4()
    assert lib.ewa_mat4_invert(ctypes.byref(PERSPECTIVE), ctypes.byref(back)) == 0
    corners = [divided(lib.ewa_point3_transform(vec4(0, y, z, 1), ctypes.byref(back))) for y, z in ((-1, 0), (1, 0), (1, 1), (-1, 1), (-1, 0))]
    corners = np.array(corners)
    parts[2].plot(corners[:, 2], corners[:, 1], color=OURS)
    parts[2].plot((0, F), (0, F * SY), (0, F), (0, -F * SY), color=GREY, linewidth=0.5)
    parts[2].set(title=f"figure 6: the frustum, D {D:g}, F {F:g}", xlabel="z", ylabel="y")
    save(figure, sys.argv[4])


def text(vector):
    return "[" + " ".join(f"{number:.4g}" for number in np.asarray(vector) + 0.0) + "]"


def examples():
    rows = []
    def row(formula, by, result, print_is="as printed"):
        rows.append((formula, f"`{by}`", result, print_is))
    w = weights_of(vec3(3, 3, 1))
    row("weights of (3, 3) in the triangle (1, 1), (7, 2), (3, 6)", "ewa_triangle_barycentric", f"{text(w)}, sum {w.sum():.4g}",
        "wₐ = A_b/… is printed; Aₐ/… holds")
    row("its signed distances to the edges", "ewa_triangle_distances", text(distances_of(vec3(3, 3, 1))))
    for weight in (4, 2, 1, 0.5):
        row(f"[2 3 {weight:g}] on w = 1", "ewa_point2_divide", text(divided(vec3(2, 3, weight))))
    row("[2 3 0] on w = 1", "ewa_point2_divide", "none: EWA_ERROR_NUMERIC" if divided(vec3(2, 3, 0)) is None else "a point")
    conic = b.ewa_conic(xx=3, xy=0.25, xw=-0.5, yy=2, yw=2, ww=-7)
    row("3x² + 2y² + xy/2 − x + 4y − 7 at (1.5, −2.5)", "ewa_conic_value", f"{lib.ewa_conic_value(ctypes.byref(conic), vec3(1.5, -2.5, 1)):.4g}")
    row("the same at [3 −5 2]: w² times as much", "ewa_conic_value", f"{lib.ewa_conic_value(ctypes.byref(conic), vec3(3, -5, 2)):.4g}")
    move = mat(b.ewa_mat3, [[1, 0, 0], [0, 1, 0], [5, -2, 1]])
    row("translation by (5, −2) of (1, 1)", "ewa_point2_transform", text(numbers_of(lib.ewa_point2_transform(vec3(1, 1, 1), ctypes.byref(move)))))
    row("the same of the direction [1 1 0]", "ewa_point2_transform", text(numbers_of(lib.ewa_point2_transform(vec3(1, 1, 0), ctypes.byref(move)))))
    turn = mat(b.ewa_mat3, [[0, -1, 0], [1, 0, 0], [0, 0, 1]])
    row("the printed rotation by 90° of (1, 0)", "ewa_point2_transform", text(numbers_of(lib.ewa_point2_transform(vec3(1, 0, 1), ctypes.byref(turn)))),
        "counter-clockwise is printed; of row vectors it is clockwise")
    meet = b.ewa_vec3()
    assert lib.ewa_line2_meet(vec3(2, -3, 5), vec3(1, 4, -6), ctypes.byref(meet)) == 0
    row("2x − 3y + 5 = 0 and x + 4y − 6 = 0", "ewa_line2_meet", f"{text(numbers_of(meet))} ~ {text(divided(meet))}")
    assert lib.ewa_line2_meet(vec3(2, -3, 5), vec3(2, -3, 9), ctypes.byref(meet)) == 0
    row("2x − 3y + 5 = 0 and 2x − 3y + 9 = 0", "ewa_line2_meet", text(numbers_of(meet)), "[b −a 0] is printed: the same up to d − c")
    for point, name, print_is in (((0, 0, D, 1), "[0 0 D 1]", "as printed"), ((0, 0, F, 1), "[0 0 F 1]", "as printed"), ((0, 0, 1, 0), "[0 0 1 0]", "as printed"),
                        ((0.3, 0.2, D, 1), "[a b D 1], a = 0.3, b = 0.2", "as printed"), ((0.3, 0.2, 0, 0), "[a b 0 0]", "as printed"),
                        ((0.3, 0, 0.5, 0), "[a 0 b 0], b = 0.5", "as printed"), ((0.3, 0.2, 0.5, 0), "[a b c 0], c = 0.5", "w' = 1 is printed, for c ≠ 0: after the division"),
                        ((SX, SY, D, 1), "[Sx Sy D 1]", "as printed"), ((0, 0, 0, 1), "[0 0 0 1]", "as printed")):
        image = lib.ewa_point3_transform(vec4(*point), ctypes.byref(PERSPECTIVE))
        place = divided(image)
        row(f"{name} [P]", "ewa_point3_transform", text(numbers_of(image)) + (" a direction" if place is None else f" ~ {text(place)}"), print_is)
    # The clipping example, with y and z of one's own.
    parts, visible = (b.ewa_segment_part * 2)(), ctypes.c_uint32()
    assert lib.ewa_clip_segment(vec4(2, 0, 1, 2), vec4(-1, 0, 0.2, 0.5), parts, ctypes.byref(visible)) == 0
    row("segment from [2 0 1 2] to [−1 0 0.2 ½]: α of its end on the left plane", "ewa_clip_segment",
        f"{parts[0].alpha[1]:.6f} = 8/9, at {text(numbers_of(parts[0].end[1]))}", "8/3 is printed, with the right end point")
    table(sys.argv[5], ("formula or example", "by", "result", "the print"), rows)


coordinates()
projective_plane()
towards_infinity()
perspective()
examples()
