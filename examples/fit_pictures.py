#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Colours, and the pose of a camera, from pictures: what ewa.render_backward() is for (docs/gradients.md).

    fit_pictures.py OUT.png [--points 20000] [--side 192] [--views 9]

A torus with a pattern is drawn from all around. From these pictures, and from the points without their colours, the
colours are found by conjugate gradients, since a picture is linear in them. One more picture was taken by a camera of
which only a guess is known, 2 degrees and a twelfth of its distance off: its pose is found by following the derivative.
OUT.png has, from above: the pictures, what the start showed, what was found. The first columns are views that colours
were found from, the last but one the camera that was off, the last a view that nothing was found from.
"""
from __future__ import annotations

import argparse

import numpy as np

import ewa

OPTIONS = {"shading": "none", "background": "transparent"}


def pattern(position: np.ndarray) -> np.ndarray:
    """Colours of the true points: rings and stripes."""
    angle = np.arctan2(position[:, 1], position[:, 0])
    stripes, rings = np.sin(9 * angle) > 0, np.sin(14 * position[:, 2] + 4 * angle)
    color = np.stack([0.15 + 0.7 * stripes, 0.5 + 0.4 * rings, 0.8 - 0.6 * stripes * (rings > 0)], axis=1)
    return color.astype(np.float32)


def with_colors(points: ewa.Cloud, color: np.ndarray) -> ewa.Cloud:
    return ewa.Cloud(points["position"], normals=points["normal"], radius=points["radius"],
                     colors=np.ascontiguousarray(color, np.float32))


def draw(cloud: ewa.Cloud, camera: ewa.Camera) -> np.ndarray:
    image = ewa.render(cloud.surfels(close_gaps=False), camera, planes="rgba", **OPTIONS)
    return image.rgba


def moved(camera: ewa.Camera, turn: np.ndarray, way: np.ndarray) -> ewa.Camera:
    """The camera whose space is turned by a rotation vector and moved."""
    angle = float(np.linalg.norm(turn))
    x, y, z = turn / angle if angle else turn
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    rotation = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    matrix = np.array(camera.world_to_camera)
    matrix[:3] = rotation @ matrix[:3]
    matrix[:3, 3] += way
    return ewa.Camera(camera.K, matrix, camera.size)


def fit_colors(points: ewa.Cloud, cameras: list[ewa.Camera], pictures: list[np.ndarray], steps: int) -> np.ndarray:
    """min sum |A c - picture|^2 + ridge |c - grey|^2 by conjugate gradients; A c draws, its transpose is the derivative."""
    grey = np.full((len(points), 3), 0.5, np.float32)

    def transposed(residuals: list[np.ndarray]) -> np.ndarray:
        total = np.zeros((len(points), 3))
        for camera, residual in zip(cameras, residuals):
            plane = np.concatenate([residual, np.zeros_like(residual[..., :1])], axis=2)  # alpha has no say
            total += ewa.render_backward(points, camera, rgba=plane, by="color", **OPTIONS).color
        return total

    def product(color: np.ndarray) -> np.ndarray:
        return transposed([draw(with_colors(points, color), camera)[..., :3] for camera in cameras]) + ridge * color

    ridge = 0.1 * float(np.median(transposed([np.ones(picture.shape[:2] + (3,), np.float32) for picture in pictures])))
    color = grey.astype(np.float64)
    residual = transposed([picture[..., :3] - draw(with_colors(points, grey), camera)[..., :3]
                           for camera, picture in zip(cameras, pictures)])
    direction, size = residual.copy(), float((residual**2).sum())
    for _ in range(steps):
        image = product(direction)
        step = size / float((direction * image).sum())
        color += step * direction
        residual -= step * image
        before, size = size, float((residual**2).sum())
        direction = residual + size / before * direction
    return color


def fit_pose(cloud: ewa.Cloud, camera: ewa.Camera, picture: np.ndarray, steps: int) -> ewa.Camera:
    """Follows the derivative of the squared difference by six numbers (Adam): a turn about the world's origin, where the
    points are, so that it moves them no more than a shift does, and a shift, both of camera space."""
    mean, square = np.zeros(6), np.zeros(6)
    for step in range(1, steps + 1):
        gradient = ewa.render_backward(cloud, camera, rgba=2 * (draw(cloud, camera) - picture), by="camera",
                                       **OPTIONS).camera
        assert gradient is not None
        origin = np.asarray(camera.world_to_camera)[:3, 3]
        turn = gradient.rotation - np.cross(origin, gradient.translation)
        numbers = np.concatenate([turn, gradient.translation])
        mean, square = 0.8 * mean + 0.2 * numbers, 0.95 * square + 0.05 * numbers**2
        rate = 0.04 * 0.5 ** (7 * step / steps)
        change = -rate * (mean / (1 - 0.8**step)) / (np.sqrt(square / (1 - 0.95**step)) + 1e-12)
        camera = moved(camera, change[:3], change[3:] - np.cross(change[:3], origin))
    return camera


def psnr(a: np.ndarray, b: np.ndarray) -> float:
    return float(-10 * np.log10(np.mean((a - b) ** 2)))


def distance(a: ewa.Camera, b: ewa.Camera) -> tuple[float, float]:
    """How far two cameras are from each other: degrees, world units."""
    turn = np.asarray(a.world_to_camera)[:3, :3] @ np.asarray(b.world_to_camera)[:3, :3].T
    angle = float(np.degrees(np.arccos(np.clip((np.trace(turn) - 1) / 2, -1, 1))))
    return angle, float(np.linalg.norm(a.eye - b.eye))


def run(points: int, side: int, views: int, steps: int = 12, pose_steps: int = 120) -> tuple[np.ndarray, dict[str, float]]:
    """Returns the sheet of pictures, linear, and what was reached."""
    true = ewa.generate("torus", points)
    true = with_colors(true, pattern(np.asarray(true["position"])))
    angles = 2 * np.pi * np.arange(views) / views
    cameras = [ewa.Camera.look_at((4 * np.cos(a), 4 * np.sin(a), 2.5 * np.cos(3.2 * a)), (0, 0, 0),
                                  size=(side, side * 3 // 4), fov=26) for a in angles]
    pictures = [draw(true, camera) for camera in cameras]
    known, off, held = list(range(views - 2)), views - 2, views - 1
    grey = with_colors(true, np.full((len(true), 3), 0.5))
    guess = moved(cameras[off], np.radians([1.2, -1.4, 0.8]), np.array([0.15, -0.1, 0.3]))
    found = with_colors(true, fit_colors(grey, [cameras[i] for i in known], [pictures[i] for i in known], steps))
    pose = fit_pose(found, guess, pictures[off], pose_steps)
    shown = known[:2] + [off, held]
    start = [draw(grey, guess if i == off else cameras[i]) for i in shown]
    ends = [draw(found, pose if i == off else cameras[i]) for i in shown]
    sheet = np.concatenate([np.concatenate(row, axis=1) for row in ([pictures[i] for i in shown], start, ends)], axis=0)
    before, after = distance(guess, cameras[off]), distance(pose, cameras[off])
    return sheet, {"held_out_before_db": psnr(start[3], pictures[held]), "held_out_db": psnr(ends[3], pictures[held]),
                   "off_before_deg": before[0], "off_deg": after[0], "off_before_world": before[1], "off_world": after[1],
                   "pose_before_db": psnr(draw(found, guess), pictures[off]), "pose_db": psnr(ends[2], pictures[off])}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out")
    parser.add_argument("--points", type=int, default=20000)
    parser.add_argument("--side", type=int, default=192)
    parser.add_argument("--views", type=int, default=13)
    arguments = parser.parse_args()
    sheet, reached = run(arguments.points, arguments.side, arguments.views)
    ewa.save_image(arguments.out, sheet)
    for name, value in reached.items():
        print(f"{name} {value:.3f}")


if __name__ == "__main__":
    main()
