# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Figures 3 and 7 of PAS in numbers: pixels inside of a surface that no splat reaches, over the angle at which it is seen
and how far it lies off the axis of the view: pas_holes.py plane|torus GRAPH.svg NAME.table

The plane is of discs that just touch (support to the corners of a square grid's cells); what is inside is told by its own
rays. Of the torus, a hole shows what lies behind the surface that 16 times as many points have there, silhouettes left out.
No pixel filter."""
import sys

import ewa
import numpy as np
from style import QUICK, plt, save, table

SIDE_PX, FOV_DEG = 192, 100
ANGLES_DEG = (2, 5, 10, 20, 40, 80)   # of the line of sight to the middle of the surface, above it
SHIFTS_DEG = (0, 10, 20, 30, 40)      # of that line from the axis of the view, to the left


def camera_of(angle_deg, shift_deg, target, distance):
    angle, shift = np.radians([angle_deg, shift_deg])
    ahead, right = np.array([0, np.cos(angle), -np.sin(angle)]), np.array([1.0, 0, 0])
    eye = target - distance * ahead
    return ewa.Camera.look_at(eye, eye + np.cos(shift) * ahead + np.sin(shift) * right, (0, 0, 1), fov=FOV_DEG,
                              size=(SIDE_PX, SIDE_PX))


def square_mask(camera):
    """Pixels whose four corners see the square of edge 2 in the plane z = 0."""
    corners = np.arange(SIDE_PX + 1)
    x = (corners - camera.K[0, 2]) / camera.K[0, 0]
    y = (corners - camera.K[1, 2]) / camera.K[1, 1]
    rays = np.stack([*np.meshgrid(x, y), np.ones((SIDE_PX + 1,) * 2)], -1) @ camera.world_to_camera[:3, :3]
    with np.errstate(divide="ignore", invalid="ignore"):
        along = -camera.eye[2] / rays[..., 2]
        place = camera.eye[:2] + along[..., None] * rays[..., :2]
    hit = (along > 0) & (np.abs(place) <= 1).all(-1)
    return hit[1:, 1:] & hit[1:, :-1] & hit[:-1, 1:] & hit[:-1, :-1]


def shrunk(mask, pixels):
    for _ in range(pixels):
        inner = mask.copy()
        inner[1:] &= mask[:-1]
        inner[:-1] &= mask[1:]
        inner[:, 1:] &= mask[:, :-1]
        inner[:, :-1] &= mask[:, 1:]
        mask = inner
    return mask


def depth_of(surfels, camera, kernel):
    return ewa.render(surfels, camera, planes="depth", kernel=kernel, prefilter_px=0, edge_antialiasing=False).depth


def main():
    if sys.argv[1] == "plane":
        target, distance, behind = np.zeros(3), 0.35, np.inf
        surfels = ewa.generate("plane", 48 * 48, jitter=0, radius_scale=0.5 ** 0.5 * 1.0001).surfels(close_gaps=False)
        truth = None
    else:
        # The top of the ring, of a tube of radius 0.285; what shows through a hole is at least that far behind.
        target, distance, behind = np.array([0, -0.715, 0.285]), 0.15, 0.15
        surfels = ewa.generate("torus", 1500, jitter=0, radius_scale=0.72).surfels(close_gaps=False)
        truth = ewa.generate("torus", 24000, jitter=0).surfels()
    shares, rows = {}, []
    for kernel in ("affine", "perspective"):
        holes = np.zeros((len(ANGLES_DEG), len(SHIFTS_DEG)))
        pixels = np.zeros_like(holes)
        for i, angle in enumerate(ANGLES_DEG):
            for j, shift in enumerate(SHIFTS_DEG):
                camera = camera_of(angle, shift, target, distance)
                depth = depth_of(surfels, camera, kernel)
                if truth is None:
                    mask, open_ = square_mask(camera), np.isinf(depth)
                else:
                    true_depth = depth_of(truth, camera, "perspective")
                    mask = shrunk(np.isfinite(true_depth), 2)
                    with np.errstate(invalid="ignore"):
                        open_ = ~(depth < true_depth + behind)
                    # At the rim of the ring the truth itself jumps.
                    mask &= shrunk(np.abs(np.gradient(np.where(np.isinf(true_depth), 9, true_depth))).max(0) < behind, 2)
                pixels[i, j], holes[i, j] = mask.sum(), (mask & open_).sum()
        shares[kernel] = holes, pixels
        rows.append((kernel, f"{int(holes.sum()):,}", f"{int(pixels.sum()):,}", f"{int((holes > 0).sum())} of {holes.size}"))
    figure, axes = plt.subplots(1, 2, figsize=(7, 2.9), sharey=True)
    for part, (kernel, (holes, pixels)) in zip(axes, shares.items()):
        percent = 100 * holes / np.maximum(pixels, 1)
        part.imshow(percent, cmap="Reds", vmin=0, vmax=max(1, (100 * shares["affine"][0] / np.maximum(pixels, 1)).max()),
                    aspect="auto")
        part.grid(False)
        for i, j in np.ndindex(holes.shape):
            part.text(j, i, f"{int(holes[i, j])}", ha="center", va="center", fontsize=7,
                      color="white" if percent[i, j] > 0.6 * part.images[0].get_clim()[1] else "black")
        part.set(title={"affine": "affine map (Heckbert, SS)", "perspective": "the conic (PAS)"}[kernel],
                 xlabel="shift off the axis, degrees", xticks=range(len(SHIFTS_DEG)), yticks=range(len(ANGLES_DEG)))
        part.set_xticklabels(SHIFTS_DEG)
        part.set_yticklabels(ANGLES_DEG)
    axes[0].set_ylabel("angle of view, degrees")
    save(figure, sys.argv[2])
    table(sys.argv[3], ("kernel", "holes, pixels", "pixels inside", "views with a hole"), rows)


main()
