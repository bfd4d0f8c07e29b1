# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Trained Gaussians by the formula they were trained with, in double precision, with numpy alone; and how far pictures of ewa
in both orders are from it.

    gaussian_formula.py FILE=AZIMUTH,... ...

Based on: B. Kerbl, G. Kopanas, T. Leimkuehler, G. Drettakis, "3D Gaussian Splatting for Real-Time Radiance Field Rendering",
2023, and its program: the order, the limits and the end of a pixel are that program's, but for its tiles; B. Huang, Z. Yu,
A. Chen, A. Geiger, S. Gao, "2D Gaussian Splatting for Geometrically Accurate Radiance Fields", 2024, equations 8 to 11.
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
    if gaussians.flat:
        boxes, alpha_of = flat_alphas(axes, t, camera, opacity, near)
    else:
        boxes, alpha_of = alphas(axes, t, camera, opacity)
    eye = -turn.T @ move
    away = centers - eye
    coefficients = np.asarray(gaussians.harmonics, float)[order]
    basis = harmonics(away / np.linalg.norm(away, axis=1, keepdims=True))[:, :coefficients.shape[1]]
    colors = np.maximum(0.5 + np.einsum("nk,nkc->nc", basis, coefficients), 0)
    low_x, low_y = (np.clip(np.ceil(boxes[:, k]), 0, (width, height)[k]).astype(int) for k in range(2))
    high_x, high_y = (np.clip(np.floor(boxes[:, 2 + k]) + 1, 0, (width, height)[k]).astype(int) for k in range(2))
    light, through, columns, rows = np.zeros((height, width, 3)), np.ones((height, width)), np.arange(width), np.arange(height)
    done = np.zeros((height, width), bool)
    for i in np.flatnonzero((low_x < high_x) & (low_y < high_y)):
        at = np.s_[low_y[i]:high_y[i], low_x[i]:high_x[i]]
        alpha = np.minimum(alpha_of(i, columns[at[1]], rows[at[0]][:, None]), MAX_ALPHA)
        alpha[(alpha < MIN_ALPHA) | done[at]] = 0
        rest = through[at] * (1 - alpha)
        alpha[rest < LEAST_LIGHT] = 0  # a pixel ends before what would leave less
        done[at] |= rest < LEAST_LIGHT
        light[at] += (through[at] * alpha)[..., None] * colors[i]
        through[at] *= 1 - alpha
    return np.dstack([light, 1 - through])


def alphas(axes: Any, t: Any, camera: Any, opacity: Any) -> Any:
    """Boxes in pixels, left top right bottom, and what gives the alphas of number i at pixels (x, y): 3DGS."""
    width, height = camera.size
    fx, fy, cx, cy = camera.K[0, 0], camera.K[1, 1], camera.K[0, 2], camera.K[1, 2]
    limit_x, limit_y = WIDER * width / 2 / fx, WIDER * height / 2 / fy
    slope_x, slope_y = np.clip(t[:, 0] / t[:, 2], -limit_x, limit_x), np.clip(t[:, 1] / t[:, 2], -limit_y, limit_y)
    down = fx / t[:, 2, None] * (axes[:, 0] - slope_x[:, None] * axes[:, 2])
    right = fy / t[:, 2, None] * (axes[:, 1] - slope_y[:, None] * axes[:, 2])
    a, b, c = ((down * down).sum(1) + FILTER_PX2, (down * right).sum(1), (right * right).sum(1) + FILTER_PX2)
    area = a * c - b * b
    u, v = fx * t[:, 0] / t[:, 2] + cx - 0.5, fy * t[:, 1] / t[:, 2] + cy - 0.5
    reach = 2 * np.log(opacity / MIN_ALPHA)  # of the squared distance where alpha falls to the least one
    side, rise = np.sqrt(reach * a), np.sqrt(reach * c)

    def alpha_of(i: int, x: Any, y: Any) -> Any:
        dx, dy = x - u[i], y - v[i]
        return opacity[i] * np.exp(-(c[i] * dx * dx - 2 * b[i] * dx * dy + a[i] * dy * dy) / (2 * area[i]))
    return np.stack([u - side, v - rise, u + side, v + rise], axis=1), alpha_of


def flat_alphas(axes: Any, t: Any, camera: Any, opacity: Any, near: float) -> Any:
    """The same of 2DGS: where rays cross them, and at least a dot about the middle of 3 standard deviations."""
    pixels = camera.K.copy()
    pixels[:2, 2] -= 0.5  # of whole numbers
    corners = np.stack([axes[:, :, 0], axes[:, :, 1], t], axis=2)  # columns: what (u, v, 1) is of
    matrix = pixels @ corners
    rows = matrix[:, 0], matrix[:, 1], matrix[:, 2]
    boxes, middle = np.empty((len(t), 4)), np.empty((len(t), 2))
    for reach in (np.full(len(t), 9.0), 2 * np.log(opacity / MIN_ALPHA)):
        weights = np.stack([reach, reach, np.full(len(t), -1.0)], axis=1)
        scale = (weights * rows[2] ** 2).sum(1)
        for k in range(2):
            at = (weights * rows[k] * rows[2]).sum(1) / scale
            side = np.sqrt(np.maximum(at ** 2 - (weights * rows[k] ** 2).sum(1) / scale, 0)) + np.sqrt(reach)
            crossing = scale >= 0  # the plane of the eye
            if reach[0] == 9 and (reach == 9).all():
                middle[:, k] = np.where(crossing, np.nan, at)
            else:
                off = np.abs(np.nan_to_num(middle[:, k] - at))
                boxes[:, k] = np.where(crossing, -np.inf, at - side - off)
                boxes[:, 2 + k] = np.where(crossing, np.inf, at + side + off)

    def alpha_of(i: int, x: Any, y: Any) -> Any:
        k = x[..., None] * rows[2][i] - rows[0][i]
        m = y[..., None] * rows[2][i] - rows[1][i]
        p = np.cross(*np.broadcast_arrays(k, m))
        with np.errstate(divide="ignore", invalid="ignore"):
            u, v = p[..., 0] / p[..., 2], p[..., 1] / p[..., 2]
            crossed = np.nan_to_num(u * u + v * v, nan=np.inf)
            depth = u * rows[2][i][0] + v * rows[2][i][1] + rows[2][i][2]
        crossed = np.where(depth < near, np.inf, crossed)
        dot = np.nan_to_num(2 * ((x - middle[i, 0]) ** 2 + (y - middle[i, 1]) ** 2), nan=np.inf)
        return opacity[i] * np.exp(-np.minimum(crossed, dot) / 2)
    return np.clip(boxes, -1e6, 1e6), alpha_of


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
