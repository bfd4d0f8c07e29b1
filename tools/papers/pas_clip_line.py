# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Figure 4 of PAS: from two centres and normals to a clip line (docs/math.md section 5); writes the two surfels as PLY
files without and with the line: pas_clip_line.py ROUND.ply CLIPPED.ply NAME.table"""
import sys

import numpy as np
from style import table

SIGMA = 0.34
centers = np.array([[-0.5, 0, 0.12], [0.42, 0.1, 0.0]])
normals = np.array([[-0.45, -0.1, 0.9], [0.55, 0.05, 0.8]])
normals /= np.linalg.norm(normals, axis=1)[:, None]
surfels, rows = [], []
for k in (0, 1):
    u = np.cross(normals[k], [0, 1, 0])
    u *= SIGMA / np.linalg.norm(u)
    v = np.cross(normals[k], u)
    # The other plane on this one's points p + u tu + v tv: a u + b v + c, kept where it is behind that plane.
    other, there = normals[1 - k], centers[k] - centers[1 - k]
    clip = -np.array([other @ u, other @ v, other @ there])
    surfels.append((*centers[k], *normals[k], *u, *v, *clip))
    rows.append((f"{k + 1}", *(", ".join(f"{number:.3f}" for number in part) for part in (centers[k], normals[k], clip / np.hypot(*clip[:2])))))


def write(path, with_clip):
    names = "x y z nx ny nz tu_x tu_y tu_z tv_x tv_y tv_z clip0_a clip0_b clip0_c".split()
    colors = ("200 120 40", "60 110 190")
    with open(path, "w") as file:
        kept = names if with_clip else names[:12]
        file.write("ply\nformat ascii 1.0\nelement vertex 2\n" + "".join(f"property float {name}\n" for name in kept))
        file.write("property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n")
        for surfel, color in zip(surfels, colors):
            file.write(" ".join(f"{number:.9g}" for number in surfel[:len(kept)]) + f" {color}\n")


write(sys.argv[1], False)
write(sys.argv[2], True)
table(sys.argv[3], ("surfel", "centre", "normal", "line a u + b v + c ≥ 0, (a, b) of length 1"), rows)
