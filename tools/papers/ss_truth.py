# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""The board of `ewa generate checker` by rays, 16 by 16 in each pixel, averaged in linear light:
ss_truth.py CAMERA.json CHECKS SKY_R,SKY_G,SKY_B TRUTH.png     (SKY: sRGB numbers)"""
import sys

import ewa
import numpy as np

camera, checks = ewa.cameras(sys.argv[1])[0], int(sys.argv[2])

sky = np.array([float(number) for number in sys.argv[3].split(",")])
sky = np.where(sky <= 0.04045, sky / 12.92, ((sky + 0.055) / 1.055) ** 2.4)
width, height = camera.size
steps = (np.arange(16) + 0.5) / 16
picture = np.zeros((height, width, 3))
for i in steps:
    for j in steps:
        x = (np.arange(width) + i - camera.K[0, 2]) / camera.K[0, 0]
        y = (np.arange(height) + j - camera.K[1, 2]) / camera.K[1, 1]
        rays = np.stack([*np.meshgrid(x, y), np.ones((height, width))], -1) @ camera.world_to_camera[:3, :3]
        with np.errstate(divide="ignore"):
            along = -camera.eye[2] / rays[..., 2]
        place = camera.eye[:2] + np.clip(along, 0, 1e6)[..., None] * rays[..., :2]
        square = np.floor((place + 1) / 2 * checks).astype(int).sum(-1) % 2
        hit = (along > 0) & (np.abs(place) <= 1).all(-1)
        picture += np.where(hit[..., None], np.where(square, 0, 1)[..., None], sky) / 256
ewa.save_image(sys.argv[4], picture.astype(np.float32))
