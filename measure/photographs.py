# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""The table of real photographs in docs/photos.md: photographs and cameras of an OpenMVS scene for `ewa photos`, MeshLab and texrecon,
and how like what these make of them is to photographs that they did not get.

    photographs.py prepare scene.mvs FOLDER         the images lie beside the scene
    photographs.py compare FOLDER NAME=POINTS ...   points, or a mesh as points, in the colours that NAME gives

Needs ewa and numpy.
"""
from __future__ import annotations

import json
import pathlib
import struct
import sys
from typing import Any

import numpy as np

import ewa

REDUCED = 4  # pixels on a side that become one
ORDER = (3, 0, 1, 2, 4, 6, 5, 7, 8, 9)  # of the photographs; --hold-out 5 leaves out the first and the sixth
HELD_OUT = (0, 5)
ROBUST, FAR, FILLED = 0.05, 0.15, 0.99  # in sRGB numbers; of alpha


class Scene:
    """Cameras of OpenMVS's interface files (MVSI), versions 1 to 6."""

    def __init__(self, path: pathlib.Path) -> None:
        self.data, self.at = path.read_bytes(), 8
        self.version = struct.unpack_from("<4sI", self.data)[1]
        self.at += 4
        platforms = [self.platform() for _ in range(self.take("Q"))]
        self.images = sorted(self.image(platforms) for _ in range(self.take("Q")))

    def take(self, form: str) -> Any:
        found = struct.unpack_from("<" + form, self.data, self.at)
        self.at += struct.calcsize("<" + form)
        return found[0] if len(found) == 1 else np.array(found)

    def text(self) -> str:
        return bytes(self.take("B") for _ in range(self.take("Q"))).decode()

    def platform(self) -> tuple[list[Any], list[Any]]:
        self.text()
        cameras, poses = [], []
        for _ in range(self.take("Q")):
            self.text()
            if self.version > 3:
                self.text()
            size = self.take("II") if self.version > 0 else np.zeros(2)
            cameras.append((size, *(self.take("9d").reshape(3, 3) for _ in range(2)), self.take("3d")))
        for _ in range(self.take("Q")):
            poses.append((self.take("9d").reshape(3, 3), self.take("3d")))
        return cameras, poses

    def image(self, platforms: list[Any]) -> tuple[str, Any]:
        name = self.text()
        if self.version > 4:
            self.text()
        platform, camera, pose = self.take("III")
        if self.version > 2:
            self.take("I")
        _, matrix, turn, place = platforms[platform][0][camera]
        world_turn, world_place = platforms[platform][1][pose]
        return name, (matrix, turn @ world_turn, world_turn.T @ place + world_place)


def prepare(scene: pathlib.Path, folder: pathlib.Path) -> None:
    """Reduces the photographs in linear light, and writes their cameras for each program."""
    (folder / "texrecon").mkdir(parents=True, exist_ok=True)
    frames, rasters = [], []
    images = Scene(scene).images
    for place, index in enumerate(ORDER):
        name, (matrix, turn, eye) = images[index]
        light = ewa.read_image(scene.parent / name)[..., :3]
        height, width = light.shape[0] // REDUCED, light.shape[1] // REDUCED
        small = light.reshape(height, REDUCED, width, REDUCED, 3).mean((1, 3), dtype=np.float64)
        file = f"{index:02d}.png"
        ewa.save_image(folder / file, small.astype(np.float32))
        focal, (cx, cy) = matrix[0, 0] / REDUCED, (matrix[:2, 2] + 0.5) / REDUCED
        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = turn.T @ np.diag([1, -1, -1]), eye  # y up, looks against z
        frames.append({"file_path": file, "fl_x": focal, "fl_y": focal, "cx": cx, "cy": cy, "w": width, "h": height,
                       "transform_matrix": pose.tolist()})
        if place in HELD_OUT:
            continue
        ewa.save_image(folder / "texrecon" / file, small.astype(np.float32))
        numbers = (*(-turn @ eye), *turn.ravel())
        (folder / "texrecon" / f"{index:02d}.cam").write_text(
            " ".join(map(repr, map(float, numbers))) + f"\n{float(focal / width)!r} 0 0 1 {float(cx / width)!r} {float(cy / height)!r}\n")
        rotation = np.eye(4)
        rotation[:3, :3] = pose[:3, :3].T
        rasters.append(
            f'<MLRaster label="{file}"><VCGCamera TranslationVector="{" ".join(map(str, -eye))} 1" LensDistortion="0 0" '
            f'ViewportPx="{width} {height}" PixelSizeMm="0.01 0.01" CenterPx="{cx} {height - cy}" FocalMm="{focal / 100}" '
            f'CameraType="0" BinaryData="0" RotationMatrix="{" ".join(map(str, rotation.ravel()))} "/>'
            f'<Plane semantic="1" fileName="{file}"/></MLRaster>')
    (folder / "transforms.json").write_text(json.dumps({"frames": frames}, indent=1))
    mesh = '<MLMesh label="mesh" filename="mesh.ply"><MLMatrix44>1 0 0 0 \n0 1 0 0 \n0 0 1 0 \n0 0 0 1 \n</MLMatrix44></MLMesh>'
    (folder / "meshlab.mlp").write_text(
        f"<!DOCTYPE MeshLabDocument>\n<MeshLabProject>\n<MeshGroup>{mesh}</MeshGroup>\n<RasterGroup>\n" +
        "\n".join(rasters) + "\n</RasterGroup>\n</MeshLabProject>\n")


