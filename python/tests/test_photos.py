# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Colours of points from photographs."""
from __future__ import annotations

import os
import unittest

import numpy as np

import ewa
from common import Case
from ewa import Array


def linear(srgb8: Array) -> Array:
    """sRGB of 8 bits as linear light."""
    codes = srgb8 / 255
    return np.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4)


class Photos(Case):
    def test_colors_come_back(self) -> None:
        truth = ewa.generate("sphere", 3000).procedure("marble")
        photos = []
        for right in range(0, 360, 60):
            camera = ewa.Camera.frame(truth, size=(96, 96)).orbit((0, 0, 0), (0, 1, 0), right)
            photos.append((camera, ewa.render(truth, camera, planes=("rgba",), shading="none").rgba))
        grey = ewa.generate("sphere", 3000)
        made, report = grey.color_from_photos(photos, exposure="off")
        seen = made["photo_count"].ravel() > 0
        self.assertEqual(report.seen_count, int(seen.sum()))
        self.assertGreater(seen.mean(), 0.8)
        wanted = linear(truth["color"][seen, :3])
        self.assertLess(np.abs(made["color"][seen, :3] - wanted).mean(), np.abs(linear(grey["color"][seen, :3]) - wanted).mean() / 10)
        self.assertEqual(len(report.photographs), len(photos))

    def test_image_quality(self) -> None:
        grey = np.full((20, 30, 3), linear(np.float64(127.5)), np.float32)
        light = np.full((20, 30, 3), linear(np.float64(153)), np.float32)
        found = ewa.compare_images(grey, light)
        self.assertAlmostEqual(found.psnr_db, 20, places=3)
        self.assertEqual(found.pixel_count, 600)
        self.assertLess(found.ssim, 1)
        self.assertAlmostEqual(ewa.compare_images(grey, grey).ssim, 1, places=12)
        with self.assertRaises(ewa.ArgumentError):
            ewa.compare_images(grey, light[:10])

    def test_wrong_pictures(self) -> None:
        cloud = ewa.generate("sphere", 100)
        camera = ewa.Camera.frame(cloud, size=(32, 32))
        with self.assertRaisesRegex(ewa.ArgumentError, "photograph 0: shape"):
            cloud.color_from_photos([(camera, np.zeros((32, 32, 2), np.uint8))])
        with self.assertRaises(ewa.FileError):
            cloud.color_from_photos(self.path("nothing.json"))
        with self.assertRaisesRegex(ewa.FormatError, "is Bundler's bundle.out; cameras are"):
            with open(self.path("bundle.out"), "w") as file:
                file.write("# Bundle file v0.3\n")
            cloud.color_from_photos(self.path("bundle.out"))
        with self.assertRaisesRegex(ewa.ArgumentError, "masks: of photographs in files"):
            cloud.color_from_photos([(camera, np.zeros((32, 32, 3), np.uint8))], masks=self.path("."))

    def test_masks(self) -> None:
        truth = ewa.generate("sphere", 2000).procedure("marble")
        camera = ewa.Camera.frame(truth, size=(64, 64))
        ewa.render(truth, camera, shading="none", background="transparent").save(self.path("view.png"))
        camera.save(self.path("camera.json"))
        with open(self.path("camera.json")) as file, open(self.path("cameras.json"), "w") as out:
            out.write("[" + file.read().replace("{", '{"file_path": "view.png",', 1) + "]")
        half = np.zeros((64, 64, 1), np.uint8)
        half[:32] = 255
        os.mkdir(self.path("masks"))
        ewa.save_image(self.path("masks/view.png"), half)
        seen = [ewa.generate("sphere", 2000).color_from_photos(self.path("cameras.json"), masks=masks, method="mean")[1].seen_count
                for masks in (None, self.path("masks"))]
        self.assertLess(abs(seen[1] - seen[0] / 2), seen[0] / 10)


if __name__ == "__main__":
    unittest.main()
