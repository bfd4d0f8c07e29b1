# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Turns, films and furniture are those of the program, byte for byte."""
from __future__ import annotations

import os
import shutil
import unittest
from typing import Any

import numpy as np

import ewa
from common import Case


class Films(Case):
    def setUp(self) -> None:
        super().setUp()
        ewa.generate("terrain", 6000).save(self.path("scan.ply"))

    def frames(self, scene: ewa.Scene, count: int, **options: Any) -> Any:
        image: ewa.Image | None = None
        for camera in ewa.turntable(scene, count, size=(64, 48), **options):
            image = scene.render(camera, out=image)
            yield image

    def test_many_frames(self) -> None:
        """A renderer draws levels from far away, and the bytes of a film of the program; one picture is of all surfels."""
        ewa.generate("terrain", 270000).save(self.path("many.ply"))
        scene = ewa.Scene(self.path("many.ply"))
        camera = ewa.Camera.look_at((24, -24, 19.2), (0, 0, 0), size=(256, 256))
        one, many = scene.render(camera), ewa.Renderer().render(scene, camera)
        self.assertEqual(one.stats["level"], 0)
        self.assertGreater(many.stats["level"], 0)
        off = one.rgba8.astype(float) - many.rgba8
        self.assertLessEqual(np.sqrt(np.mean(off[..., :3] ** 2)), 1)
        camera.save(self.path("far.json"))
        self.run_program("render", "many.ply", "--path", "far.json", "-o", "film_%d.png")
        many.save(self.path("ours.png"))
        self.assertEqual(self.bytes("ours.png"), self.bytes("film_0.png"))

    def test_turntable(self) -> None:
        self.run_program("render", "scan.ply", "-o", "theirs_%02d.png", "--turntable", "5", "--size", "64x48", "--elevation", "20")
        scene = ewa.Scene(self.path("scan.ply"))
        self.assertEqual(ewa.film(self.path("ours_%02d.png"), self.frames(scene, 5, elevation=20)), 5)
        for i in range(5):
            self.assertEqual(self.bytes(f"ours_{i:02}.png"), self.bytes(f"theirs_{i:02}.png"), f"frame {i}")
        start = ewa.Camera.look_at((3, -2, 1), (0, 0, 0), size=(64, 48))
        turn = ewa.turntable(self.path("scan.ply"), 4, start)
        np.testing.assert_allclose(turn[0].world_to_camera, start.world_to_camera, atol=1e-12)
        np.testing.assert_allclose(turn[2].eye[2], start.eye[2], atol=1e-9)
        with self.assertRaises(ewa.ArgumentError):
            ewa.turntable(scene, 0)

    @unittest.skipUnless(shutil.which("ffmpeg"), "ffmpeg is not installed; Debian: ffmpeg")
    def test_films(self) -> None:
        scene = ewa.Scene(self.path("scan.ply"))
        for kind in ("mp4", "gif"):
            quality = ["--quality", "40"] if kind == "mp4" else []
            self.run_program("render", "scan.ply", "-o", f"theirs.{kind}", "--turntable", "4", "--size", "64x48", "--fps", "12.5",
                             *quality)
            count = ewa.film(self.path(f"ours.{kind}"), self.frames(scene, 4), fps=12.5, quality=40)
            self.assertEqual(count, 4)
            self.assertEqual(self.bytes(f"ours.{kind}"), self.bytes(f"theirs.{kind}"))
        before = set(os.listdir(self._folder.name))
        pictures = [np.zeros((48, 64, 3), np.uint8), np.zeros((48, 66, 3), np.uint8)]
        clear = ewa.render(ewa.generate("torus", 500), size=(64, 48), background="transparent")
        wrong: list[tuple[str, Any, type[Exception]]] = [
            ("a.mp4", [], ewa.ArgumentError), ("a.mp4", pictures, ewa.ArgumentError), ("a.mp4", [clear], ewa.ArgumentError),
            ("a.avi", pictures, ewa.FormatError), ("a%d_%d.png", [clear], ewa.ArgumentError), ("a%d.png", [], ewa.ArgumentError),
            ("a.mp4", [np.zeros((4, 4))], ewa.ArgumentError)]
        for name, frames, error in wrong:
            with self.subTest(name), self.assertRaises(error):
                ewa.film(self.path(name), frames)
        self.assertEqual(set(os.listdir(self._folder.name)), before, "something was left behind")
        self.assertEqual(ewa.film(self.path("c.webm"), [clear, clear]), 2)

    def test_furniture(self) -> None:
        furniture: dict[str, Any] = {"title": "Ground", "unit": "m", "axes": True, "scale_bar": True, "color_bar": True}
        words = ["--title", "Ground", "--unit", "m", "--axes", "--scale-bar", "--color-bar", "--size", "320x240"]
        for name, colors, lens in (("z", ["--color-by", "z"], {}), ("x", ["--color-by", "x", "--colormap", "turbo"], {"ortho": 3})):
            self.run_program("render", "scan.ply", "-o", "theirs.png", *words, *colors, *(["--ortho", "3"] if lens else []))
            scene = ewa.Scene()
            scene.add(self.path("scan.ply"), color_by=name, colormap="turbo" if lens else "auto")
            image = scene.render(scene.camera(size=(320, 240), color_bar=True, **lens))
            scene.draw_furniture(image, **furniture).save(self.path("ours.png"))
            self.assertEqual(self.bytes("ours.png"), self.bytes("theirs.png"), name)
        plain = ewa.Scene(ewa.generate("torus", 2000))
        image = plain.render(size=(200, 150))
        before = image.rgba8.copy()
        plain.draw_furniture(image)
        np.testing.assert_array_equal(image.rgba8, before)
        plain.draw_furniture(image, color_bar=True, range=(2, 5), color_label="depth", colormap="magma", title="a")
        self.assertGreater((image.rgba8 != before).any(-1).sum(), 500)
        with self.assertRaises(ewa.ArgumentError):
            plain.draw_furniture(plain.render(size=(20, 15), planes="depth"), axes=True)


if __name__ == "__main__":
    unittest.main()
