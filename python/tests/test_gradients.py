# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Derivatives of pictures: arrays, the example, and tensors where there is PyTorch."""
from __future__ import annotations

import importlib
import io
import re
import sys
import unittest
from typing import Any
from unittest import mock

import numpy as np

import ewa
from common import ROOT, Case

try:
    import torch

    import ewa.torch as ewa_torch
except ImportError:
    torch = None


def scene(count: int = 200) -> tuple[ewa.Cloud, ewa.Camera]:
    """Discs about a plane that faces the camera."""
    random = np.random.default_rng(4)
    position = random.uniform(-1, 1, (count, 3)) * [1, 0.05, 0.8]
    normal = random.normal(0, 0.2, (count, 3)) + [0, -1, 0]
    cloud = ewa.Cloud(position, normals=normal, radius=random.uniform(0.1, 0.25, count), colors=random.random((count, 3)))
    return cloud, ewa.Camera.look_at((0.3, -3, 0.2), (0, 0, 0), size=(40, 30))


class Gradients(Case):
    def test_shapes_and_transposition(self) -> None:
        cloud, camera = scene()
        cotangent = np.random.default_rng(5).normal(size=(30, 40, 4))
        found = ewa.render_backward(cloud, camera, rgba=cotangent, by="all", background="transparent")
        assert found.color is not None and found.camera is not None and found.rgba is not None
        self.assertEqual([None if a is None else a.shape for a in found[:7]], [(200, 3), (200,)] + 2 * [(200, 3)] + [(200,)] +
                         2 * [(200, 3)])
        self.assertEqual([a.shape for a in found.camera], [(3,), (3,), (2,), (2,)])
        image = ewa.render(cloud.surfels(close_gaps=False), camera, planes="rgba", background="transparent")
        self.assertLess(np.quantile(np.abs(image.rgba - found.rgba), 0.99), 1e-3)
        # Colours are linear: <A c, r> = <c, A' r>.
        self.assertAlmostEqual(float((found.rgba[..., :3] * cotangent.astype(np.float32)[..., :3]).sum()),
                               float((np.asarray(cloud["color"]) * found.color).sum()), delta=1e-6 * np.abs(found.color).sum())
        again = ewa.render_backward(cloud, camera, rgba=cotangent, by="color", background="transparent")
        self.assertEqual(set(name for name in again._fields if getattr(again, name) is not None), {"color"})
        # By the pipeline, and of its picture; with the picture in double precision, of that.
        assert again.color is not None
        self.assertAlmostEqual(float((image.rgba[..., :3] * cotangent.astype(np.float32)[..., :3]).sum()),
                               float((np.asarray(cloud["color"]) * again.color).sum()), delta=1e-5 * np.abs(again.color).sum())
        self.assertLess(np.quantile(np.abs(again.color - found.color), 0.99), 1e-3 * np.abs(found.color).max())
        exact = ewa.render_backward(cloud, camera, rgba=cotangent, by=("color", "rgba"), background="transparent")
        np.testing.assert_array_equal(exact.color, found.color)

    def test_wrong_arguments(self) -> None:
        cloud, camera = scene()
        wrong: list[tuple[str, dict[str, Any]]] = [
            ("rgba: shape", {"rgba": np.zeros((40, 30, 4))}), ("depth: shape", {"depth": np.zeros((30, 40, 1))}),
            ("is nan", {"rgba": np.full((30, 40, 4), np.nan)}), ("by: 'colour'", {"by": "colour"}),
            ("kernel is raycast", {"kernel": "raycast"}), ("unit_coverage is -1", {"unit_coverage": -1}),
            ("passes is 1", {"passes": 1})]
        for message, arguments in wrong:
            with self.subTest(message), self.assertRaisesRegex(ewa.Error, message):
                ewa.render_backward(cloud, camera, **arguments)
        with self.assertRaises(TypeError):
            ewa.render_backward(cloud.surfels(), camera)  # type: ignore[arg-type]
        away = ewa.Camera.look_at((0, -3, 0), (0, -9, 0), size=(40, 30))
        with self.assertWarnsRegex(ewa.EwaWarning, "none of 200 surfels is in the picture of 40 x 30 pixels"):
            found = ewa.render_backward(cloud, away, rgba=np.ones((30, 40, 4)))
        assert found.color is not None
        self.assertFalse(found.color.any())

    def example(self, name: str) -> Any:
        """One of examples/, as a module."""
        sys.path.insert(0, str(ROOT / "examples"))
        self.addCleanup(sys.path.remove, str(ROOT / "examples"))
        try:
            return importlib.import_module(name)
        except ImportError:
            self.skipTest("not in a checkout")

    def test_example(self) -> None:
        """Colours from pictures, and a pose from one picture, come back."""
        example = self.example("fit_pictures")
        _, reached = example.run(2000, 48, 9, steps=10)
        self.assertGreater(reached["held_out_db"], reached["held_out_before_db"] + 10)
        self.assertLess(reached["off_deg"], 0.05 * reached["off_before_deg"])
        self.assertLess(reached["off_world"], 0.05 * reached["off_before_world"])

    def test_shape_example(self) -> None:
        """A sphere comes nearer to the cube that twelve pictures show."""
        example = self.example("fit_shape")
        said: list[str] = []
        _, log = example.run(ewa.generate("cube", 1500), 2, 40, 48, said.append)
        self.assertEqual([step for step, _, _ in log], [0, 20, 40])
        self.assertLess(log[-1][2], 0.65 * log[0][2])  # Chamfer distance
        self.assertLess(log[-1][1], 0.3 * log[0][1])
        with mock.patch("sys.argv", ["fit_shape.py", "cube.ply", "out.png", "--steps", "0"]), mock.patch("sys.stderr", io.StringIO()) as err:
            self.assertRaises(SystemExit, example.main)
        self.assertIn("--steps is 0; 1 or more are needed", err.getvalue())