def encoded(light: Any) -> Any:
    light = np.clip(light, 0, 1)
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055)


def gain_of(shown: Any, taken: Any) -> float:
    """By the weights of Geman and McClure; errors count as in sRGB numbers, of which 1.2 is about twice the exponent less one."""
    gain = float(np.median(taken) / np.median(shown))
    for _ in range(50):
        error = encoded(gain * shown) - encoded(taken)
        weight = (ROBUST**2 / (ROBUST**2 + error**2)) ** 2 * np.maximum(1e-3, taken + 1e-4) ** -1.2
        gain = float((weight * shown * taken).sum() / (weight * shown**2).sum())
    return gain


def steepness(picture: Any) -> Any:
    return ((picture[1:-1, 2:] - picture[1:-1, :-2]) ** 2 + (picture[2:, 1:-1] - picture[:-2, 1:-1]) ** 2).sum(-1)


def decibels(error: Any) -> float:
    return float(-10 * np.log10((error**2).mean()))


def compare(folder: pathlib.Path, files: dict[str, str]) -> None:
    """Prints, of both photographs: all pixels, share of far ones, the others, median difference, gradient energy; in the end the pixels that are
    far in none."""
    cameras = ewa.cameras(folder / "transforms.json")
    rows: dict[str, list[Any]] = {name: [] for name in files}
    for k in HELD_OUT:
        taken = ewa.read_image(folder / f"{ORDER[k]:02d}.png")[..., :3].astype(np.float64)
        photo = encoded(taken)
        nears, errors = {}, {}
        for name, path in files.items():
            rgba = ewa.render(ewa.read(path), cameras[k], shading="none", background="transparent", planes="rgba").rgba
            filled = rgba[..., 3] > FILLED
            light = rgba[..., :3].astype(np.float64) / np.maximum(rgba[..., 3:], FILLED)
            gains = np.array([gain_of(light[filled, c], taken[filled, c]) for c in range(3)])
            shown = encoded(light * gains)
            errors[name] = error = shown - photo
            far = np.sqrt((error**2).mean(-1)) > FAR
            nears[name] = near = filled & ~far
            inner = near[1:-1, 1:-1] & near[1:-1, 2:] & near[1:-1, :-2] & near[2:, 1:-1] & near[:-2, 1:-1]
            rows[name].append([decibels(error[filled]), 100 * far[filled].mean(), decibels(error[near]),
                               np.median(abs(error[filled])), steepness(shown)[inner].sum() / steepness(photo)[inner].sum()])
        everywhere = np.logical_and.reduce(list(nears.values()))
        for name in files:
            rows[name][-1].append(decibels(errors[name][everywhere]))
    for name, (first, second) in rows.items():
        forms = (".1f", ".0f", ".1f", ".3f", ".2f", ".1f")
        print(name, *(f"{a:{form}}, {b:{form}}" for a, b, form in zip(first, second, forms)), sep=" | ")


if __name__ == "__main__":
    if sys.argv[1] == "prepare":
        prepare(pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]))
    else:
        compare(pathlib.Path(sys.argv[2]), dict(argument.split("=", 1) for argument in sys.argv[3:]))
