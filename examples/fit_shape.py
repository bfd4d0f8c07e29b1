#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""A shape from twelve pictures: a sphere becomes what they show (docs/gradients.md).

    fit_shape.py TARGET OUT.png [--level 4] [--steps 240] [--side 128] [--film FOLDER]

TARGET is any mesh or cloud. Pictures of it, grey under a red, a green and a blue light that go with the camera, are taken from
twelve sides. An icosphere's corners are
surfels whose normals are those of its triangles and whose radii are as long as its edges. They follow the derivative of the
squared difference of the pictures, by places and by normals, which places make. Each step is smoothed over the triangles,
so that surfels without a derivative of their own go with their neighbours; then corners spread along the surface. Pictures grow
from a quarter to the whole side. OUT.png has, from above: the target, the sphere, what it became, from four of the sides and from
one that no picture was taken from.

Based on: W. Yifan et al., "Differentiable Surface Splatting for Point-based Geometry Processing", 2019 (the task); B. Nicolet
et al., "Large Steps in Inverse Rendering of Geometry", 2021 (smoothed steps).
"""
from __future__ import annotations

import argparse
from typing import Callable

import numpy as np

import ewa

OPTIONS = {"shading": "lambert", "background": "transparent"}
SMOOTHING = 6.0  # of a step: how much neighbours count


def icosphere(level: int) -> tuple[np.ndarray, np.ndarray]:
    """Corners, shape (n, 3), and triangles, shape (m, 3), outward."""
    g = (1 + 5**0.5) / 2
    corners = np.array([(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g), (0, 1, -g),
                        (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)], float)
    faces = np.array([(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6),
                      (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10),
                      (8, 6, 7), (9, 8, 1)])
    for _ in range(level):
        edges = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        unique, where = np.unique(edges, axis=0, return_inverse=True)
        middle = len(corners) + where.reshape(-1, 3)
        corners = np.concatenate([corners, corners[unique].mean(axis=1)])
        a, b, c = faces.T
        ab, bc, ca = middle.T
        faces = np.concatenate([np.stack(t, axis=1) for t in ((a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca))])
    return corners / np.linalg.norm(corners, axis=1, keepdims=True), faces


def smoother(count: int, faces: np.ndarray) -> np.ndarray:
    """(1 + SMOOTHING L)^-1, L the Laplacian of the graph of edges."""
    laplacian = np.zeros((count, count))
    for i, j in ((0, 1), (1, 2), (2, 0)):
        laplacian[faces[:, i], faces[:, j]] = laplacian[faces[:, j], faces[:, i]] = -1
    np.fill_diagonal(laplacian, -laplacian.sum(axis=1))
    return np.linalg.inv(np.eye(count) + SMOOTHING * laplacian)


def spread(corners: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Moves corners along the surface, a quarter of the way to the middle of their neighbours."""
    sums, counts = np.zeros_like(corners), np.zeros((len(corners), 1))
    for i, j in ((0, 1), (1, 2), (2, 0)):
        np.add.at(sums, faces[:, i], corners[faces[:, j]])
        np.add.at(counts, faces[:, i], 1)
    normals, lengths = normals_of(corners, faces)
    way, unit = sums / counts - corners, normals / lengths
    return corners + 0.25 * (way - unit * (way * unit).sum(axis=1, keepdims=True))


