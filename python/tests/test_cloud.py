# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Arrays in and out of clouds."""
from __future__ import annotations

import unittest
from typing import Any

import numpy as np

import ewa
from common import Case


class Arrays(Case):
    def setUp(self) -> None:
        super().setUp()
        self.points = np.random.default_rng(1).normal(size=(1000, 3))

    def test_borrows_contiguous_and_strided(self) -> None:
        rows = np.zeros((1000, 8), np.float32)
        rows[:, 2:5] = self.points
        record = np.zeros(1000, [("xyz", np.float64, 3), ("i", np.uint16), ("rgb", np.uint8, 3), ("pad", np.uint8, 11)])
        record["xyz"], record["i"] = self.points, np.arange(1000)
        for positions in (self.points, self.points.astype(np.float32), rows[:, 2:5], self.points[::2], record["xyz"]):
            with self.subTest(str(positions.strides)):
                cloud = ewa.Cloud(positions, copy=False)
                self.assertTrue(cloud.borrows("position"))
                self.assertTrue(np.shares_memory(cloud["position"], positions))
                np.testing.assert_array_equal(cloud["position"], positions)
                self.assertFalse(cloud["position"].flags.writeable)
        cloud = ewa.Cloud(record["xyz"], colors=record["rgb"], i=record["i"], copy=False)
        np.testing.assert_array_equal(cloud["i"], np.arange(1000))
        self.assertEqual(cloud.keys(), ["position", "color", "i"])

    def test_copies_what_cannot_be_borrowed(self) -> None:
        for positions in (self.points[::-1], np.asfortranarray(self.points), self.points.astype(">f8"),
                          np.broadcast_to(self.points[:1], (5, 3)), self.points.tolist()):
            cloud = ewa.Cloud(positions)
            np.testing.assert_array_equal(cloud["position"], np.asarray(positions))
        with self.assertRaises(ewa.ArgumentError):
            ewa.Cloud(self.points[::-1], copy=False)

    def test_converts_what_loses_nothing(self) -> None:
        corners = [[0, 0, 0], [1, 0, 0], [0, 2, 0]]
        for dtype in (np.int8, np.uint16, np.int32, np.int64, np.uint64, np.float16):
            cloud = ewa.Cloud(np.array(corners, dtype), colors=[[255, 0, 0]] * 3, big=np.array([0, 1, 2**40]))
            np.testing.assert_array_equal(cloud["position"], corners)
            # Whole numbers stay such: they are codes of colours, of 8 bits where these hold them.
            self.assertEqual([cloud[name].dtype for name in cloud], [np.float16 == dtype and np.float32 or np.float64,
                                                                     np.uint8, np.float64])
            with self.assertRaises(ewa.ArgumentError):
                ewa.Cloud(np.array(corners, dtype), copy=False)
        volume = ewa.Volume(np.arange(27).reshape(3, 3, 3))
        self.assertEqual(volume.voxels.dtype, np.float32)
        with self.assertRaises(ewa.ArgumentError):
            ewa.Volume(np.full((3, 3, 3), 2**24 + 1))

    def test_says_what_it_rounds(self) -> None:
        for kind in (np.int64, np.uint64):
            with self.assertWarnsRegex(ewa.EwaWarning, "time: .*rounded"):
                cloud = ewa.Cloud(self.points, time=np.arange(1000, dtype=kind) * 2 + 2**60 + 1)
            np.testing.assert_allclose(cloud["time"], np.arange(1000) * 2.0 + 2.0**60)
            with self.assertRaises(ewa.ArgumentError):
                ewa.Cloud(self.points, time=np.arange(1000, dtype=kind), copy=False)

    def test_strided_surfels_are_those_of_contiguous_ones(self) -> None:
        made = ewa.generate("torus", 3000)
        wide = np.zeros((3000, 10), np.float32)
        for name, first, width in (("position", 0, 3), ("normal", 3, 3), ("radius", 6, 1)):
            wide[:, first:first + width] = made[name].reshape(3000, width)
        strided = ewa.Cloud(wide[:, :3], normals=wide[:, 3:6], radius=wide[:, 6], colors=made["color"], copy=False)
        strided["signed_curvature"] = made["signed_curvature"]
        camera = ewa.Camera.frame(made, size=(160, 90))
        a, b = (ewa.render(cloud, camera, planes="rgba").rgba for cloud in (made, strided))
        assert a is not None and b is not None
        self.assertEqual(a.tobytes(), b.tobytes())

    def test_refuses_wrong_arrays(self) -> None:
        n = len(self.points)
        wrong: list[Any] = [
            np.zeros((4, 2)), np.zeros(3), np.zeros((2, 3, 1)), np.zeros((4, 3), complex),
            np.zeros((4, 3), object), np.ma.masked_array(np.zeros((4, 3))), "abc", None,
            [[1, 2], [3]], {"a": 1}]
        for value in wrong:
            with self.subTest(repr(value)[:40]), self.assertRaises(ewa.ArgumentError):
                ewa.Cloud(value)
        for name, value in (("normals", np.zeros((n - 1, 3))), ("colors", np.zeros((n, 5))), ("radius", np.zeros((n, 2, 2))),
                            ("x" * 64, np.zeros(n)), ("", np.zeros(n))):
            with self.subTest(name), self.assertRaises(ewa.ArgumentError):
                ewa.Cloud(self.points, **{name: value})
        with self.assertRaises(ewa.ArgumentError):
            ewa.Cloud(self.points, colors=np.zeros((n, 2), np.uint8)).estimate().surfels()
        for origin in ((0, np.nan, 0), (0, 0), (0, 0, 0, 0)):
            with self.subTest(str(origin)), self.assertRaises(ewa.ArgumentError):
                ewa.Cloud(self.points, origin=origin)
        self.assertEqual(list(ewa.Cloud(self.points, origin=(1e6, 2, -3.5)).origin), [1e6, 2, -3.5])

    def test_points_that_are_nan_are_left_out(self) -> None:
        points = np.concatenate([self.points, np.full((7, 3), np.nan)])
        with self.assertWarns(ewa.EwaWarning):
            surfels = ewa.Cloud(points).surfels()
        self.assertEqual((len(surfels), surfels.left_out_count), (1000, 7))
        with self.assertRaises(ewa.FormatError):
            ewa.Cloud(points[-7:]).surfels()
        with self.assertRaises(ewa.NumericError):
            ewa.Camera.frame(ewa.Cloud(points[-7:]))
        self.assertEqual(len(ewa.Cloud(np.zeros((0, 3)))), 0)

    def test_changes_leave_what_others_see(self) -> None:
        cloud = ewa.Cloud(self.points, intensity=np.arange(1000.0))
        before, estimated = cloud["intensity"], cloud.estimate()
        cloud["intensity"] = np.zeros(1000)
        cloud["extra"] = np.ones((1000, 2), np.float32)
        del cloud["position"]
        self.assertEqual(cloud.keys(), ["intensity", "extra"])
        np.testing.assert_array_equal(before, np.arange(1000.0))
        np.testing.assert_array_equal(estimated["position"], self.points)
        moved = estimated.transform([[0, -1, 0, 5], [1, 0, 0, 0], [0, 0, 1, 0]])
        np.testing.assert_array_equal(estimated["position"], self.points)
        np.testing.assert_allclose(moved["position"] + moved.origin, self.points[:, [1, 0, 2]] * [-1, 1, 1] + [5, 0, 0])
        with self.assertRaises(KeyError):
            cloud["normal"]
        with self.assertRaises(ewa.ArgumentError):
            cloud["short"] = np.zeros(999)

    def test_choices(self) -> None:
        cloud = ewa.Cloud(self.points, classification=(np.arange(1000) % 3).astype(np.uint8))
        self.assertEqual(len(cloud.filter("classification=1")), 333)
        inside = (np.abs(self.points) <= 1).all(1)
        self.assertEqual(len(cloud.crop((-1, -1, -1), (1, 1, 1))), inside.sum())
        self.assertEqual(len(cloud.crop_sphere((0, 0, 0), 1e9)), len(cloud))
        self.assertRaises(ewa.ArgumentError, cloud.crop_sphere, (0, 0, 0), -1)
        np.testing.assert_array_equal(cloud.select(inside)["position"], self.points[inside])
        np.testing.assert_array_equal(cloud.select([5, 2, 2])["position"], self.points[[5, 2, 2]])
        np.testing.assert_array_equal(cloud.scalar("y"), self.points[:, 1])
        wrong: list[Any] = [[1000], [-1], [0.5], np.ones(999, bool), [[1]]]
        for points in wrong:
            with self.subTest(str(points)[:20]), self.assertRaises(ewa.ArgumentError):
                cloud.select(points)
        for text in ("nothing=1", "classification", "z<"):
            with self.assertRaises(ewa.ArgumentError):
                cloud.filter(text)
        with self.assertRaises(ewa.ArgumentError):
            cloud.thin(voxel=-1)
        strewn = ewa.Cloud(np.concatenate([self.points, [[99, 0, 0]]]))
        self.assertEqual(len(strewn.without_outliers(6)), 1000)
        with self.assertRaises(ewa.ArgumentError):
            strewn.without_outliers(0)

    def test_files_keep_arrays(self) -> None:
        cloud = ewa.Cloud(self.points, intensity=np.arange(1000, dtype=np.uint16),
                          colors=np.full((1000, 3), 7, np.uint8))
        cloud.save(self.path("scan.ply"))
        again = ewa.read(self.path("scan.ply"))
        for name in ("position", "intensity", "color"):
            self.assertEqual(cloud[name].dtype, again[name].dtype)
            np.testing.assert_array_equal(cloud[name], again[name])
        with open(self.path("bad.ply"), "wb") as file:
            file.write(b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nend_header\n1\n")
        with self.assertRaises(ewa.FormatError) as caught:
            ewa.read(self.path("bad.ply"))
        self.assertIn("bad.ply", str(caught.exception))
        self.assertEqual(caught.exception.status, "EWA_ERROR_FORMAT")
        with self.assertRaises(ewa.FileError):
            ewa.read(self.path("none.ply"))
        for path in ("-", "", "a\0b"):
            with self.assertRaises(ewa.ArgumentError):
                ewa.read(path)
        with self.assertRaises(TypeError):
            ewa.read(3)  # type: ignore[arg-type]

    def test_notes_hold_zeros(self) -> None:
        cloud = ewa.generate("plane", 500)
        cloud.save(self.path("a.las"))
        read = ewa.read(self.path("a.las"))
        notes = read.notes
        self.assertEqual(read.estimate().notes, notes)


class Meshes(Case):
    def test_triangles(self) -> None:
        corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
        faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
        mesh = ewa.Mesh(corners, faces, colors=np.tile([1, 0, 0, 1], (4, 1)).astype(np.float32))
        self.assertTrue(mesh.closed)
        cloud = mesh.sample(point_count=2000)
        self.assertEqual(set(map(tuple, cloud["color"])), {(255, 0, 0)})
        np.testing.assert_array_equal(mesh.vertices, corners)
        whole = ewa.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], faces.tolist(), normals=np.eye(4, 3, dtype=int),
                         colors=np.ones((4, 4), np.float16))
        np.testing.assert_array_equal(whole.vertices, corners)
        wrong: list[Any] = [[[0, 1, 4]], [[0, 1, -1]], [[0.0, 1, 2]], [[0, 1]], [0, 1, 2]]
        for triangles in wrong:
            with self.assertRaises(ewa.ArgumentError):
                ewa.Mesh(corners, triangles)
        marked = ewa.Mesh(corners, faces, heat=[0, 1, 2, 4.0], part=np.array([7, 7, 7, 9]))
        self.assertEqual(list(marked.attributes), ["heat", "part"])
        points = marked.sample(point_count=2000)
        x, y, z = points["position"].T
        np.testing.assert_allclose(points["heat"], x + 2 * y + 4 * z, atol=1e-6)
        self.assertEqual(set(points["part"].tolist()), {7, 9})
        self.assertEqual(ewa.Mesh(corners, faces).attributes, {})
        for wrong_numbers in ({"heat": [1, 2]}, {"radius": [1, 1, 1, 1.0]}, {"heat": np.zeros((4, 5))}):
            with self.assertRaises(ewa.ArgumentError):
                ewa.Mesh(corners, faces, **wrong_numbers)
        with self.assertRaises(ewa.NumericError):
            ewa.Mesh(np.zeros((3, 3)), [[0, 1, 2]]).sample()
        with self.assertRaises(ewa.FormatError):
            ewa.generate("plane", 100).save(self.path("a.ply"))
            ewa.read_mesh(self.path("a.ply"))


if __name__ == "__main__":
    unittest.main()
