# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Section 6 of PAS: which splats does a threshold on the condition number of M discard? pas_condition.py GRAPH.svg NAME.table"""
import sys

import ewa
import numpy as np
from style import OURS, PAPER, QUICK, plt, save, table

CUTOFF = 3
cloud = ewa.generate("torus", 2000 if QUICK else 20000)
position, normal, radius = np.asarray(cloud["position"], float), np.asarray(cloud["normal"], float), np.asarray(cloud["radius"], float)
across = np.cross(normal, np.where(np.abs(normal[:, :1]) < 0.7, [[1, 0, 0]], [[0, 1, 0]]))
across *= (radius / CUTOFF / np.linalg.norm(across, axis=1))[:, None]
along = np.cross(normal, across)
figure, axes = plt.subplots(figsize=(5.2, 2.8))
rows = []
for name, eye, color in (("from 4 away", (0, -3.46, 2), OURS), ("from the ring's hole", (0, 0, 0.1), PAPER)):
    camera = ewa.Camera.look_at(eye, (0, 1, 0), (0, 0, 1), fov=60, size=(512, 512))
    turn, shift = camera.world_to_camera[:3, :3], camera.world_to_camera[:3, 3]
    matrices = np.stack([across @ turn.T, along @ turn.T, position @ turn.T + shift], 1)
    depth, reach = matrices[:, 2, 2], CUTOFF ** 2 * (matrices[:, :2, 2] ** 2).sum(1)
    ahead = depth > 0
    condition = np.linalg.cond(matrices[ahead])
    # The same with the axes in units of the distance: what is left is how flatly the disc is seen.
    scaled = matrices[ahead]
    scaled[:, :2] *= (np.linalg.norm(scaled[:, 2], axis=1) / np.linalg.norm(scaled[:, 0], axis=1))[:, None, None]
    flat = np.linalg.cond(scaled)
    for numbers, style, what in ((condition, "-", "M"), (flat, "--", "axes as long as p")):
        axes.loglog(np.sort(numbers)[::-1], (np.arange(len(numbers)) + 1) / len(numbers), style, color=color, label=f"{name}, {what}")
    conics = int(((depth ** 2 <= reach) & ahead).sum())
    for threshold in (1e2, 1e3, 1e4):
        rows.append((name, f"{ahead.sum():,}", f"{threshold:g}", f"{(condition > threshold).sum():,}", f"{(flat > threshold).sum():,}", conics))
axes.set(xlabel="threshold of the condition number", ylabel="share that it discards", ylim=(1e-5, 1.5), xlim=(1, 1e6))
axes.legend()
save(figure, sys.argv[1])
table(sys.argv[2], ("view", "splats ahead", "threshold", "discarded by cond(M)", "with axes as long as p", "no ellipses"), rows)