@unittest.skipIf(torch is None, "PyTorch is not installed")
class Torch(Case):
    def tensors(self) -> tuple[dict[str, Any], ewa.Camera]:
        cloud, camera = scene(12)
        random = np.random.default_rng(8)
        made = {name: np.array(cloud[name], np.float64) for name in ("position", "color", "normal", "radius")}
        made["radius"] *= 2
        made["opacity"] = random.uniform(0.3, 0.9, 12)
        made["focal_px"], made["principal_px"] = np.diag(camera.K)[:2].copy(), np.array(camera.K)[:2, 2]
        return {name: torch.tensor(array, requires_grad=True) for name, array in made.items()}, camera

    def test_page(self) -> None:
        """The example of docs/gradients.md: normals that pictures find again."""
        page = ROOT / "docs" / "gradients.md"
        if not page.exists():
            self.skipTest("not in a checkout")
        blocks = re.findall(r"```py\n(.*?)```", page.read_text(encoding="utf-8"), re.S)
        self.assertEqual(len(blocks), 1)
        names: dict[str, Any] = {}
        exec(compile(blocks[0], "docs/gradients.md", "exec"), names)
        self.assertGreater(names["before"], 28)
        self.assertLess(names["after"], 12)

    def test_orthographic_cameras_stay(self) -> None:
        tensors, camera = self.tensors()
        camera = ewa.Camera(None, camera.world_to_camera, camera.size, ortho=3.0)
        given = {name: tensors[name] for name in ("position", "color", "normal", "radius")}
        pose = torch.tensor(np.array(camera.world_to_camera), requires_grad=True)
        same = ewa_torch.render(camera, **given, world_to_camera=pose)
        self.assertTrue(torch.equal(same, ewa_torch.render(camera, **given)))

    def test_gradcheck(self) -> None:
        tensors, camera = self.tensors()
        camera = camera.resized(16, 12)

        def draw(*values: Any) -> Any:
            return ewa_torch.render(camera, **dict(zip(tensors, values)), exact=True, unit_coverage=0.5)

        self.assertTrue(torch.autograd.gradcheck(draw, tuple(tensors.values()), eps=1e-7, atol=1e-5, rtol=1e-4))

    def test_pose(self) -> None:
        tensors, camera = self.tensors()
        pose = torch.tensor(camera.world_to_camera)

        def draw(turn: Any, way: Any) -> Any:
            cross = torch.stack([torch.stack([0 * turn[0], -turn[2], turn[1]]), torch.stack([turn[2], 0 * turn[0], -turn[0]]),
                                 torch.stack([-turn[1], turn[0], 0 * turn[0]])])
            moved = torch.linalg.matrix_exp(cross) @ pose[:3] + torch.cat([torch.zeros(3, 3), way[:, None]], 1)
            made = torch.cat([moved, pose[3:]], 0)
            fixed = {name: tensor.detach() for name, tensor in tensors.items() if name in ("position", "color", "normal", "radius")}
            return ewa_torch.render(camera.resized(16, 12), **fixed, world_to_camera=made, exact=True, unit_coverage=0.5)

        zeros = [torch.zeros(3, dtype=torch.float64, requires_grad=True) for _ in range(2)]
        self.assertTrue(torch.autograd.gradcheck(draw, tuple(zeros), eps=1e-6, atol=1e-5, rtol=1e-4))

    def test_planes(self) -> None:
        tensors, camera = self.tensors()
        floats = {name: tensor.detach().float().requires_grad_() for name, tensor in tensors.items() if name[:2] not in ("fo", "pr")}
        color, depth = ewa_torch.render(camera, **floats, planes=("rgba", "depth"))
        self.assertEqual((color.dtype, tuple(color.shape), tuple(depth.shape)), (torch.float32, (30, 40, 4), (30, 40)))
        (color.sum() + depth[torch.isfinite(depth)].sum()).backward()
        for name, tensor in floats.items():
            self.assertEqual((tensor.grad.dtype, tensor.grad.shape), (torch.float32, tensor.shape), name)
            self.assertTrue(torch.isfinite(tensor.grad).all() and tensor.grad.any(), name)
        for wrong in ({"position": floats["position"][:, :2]}, {"radius": floats["radius"].int()}, {"planes": "rgba8"}):
            with self.assertRaises(ewa.ArgumentError):
                ewa_torch.render(camera, **{**floats, **wrong})
