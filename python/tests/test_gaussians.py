# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Trained Gaussians: arrays in and out, files, pictures, and what is wrong about each."""
from __future__ import annotations

import gc
import json
import pickle
import struct
import sys
import zipfile

import numpy as np

import ewa
from common import ROOT, Case

sys.path.append(str(ROOT / "measure"))
import gaussian_formula


def streams(count: int = 50, degree: int = 1) -> dict[str, np.ndarray]:
    random = np.random.default_rng(3)
    rotations = random.normal(size=(count, 4))
    return {"centers": random.uniform(-1, 1, (count, 3)).astype(np.float32),
            "scales": random.uniform(0.05, 0.3, (count, 3)).astype(np.float32),
            "rotations": (rotations / np.linalg.norm(rotations, axis=1, keepdims=True)).astype(np.float32),
            "opacities": random.uniform(0.2, 0.9, count).astype(np.float32),
            "harmonics": random.normal(scale=0.4, size=(count, (degree + 1) ** 2, 3)).astype(np.float32)}


class Sets(Case):
    def test_arrays_are_borrowed(self) -> None:
        given = streams()
        gaussians = ewa.Gaussians(**given, origin=(1, 2, 3), antialiased=True)
        for name, array in given.items():
            shown = getattr(gaussians, name)
            self.assertTrue(np.shares_memory(shown, array), name)
            self.assertFalse(shown.flags.writeable)
        self.assertEqual((len(gaussians), gaussians.sh_degree, gaussians.antialiased, gaussians.flat), (50, 1, True, False))
        np.testing.assert_array_equal(gaussians.origin, (1, 2, 3))
        self.assertIn("50 of degree 1", repr(gaussians))

    def test_files_keep_the_numbers(self) -> None:
        given = streams(degree=3)
        ewa.Gaussians(**given).save(self.path("set.ply"))
        again = ewa.read_gaussians(self.path("set.ply"))
        for name, array in given.items():
            np.testing.assert_allclose(getattr(again, name), array, rtol=2e-4, atol=2e-5, err_msg=name)
        again.save(self.path("set.spz"), sh_degree=1)
        self.assertEqual(ewa.read_gaussians(self.path("set.spz")).sh_degree, 1)
        surfels = again.to_cloud()
        self.assertEqual(len(surfels), 50)
        self.assertIn("tangent_u", surfels)

    def test_classes(self) -> None:
        self.assertIsNone(ewa.Gaussians(**streams()).classes)
        classes = (np.arange(50) % 2 * 600 + 2).astype(np.uint16)
        given = ewa.Gaussians(**streams(), classes=classes)
        self.assertTrue(np.shares_memory(given.classes, classes))
        np.testing.assert_array_equal(pickle.loads(pickle.dumps(given)).classes, classes)
        given.save(self.path("classes.ply"))
        again = ewa.read_gaussians(self.path("classes.ply"))
        np.testing.assert_array_equal(again.classes, classes)
        np.testing.assert_array_equal(again.to_cloud()["classification"], classes)
        scene = ewa.Scene()
        scene.add(again, color_by="classification")
        scene.render(size=(32, 32))
        with self.assertRaises(ewa.ArgumentError):
            ewa.Gaussians(**streams(), classes=classes[:49])

    def test_files_are_what_others_take(self) -> None:
        given = streams(degree=3)
        ewa.Gaussians(**given).save(self.path("set.sog"))
        with zipfile.ZipFile(self.path("set.sog")) as archive:
            self.assertIsNone(archive.testzip())
            said = json.loads(archive.read("meta.json"))
            self.assertEqual((said["version"], said["count"]), (2, 50))
            self.assertTrue(all(archive.read(name).startswith(b"RIFF") for name in archive.namelist() if name != "meta.json"))
        for degree in range(4): # texts of several lengths
            ewa.Gaussians(**given).save(self.path("set.glb"), sh_degree=degree)
            with open(self.path("set.glb"), "rb") as file:
                whole = file.read()
            magic, version, length, text_bytes, kind = struct.unpack("<4s4I", whole[:20])
            self.assertEqual((magic, version, length, kind), (b"glTF", 2, len(whole), 0x4E4F534A))
            self.assertEqual(text_bytes % 4, 0)
            text = json.loads(whole[20:20 + text_bytes])
            binary_bytes, kind = struct.unpack("<2I", whole[20 + text_bytes:28 + text_bytes])
            self.assertEqual((kind, 28 + text_bytes + binary_bytes), (0x004E4942, len(whole)))
            accessor = text["accessors"][text["meshes"][0]["primitives"][0]["attributes"]["POSITION"]]
            at = 28 + text_bytes + text["bufferViews"][accessor["bufferView"]].get("byteOffset", 0) + accessor.get("byteOffset", 0)
            centers = np.frombuffer(whole, "<f4", 150, at).reshape(50, 3)
            np.testing.assert_allclose(np.abs(centers), np.abs(given["centers"]), rtol=1e-6)
            np.testing.assert_allclose((accessor["min"], accessor["max"]), (centers.min(0), centers.max(0)), rtol=1e-6)

    def test_wrong_arrays(self) -> None:
        given = streams()
        for name, value in (("centers", np.zeros((50, 2))), ("scales", np.zeros((49, 3))), ("rotations", np.zeros(50)),
                            ("opacities", np.zeros((50, 1))), ("harmonics", np.zeros((50, 3, 3))),
                            ("harmonics", np.zeros((50, 3))), ("centers", "text"), ("origin", (1, 2))):
            with self.subTest(name), self.assertRaises(ewa.ArgumentError):
                ewa.Gaussians(**{**given, name: value})
        for name in ("nowhere.ply", "scan.ply"):
            ewa.generate("torus", 100).save(self.path("scan.ply"))
            with self.assertRaises(ewa.Error):
                ewa.read_gaussians(self.path(name))

    def test_lifetimes(self) -> None:
        with ewa.Context(thread_count=1) as context:
            gaussians = ewa.Gaussians(**streams(), context=context)
            gaussians.save(self.path("set.ply"))
            read = ewa.read_gaussians(self.path("set.ply"), context=context)
            shown, splats = read.centers, ewa.Splats(read)
            read.close()
            with self.assertRaises(ewa.ClosedError):
                ewa.Splats(read)
            with self.assertRaises(ewa.Error):
                ewa.render_gaussians([splats, ewa.Gaussians(**streams())], size=(16, 16))
            del read
            gc.collect()
            self.assertTrue(np.isfinite(shown).all())
            ewa.render_gaussians(splats, size=(16, 16))
        with self.assertRaises(ewa.ClosedError):
            ewa.render_gaussians(splats, size=(16, 16))
        moved = streams()
        held = ewa.Gaussians(**moved)
        moved["centers"].resize((60, 3), refcheck=False)
        with self.assertRaises(ewa.ClosedError):
            ewa.Splats(held)


