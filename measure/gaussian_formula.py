# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Trained Gaussians by the formula they were trained with, in double precision, with numpy alone; and how far pictures of ewa
in both orders are from it.

    gaussian_formula.py FILE=AZIMUTH,... ...

Based on: B. Kerbl, G. Kopanas, T. Leimkuehler, G. Drettakis, "3D Gaussian Splatting for Real-Time Radiance Field Rendering",
2023, and its program: the order, the limits and the end of a pixel are that program's, but for its tiles.
"""
from __future__ import annotations

import sys
from typing import Any

import numpy as np

NEAR, WIDER, FILTER_PX2, MAX_ALPHA, MIN_ALPHA, LEAST_LIGHT = 0.2, 1.3, 0.3, 0.99, 1 / 255, 1e-4


def harmonics(d: Any) -> Any:
    """The 16 values along unit directions, shape (N, 16)."""
    x, y, z = d.T
    xx, yy, zz = x * x, y * y, z * z
    return np.stack([
        np.full(len(d), 0.28209479177387814),
        -0.4886025119029199 * y, 0.4886025119029199 * z, -0.4886025119029199 * x,
        1.0925484305920792 * x * y, -1.0925484305920792 * y * z, 0.31539156525252005 * (2 * zz - xx - yy),
        -1.0925484305920792 * x * z, 0.5462742152960396 * (xx - yy),
        -0.5900435899266435 * y * (3 * xx - yy), 2.890611442640554 * x * y * z,
        -0.4570457994644658 * y * (4 * zz - xx - yy), 0.3731763325901154 * z * (2 * zz - 3 * xx - 3 * yy),
        -0.4570457994644658 * x * (4 * zz - xx - yy), 1.445305721320277 * z * (xx - yy),
        -0.5900435899266435 * x * (xx - 3 * yy)], axis=1)


def rotations(q: Any) -> Any:
    """Matrices of unit quaternions w x y z, shape (N, 3, 3)."""
    w, x, y, z = (q / np.linalg.norm(q, axis=1, keepdims=True)).T
    return np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
                     2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                     2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], axis=1).reshape(-1, 3, 3)


def draw(gaussians: Any, camera: Any, near: float = NEAR) -> Any:
    """What a set of Gaussians (ewa.Gaussians) shows over black, display values and alpha, shape (height, width, 4)."""
    width, height = camera.size
    fx, fy, cx, cy = camera.K[0, 0], camera.K[1, 1], camera.K[0, 2], camera.K[1, 2]
    turn, move = camera.world_to_camera[:3, :3], camera.world_to_camera[:3, 3]
    centers = np.asarray(gaussians.centers, float) + gaussians.origin
    t = centers @ turn.T + move
    opacity = np.asarray(gaussians.opacities, float)
    order = np.argsort(t[:, 2], kind="stable")
    order = order[(t[order, 2] > near) & (opacity[order] >= MIN_ALPHA)]
    t, centers, opacity = t[order], centers[order], opacity[order]
    axes = turn @ rotations(np.asarray(gaussians.rotations, float)[order]) * np.asarray(gaussians.scales, float)[order][:, None, :]
    limit_x, limit_y = WIDER * width / 2 / fx, WIDER * height / 2 / fy
    slope_x, slope_y = np.clip(t[:, 0] / t[:, 2], -limit_x, limit_x), np.clip(t[:, 1] / t[:, 2], -limit_y, limit_y)
    down = fx / t[:, 2, None] * (axes[:, 0] - slope_x[:, None] * axes[:, 2])
    right = fy / t[:, 2, None] * (axes[:, 1] - slope_y[:, None] * axes[:, 2])
    a, b, c = ((down * down).sum(1) + FILTER_PX2, (down * right).sum(1), (right * right).sum(1) + FILTER_PX2)
    area = a * c - b * b
    u, v = fx * t[:, 0] / t[:, 2] + cx - 0.5, fy * t[:, 1] / t[:, 2] + cy - 0.5
    eye = -turn.T @ move
    away = centers - eye
    coefficients = np.asarray(gaussians.harmonics, float)[order]
    basis = harmonics(away / np.linalg.norm(away, axis=1, keepdims=True))[:, :coefficients.shape[1]]
    colors = np.maximum(0.5 + np.einsum("nk,nkc->nc", basis, coefficients), 0)
    reach = 2 * np.log(opacity / MIN_ALPHA)  # of the squared distance where alpha falls to the least one
    side, rise = np.sqrt(reach * a), np.sqrt(reach * c)
    low_x, high_x = np.clip(np.ceil(u - side), 0, width).astype(int), np.clip(np.floor(u + side) + 1, 0, width).astype(int)
    low_y, high_y = np.clip(np.ceil(v - rise), 0, height).astype(int), np.clip(np.floor(v + rise) + 1, 0, height).astype(int)
    light, through, columns, rows = np.zeros((height, width, 3)), np.ones((height, width)), np.arange(width), np.arange(height)
    done = np.zeros((height, width), bool)
    for i in np.flatnonzero((low_x < high_x) & (low_y < high_y)):
        at = np.s_[low_y[i]:high_y[i], low_x[i]:high_x[i]]
        dx, dy = columns[at[1]] - u[i], (rows[at[0]] - v[i])[:, None]
        alpha = np.minimum(opacity[i] * np.exp(-(c[i] * dx * dx - 2 * b[i] * dx * dy + a[i] * dy * dy) / (2 * area[i])), MAX_ALPHA)
        alpha[(alpha < MIN_ALPHA) | done[at]] = 0
        rest = through[at] * (1 - alpha)
        alpha[rest < LEAST_LIGHT] = 0  # a pixel ends before what would leave less
        done[at] |= rest < LEAST_LIGHT
        light[at] += (through[at] * alpha)[..., None] * colors[i]
        through[at] *= 1 - alpha
    return np.dstack([light, 1 - through])


def display(image: Any) -> Any:
    """The same of a picture of ewa's with linear premultiplied colours over nothing."""
    rgba = np.asarray(image.rgba, float)
    alpha = rgba[..., 3:]
    straight = np.divide(rgba[..., :3], alpha, out=np.zeros_like(rgba[..., :3]), where=alpha > 0)
    curve = np.where(straight <= 0.0031308, 12.92 * straight, 1.055 * np.maximum(straight, 0.0031308) ** (1 / 2.4) - 0.055)
    return np.dstack([curve * alpha, alpha[..., 0]])


def decibels(a: Any, b: Any) -> float:
    """Between two pictures over black, display values of which a screen shows up to 1."""
    return float(-10 * np.log10(((np.minimum(a[..., :3], 1) - np.minimum(b[..., :3], 1)) ** 2).mean() + 1e-30))


def main() -> None:
    import ewa
    print("| file, azimuth | by centres, dB | by rays, dB |\n|---|---:|---:|")
    for argument in sys.argv[1:]:
        path, azimuths = argument.rsplit("=", 1)
        gaussians = ewa.read_gaussians(path)
        splats = ewa.Splats(gaussians)
        for azimuth in azimuths.split(","):
            camera = ewa.Camera.frame(splats, azimuth=float(azimuth), size=(400, 400))
            truth = draw(gaussians, camera)
            pictures = {order: ewa.render_gaussians(splats, camera, order=order, near_world=NEAR, planes=("rgba",),
                                                    background="transparent") for order in ("centre", "ray")}
            measured = [f"{decibels(display(picture), truth):.1f}" for picture in pictures.values()]
            print(f"| {path.rsplit('/', 1)[-1]}, {azimuth}° | {' | '.join(measured)} |", flush=True)


if __name__ == "__main__":
    main()
