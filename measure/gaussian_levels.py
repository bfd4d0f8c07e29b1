# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""How near levels of large sets of Gaussians are to what there is to see.

    gaussian_levels.py WIDTH FILE ...

Pictures that are three quarters as high as wide, of all Gaussians and within 1, 2 and 4 pixels of these, against the averages of pictures of
all that are four times as fine: decibels of display values.
"""
import sys

import ewa
import numpy as np
from gaussian_formula import display

FINER = 4


def picture(splats, camera, merge_px):
    return display(ewa.render_gaussians(splats, camera, merge_px=merge_px, planes=("rgba",), background=(0.03, 0.03, 0.03, 1)))


width = int(sys.argv[1])
print("| file | within, px | dB |\n|---|---:|---:|")
for path in sys.argv[2:]:
    splats = ewa.Splats(ewa.read_gaussians(path), levels=True)
    size = (width, 3 * width // 4)
    camera = ewa.Camera.frame(splats, size=size)
    fine = picture(splats, camera.resized(FINER * size[0], FINER * size[1]), 0)
    truth = fine.reshape(size[1], FINER, size[0], FINER, -1).mean((1, 3))
    for merge_px in (0, 1, 2, 4):
        error = ((picture(splats, camera, merge_px) - truth) ** 2).mean()
        print(f"| {path.rsplit('/', 1)[-1]} | {merge_px} | {-10 * np.log10(error):.1f} |")