class Pictures(Case):
    def test_planes_and_options(self) -> None:
        splats = ewa.Splats(ewa.Gaussians(**streams()))
        self.assertGreater(splats.resident_bytes, 50 * 60)
        self.assertEqual(splats.core.shape, (2, 3))
        image = ewa.render_gaussians(splats, size=(60, 40), planes="all", background="transparent")
        np.testing.assert_allclose(image.rgba[..., 3], image.coverage, atol=1e-6)
        self.assertTrue(np.isinf(image.depth[0, 0]) and np.isfinite(image.depth[20, 30]))
        exact = ewa.render_gaussians(splats, image.camera, projection="exact", background="transparent",
                                     planes=("rgba",), sh_degree=0)
        self.assertGreater(float(np.abs(exact.rgba - image.rgba).max()), 0.01)
        for wrong in ({"projection": "affine"}, {"cutoff": 9}, {"planes": "axes"}, {"surfaces": exact}):
            with self.subTest(wrong), self.assertRaises(ewa.Error):
                ewa.render_gaussians(splats, image.camera, **wrong)
        for what in ([], [1], "set.ply"):
            with self.subTest(what), self.assertRaises((ewa.ArgumentError, TypeError)):
                ewa.render_gaussians(what)

    def test_trained_formula(self) -> None:
        given = streams(400, 3)
        given["scales"] *= 0.5
        solid, flat = given["scales"], given["scales"] * np.float32((1, 1, 0))
        for eye, fov, scales in (((3, 2, -3), 40, solid), ((3.2, 2.1, 0.4), 100, solid),  # from outside, from within
                                 ((3, 2, -3), 40, flat), ((3, 2, -0.5), 60, flat)):
            gaussians = ewa.Gaussians(**{**given, "scales": scales}, origin=(3, 2, 1))
            camera = ewa.Camera.look_at(eye, (3, 2, 1), up=(0, -1, 0), size=(120, 90), fov=fov)
            truth = gaussian_formula.draw(gaussians, camera)
            self.assertGreater(float(truth[..., 3].mean()), 0.1)
            far = {order: gaussian_formula.decibels(truth, gaussian_formula.display(ewa.render_gaussians(
                gaussians, camera, order=order, near_world=0.2, planes=("rgba",), background="transparent")))
                for order in ("auto", "centre", "ray")}
            self.assertEqual(far["auto"], far["centre"])
            self.assertGreater(far["centre"], 60)
            self.assertLess(far["ray"], 45)

    def test_volumes_among_gaussians(self) -> None:
        volume = ewa.Voxels(ewa.generate_volume("ball", dims=[16, 16, 16]), "fog")
        alone = ewa.render_gaussians([], volumes=volume, size=(40, 30), planes=("rgba",))
        plain = ewa.render_volume(volume, alone.camera, background="white", planes=("rgba",))
        np.testing.assert_allclose(alone.rgba, plain.rgba, atol=1e-5)
        both = ewa.render_gaussians(ewa.Gaussians(**streams()), volumes=[volume, volume], size=(40, 30))
        self.assertEqual(both.rgba8.shape, (30, 40, 4))