def normals_of(corners: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Sums of the normals of triangles, times twice their areas, and the lengths of these sums."""
    a, b, c = (corners[faces[:, k]] for k in range(3))
    sums = np.zeros_like(corners)
    across = np.cross(b - a, c - a)
    for k in range(3):
        np.add.at(sums, faces[:, k], across)
    return sums, np.linalg.norm(sums, axis=1, keepdims=True) + 1e-30


def by_corners(corners: np.ndarray, faces: np.ndarray, by_normals: np.ndarray) -> np.ndarray:
    """What the loss changes per corner by the unit normals that corners make."""
    sums, lengths = normals_of(corners, faces)
    unit = sums / lengths
    by_sums = (by_normals - unit * (by_normals * unit).sum(axis=1, keepdims=True)) / lengths
    a, b, c = (corners[faces[:, k]] for k in range(3))
    by_across = by_sums[faces].sum(axis=1)
    total = np.zeros_like(corners)
    np.add.at(total, faces[:, 1], np.cross(c - a, by_across))
    np.add.at(total, faces[:, 2], np.cross(by_across, b - a))
    np.add.at(total, faces[:, 0], np.cross(by_across, c - b))
    return total


def surfels(corners: np.ndarray, faces: np.ndarray) -> ewa.Cloud:
    sums, lengths = normals_of(corners, faces)
    reach = np.zeros(len(corners))
    for i, j in ((0, 1), (1, 2), (2, 0)):
        edge = np.linalg.norm(corners[faces[:, i]] - corners[faces[:, j]], axis=1)
        np.maximum.at(reach, faces[:, i], edge)
        np.maximum.at(reach, faces[:, j], edge)
    reach = np.minimum(reach, 1.5 * np.median(reach))  # no veil where triangles are drawn out
    return ewa.Cloud(corners.astype(np.float32), normals=(sums / lengths).astype(np.float32), radius=reach.astype(np.float32),
                     colors=np.full((len(corners), 3), 0.7, np.float32))


def lights(camera: ewa.Camera) -> list[np.ndarray]:
    """Red, green and blue, from the viewer's right and left above and from below: each normal has its colour."""
    right, down, ahead = np.asarray(camera.world_to_camera)[:3, :3]
    ways = (right - down - ahead, -right - down - ahead, down - ahead)
    return [np.concatenate([way, color]) for way, color in zip(ways, np.eye(3))]


def draw(cloud: ewa.Cloud, camera: ewa.Camera) -> np.ndarray:
    return ewa.render(cloud.surfels(close_gaps=False), camera, planes="rgba", lights=lights(camera), **OPTIONS).rgba


def chamfer(a: np.ndarray, b: np.ndarray) -> float:
    """Mean of the distances to the nearest point, there and back, of two sets."""
    ways = []
    for p, q in ((a, b), (b, a)):
        nearest = [((part[:, None, :] - q[None]) ** 2).sum(axis=2).min(axis=1) for part in np.array_split(p, len(p) // 200 + 1)]
        ways.append(np.sqrt(np.concatenate(nearest)).mean())
    return float(np.mean(ways))


def run(target: ewa.Cloud, level: int, steps: int, side: int, say: Callable[[str], None],
        film: str | None = None) -> tuple[np.ndarray, list[tuple[int, float, float]]]:
    """Returns the sheet of pictures, linear, and step, loss and Chamfer distance on the way, which `say` hears of, too; the
    target fits the unit sphere. `film`: folder that gets a picture of the target and the shape for every fourth step."""
    place = np.asarray(target["position"], float)
    place = place - (place.max(axis=0) + place.min(axis=0)) / 2
    size = np.linalg.norm(place, axis=1).max()
    place /= size
    true = ewa.Cloud(place.astype(np.float32), normals=target["normal"], colors=np.full((len(place), 3), 0.7, np.float32)).estimate()
    shown = place[np.random.default_rng(1).permutation(len(place))[:6000]]
    corners, faces = icosphere(level)
    corners *= 0.6
    smooth = smoother(len(corners), faces)
    start, log = corners.copy(), []

    def camera(i: float, side: int) -> ewa.Camera:
        angle, up = 2 * np.pi * i / 12, (1.6, -0.9, 0.3)[int(i) % 3]
        return ewa.Camera.look_at((3.2 * np.cos(angle), 3.2 * np.sin(angle), up), (0, 0, 0), size=(side, side), fov=36)

    mean, square, side_now = np.zeros_like(corners), 0.0, 0
    for step in range(steps):
        wanted = side // 4 if step < steps // 4 else side // 2 if step < steps * 5 // 8 else side
        if wanted != side_now:
            side_now, cameras = wanted, [camera(i, wanted) for i in range(12)]
            pictures = [draw(true, c) for c in cameras]
            mean, square = np.zeros_like(corners), 0.0
            begin = step
        cloud, loss, total = surfels(corners, faces), 0.0, np.zeros_like(corners)
        for at, picture in zip(cameras, pictures):
            rest = draw(cloud, at) - picture
            loss += float((rest**2).mean()) / 12
            found = ewa.render_backward(cloud, at, rgba=2 * rest / rest.size, by=("position", "normal"), lights=lights(at),
                                        **OPTIONS)
            total += found.position + by_corners(corners, faces, found.normal)
        if film and step % 4 == 0:
            shot = np.concatenate([draw(c, camera(1.5, side)) for c in (true, cloud)], axis=1)
            ewa.save_image(f"{film}/step_{step // 4:03d}.png", shot[..., :3] + 1 - shot[..., 3:])
        if step % 20 == 0:
            log.append((step, loss, chamfer(surfels(corners, faces)["position"], shown)))
            say(f"step {step}: {side_now} pixels, loss {loss:.5f}, Chamfer distance {log[-1][2]:.5f}")
        total = smooth @ total
        mean = 0.9 * mean + 0.1 * total
        square = 0.99 * square + 0.01 * float((total**2).sum(axis=1).max())  # one for all: directions stay
        turn = step - begin + 1
        rate = 0.03 * 0.2 ** (step / steps)
        corners = spread(corners - rate * (mean / (1 - 0.9**turn)) / np.sqrt(square / (1 - 0.99**turn)), faces)
    log.append((steps, loss, chamfer(surfels(corners, faces)["position"], shown)))
    say(f"step {steps}: loss {loss:.5f}, Chamfer distance {log[-1][2]:.5f}")
    sides = [camera(i, side) for i in (0, 3, 5, 10)] + [camera(1.5, side)]
    rows = [[draw(c, at) for at in sides] for c in (true, surfels(start, faces), surfels(corners, faces))]
    return np.concatenate([np.concatenate(row, axis=1) for row in rows], axis=0), log


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("target")
    parser.add_argument("out")
    parser.add_argument("--level", type=int, default=4, help="of the icosphere: 10 * 4^level + 2 surfels")
    parser.add_argument("--steps", type=int, default=240, help="1 or more")
    parser.add_argument("--side", type=int, default=128)
    parser.add_argument("--film", help="folder for a picture of every fourth step")
    arguments = parser.parse_args()
    if arguments.steps < 1:
        parser.error(f"--steps is {arguments.steps}; 1 or more are needed")
    read = ewa.read(arguments.target)
    target = read if isinstance(read, ewa.Cloud) else ewa.sample(arguments.target, point_count=8000)
    sheet, _ = run(target, arguments.level, arguments.steps, arguments.side, lambda line: print(line, flush=True),
                   arguments.film)
    ewa.save_image(arguments.out, sheet)


if __name__ == "__main__":
    main()
