# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Cameras, options, planes, volumes, depth images, textures."""
from __future__ import annotations

import pathlib
import pickle
import unittest
from typing import Any

import numpy as np

import ewa
from common import Case


class Cameras(Case):
    def test_a_camera_by_its_direction(self) -> None:
        cloud = ewa.generate("cube", 500)
        for view, direction in (("front", (0, 2, 0)), ("right", (-1, 0, 0)), ("left", (0.5, 0, 0))):
            camera = ewa.Camera.frame(cloud, direction, "z")
            np.testing.assert_allclose(camera.world_to_camera, ewa.Camera.frame(cloud, view, "z").world_to_camera, atol=1e-12)
            self.assertEqual(camera, ewa.Scene(cloud).camera(direction, "z"))

    def test_opencv(self) -> None:
        """Numbers of OpenCV: a place is seen where its projection formula says, half a pixel further here."""
        k = np.array([[90.0, 0, 39.5], [0, 95, 29.5], [0, 0, 1]])
        vector, t = np.array([0.3, -0.7, 0.2]), np.array([0.1, -0.2, 3])
        camera = ewa.Camera.from_opencv(k, vector, t[:, None])
        self.assertEqual(camera.size, (80, 60))
        rotation, place = camera.world_to_camera[:3, :3], np.array([0.2, 0.1, -0.3])
        np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-14)
        np.testing.assert_allclose(rotation @ vector, vector, atol=1e-14)  # the axis stays
        self.assertAlmostEqual(np.trace(rotation), 1 + 2 * np.cos(np.linalg.norm(vector)))
        half_turn = ewa.Camera.from_opencv(k, [0, 0, np.pi / 2]).world_to_camera[:3, :3]
        np.testing.assert_allclose(half_turn @ [1, 0, 0], [0, 1, 0], atol=1e-14)  # x to y, as cv2.Rodrigues
        self.assertEqual(ewa.Camera.from_opencv(k, rotation, t), camera)
        np.testing.assert_array_equal(ewa.Camera.from_opencv(k).world_to_camera, np.eye(4))
        seen = ewa.render(ewa.Cloud(place[None, :], normals=(-place - rotation.T @ t)[None, :], radius=np.array([0.05], np.float32)), camera,
                          planes=("rgba",), background="transparent", close_gaps=False).rgba[..., 3]
        y, x = np.mgrid[:60, :80]
        at = k @ (rotation @ place + t)
        self.assertAlmostEqual((seen * x).sum() / seen.sum(), at[0] / at[2], delta=0.05)
        self.assertAlmostEqual((seen * y).sum() / seen.sum(), at[1] / at[2], delta=0.05)
        wrong: list[dict[str, Any]] = [{"R": np.zeros((3, 3))}, {"R": [1, 2]}, {"t": [1, 2]}, {"distortion": [0] * 8 + [1]},
                                       {"distortion": [0, 0, 0, 0, 1], "fisheye": True}, {"distortion": ["a"]}]
        for options in wrong:
            with self.subTest(str(options)), self.assertRaises(ewa.ArgumentError):
                ewa.Camera.from_opencv(k, **options)

    def test_distortion(self) -> None:
        k = np.array([[90.0, 0, 39.5], [0, 95, 29.5], [0, 0, 1]])
        k1, k2, p1, p2, k3 = 0.1, -0.03, 0.01, -0.02, 0.004
        camera = ewa.Camera.from_opencv(k, distortion=[k1, k2, p1, p2, k3])
        np.testing.assert_array_equal(camera.distortion, [k1, k2, p1, p2, k3, 0, 0, 0])
        self.assertEqual(pickle.loads(pickle.dumps(camera)), camera)
        self.assertNotEqual(camera, ewa.Camera.from_opencv(k))
        np.testing.assert_array_equal(camera.resized(40, 30).distortion, camera.distortion)
        v, u = np.mgrid[:60, :80].astype(float)
        x, y = (u - k[0, 2]) / k[0, 0], (v - k[1, 2]) / k[1, 1]
        ramp = np.stack([u / 80, v / 60, 0 * u], 2).astype(np.float32)
        plain = ewa.undistort(ramp, camera)
        r2 = x * x + y * y
        scale = 1 + k1 * r2 + k2 * r2**2 + k3 * r2**3
        shown = [(x * scale + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)) * k[0, 0] + k[0, 2],
                 (y * scale + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y) * k[1, 1] + k[1, 2]]
        inner = (plain[..., 3] > 0.999) & (shown[0] > 3) & (shown[0] < 76) & (shown[1] > 3) & (shown[1] < 56)
        self.assertGreater(inner.mean(), 0.7)
        for channel, (place, size) in enumerate(zip(shown, (80, 60))):
            np.testing.assert_allclose(plain[..., channel][inner] * size, place[inner], atol=0.05)
        fish = ewa.Camera.from_opencv(k, distortion=[0.1, 0.01], fisheye=True)
        np.testing.assert_array_equal(fish.distortion, [0.1, 0.01, 0, 0])
        self.assertFalse(np.array_equal(ewa.undistort(ramp, fish), plain))

    def test_pinhole(self) -> None:
        matrix = np.array([[0, -1, 0, 0.5], [0, 0, -1, 1], [1, 0, 0, 2], [0, 0, 0, 1.0]])
        camera = ewa.Camera([[500, 0, 320], [0, 510, 240], [0, 0, 1]], matrix, (640, 480))
        np.testing.assert_array_equal(camera.world_to_camera, matrix)
        np.testing.assert_array_equal(camera.K, [[500, 0, 320], [0, 510, 240], [0, 0, 1]])
        np.testing.assert_allclose(camera.eye, -matrix[:3, :3].T @ matrix[:3, 3])
        self.assertEqual(camera, pickle.loads(pickle.dumps(camera)))
        np.testing.assert_array_equal(camera.resized(320, 120).K, [[250, 0, 160], [0, 127.5, 60], [0, 0, 1]])
        self.assertEqual(len({camera, camera.resized(640, 480)}), 1)
        looking = ewa.Camera.look_at((0, -3, 0), (0, 0, 0))
        np.testing.assert_allclose(looking.world_to_camera[:3, :3], [[1, 0, 0], [0, 0, -1], [0, 1, 0]], atol=1e-15)
        np.testing.assert_allclose(looking.orbit((0, 0, 0), (0, 0, 1), 90).eye, [3, 0, 0], atol=1e-12)

    def test_wrong_numbers(self) -> None:
        eye = np.eye(4)
        wrong: list[Any] = [
            lambda: ewa.Camera(np.eye(2)), lambda: ewa.Camera([[1, 1, 0], [0, 1, 0], [0, 0, 1]]),
            lambda: ewa.Camera([[-1, 0, 0], [0, 1, 0], [0, 0, 1]]), lambda: ewa.Camera(world_to_camera=np.zeros((4, 4))),
            lambda: ewa.Camera(world_to_camera=np.full((4, 4), np.nan)), lambda: ewa.Camera(world_to_camera=eye[:2]),
            lambda: ewa.Camera(size=(0, 1)), lambda: ewa.Camera(size=(-5, 5)), lambda: ewa.Camera(size=(1e9, 1)),
            lambda: ewa.Camera(size=(70000, 1)), lambda: ewa.Camera(fov=0), lambda: ewa.Camera(fov=180),
            lambda: ewa.Camera(fov=float("nan")), lambda: ewa.Camera(ortho=-1), lambda: ewa.Camera(fov=3, ortho=3),
            lambda: ewa.Camera.look_at((0, 0, 0), (0, 0, 0)), lambda: ewa.Camera.look_at((0, 0), (0, 0, 0)),
            lambda: ewa.Camera.frame([[0, 0, 0], [1, 1, np.inf]]), lambda: ewa.Camera().orbit((0, 0, 0), (0, 0, 0), 5),
            lambda: ewa.Camera.frame([[0, 0, 0], [1, 1, 1]], "sideways"), lambda: ewa.Camera().resized(0, 4)]
        for i, make in enumerate(wrong):
            with self.subTest(i), self.assertRaises(ewa.Error):
                make()

    def test_files_and_paths(self) -> None:
        keys = [ewa.Camera.look_at((np.cos(a), np.sin(a), 1), (0, 0, 0), size=(64, 48)) for a in (0, 1, 2)]
        ewa.save_cameras(self.path("keys.json"), keys)
        self.assertEqual(ewa.cameras(self.path("keys.json")), keys)
        path = ewa.CameraPath(keys)
        self.assertEqual(path.at(1), keys[1])
        np.testing.assert_allclose(path.at(0.5).eye, [np.cos(0.5), np.sin(0.5), 1], atol=0.1)
        with open(self.path("poses.tum"), "w", encoding="utf-8") as file:
            file.write("0 1 2 3 0 0 0 1\n1 4 5 6 0 0 0 1\n")
        np.testing.assert_allclose([camera.eye for camera in ewa.cameras(self.path("poses.tum"), keys[0])],
                                   [[1, 2, 3], [4, 5, 6]])
        self.assertEqual(ewa.cameras(self.path("poses.tum"), self.path("keys.json"))[0].size, (64, 48))
        for wrong in (lambda: ewa.CameraPath([]), lambda: path.at(float("nan")), lambda: ewa.save_cameras("a", []),
                      lambda: ewa.cameras(self.path("nothing.json"))):
            with self.assertRaises(ewa.Error):
                wrong()


class Pictures(Case):
    def setUp(self) -> None:
        super().setUp()
        self.cloud = ewa.generate("sphere", 4000)
        self.camera = ewa.Camera.look_at((0, -4, 0), (0, 0, 0), size=(80, 60))

    def test_planes(self) -> None:
        image = ewa.render(self.cloud, self.camera, planes="all", background=(0, 0, 1))
        self.assertAlmostEqual(float(image.depth[30, 40]), 3, delta=0.01)
        np.testing.assert_allclose(image.normal[30, 40], [0, -1, 0], atol=0.1)
        np.testing.assert_array_equal(image.rgba8[0, 0], [0, 0, 255, 255])
        self.assertTrue(np.isinf(image.depth[0, 0]) and image.coverage[0, 0] == 0)
        self.assertEqual(image.stats["splat_count"], 4000)
        again = ewa.render(self.cloud, self.camera, planes="rgba8", out=image, background="#00f")
        self.assertIs(again.rgba8, image.rgba8)
        png = again._repr_png_()
        self.assertTrue(png is not None and png.startswith(b"\x89PNG"))
        image.save(self.path("a.jpg"))
        np.testing.assert_allclose(ewa.read_image(self.path("a.jpg"))[5, 5], [0, 0, 1], atol=0.05)
        image.save(self.path("a.exr"))
        np.testing.assert_array_equal(ewa.read_image(self.path("a.exr")).shape, (60, 80, 4))

    def test_several_sources_are_one(self) -> None:
        halves = [self.cloud.filter("x<0").surfels(), self.cloud.filter("x>=0").surfels()]
        one, two = (np.asarray(ewa.render(halves[::step], self.camera, shading="none")) for step in (1, -1))
        np.testing.assert_array_equal(one, two)

    def test_paths_are_taken_where_scenes_are(self) -> None:
        cloud = ewa.generate("torus", 2000)
        cloud.save(self.path("torus.ply"))
        ewa.generate("sphere", 1000).save(self.path("ball.ply"))
        files = [self.path("torus.ply"), pathlib.Path(self.path("ball.ply"))]
        read = [ewa.read(file) for file in files]
        for things, same in ((files[0], read[0]), (files[1], read[1]), (files, read), ([files[0], read[1]], read)):
            camera = ewa.Camera.frame(things, size=(60, 40))
            self.assertEqual(np.asarray(camera.world_to_camera).tolist(),
                             np.asarray(ewa.Camera.frame(same, size=(60, 40)).world_to_camera).tolist())
            picture = ewa.render(things, size=(60, 40))
            self.assertTrue(np.array_equal(picture.rgba8, ewa.render(same, size=(60, 40)).rgba8))
        self.assertGreater(np.ptp(ewa.render(files[0], size=(60, 40), radius_scale=0.5).rgba8), 0)
        self.assertEqual(len(ewa.Scene(*files)), 2)
        self.assertEqual(len(ewa.merge(files)), 3000)
        self.assertEqual(len(ewa.as_cloud(files[1])), 1000)
        self.assertTrue(np.array_equal(ewa.csg(*files)["position"], ewa.csg(*read)["position"]))
        with self.assertRaisesRegex(TypeError, "nothing is drawn of builtins.int"):
            ewa.merge([files[0], 3])  # type: ignore[list-item]
        camera = ewa.Camera.frame(read[0], size=(30, 20))
        ones = np.ones((20, 30, 4), np.float32)
        self.assertTrue(np.array_equal(ewa.render_backward(files[0], camera, rgba=ones, by="color").color,
                                       ewa.render_backward(read[0], camera, rgba=ones, by="color").color))
        with self.assertRaisesRegex(ewa.FileError, "nowhere"):
            ewa.render(self.path("nowhere.ply"))
        with self.assertRaisesRegex(TypeError, "nothing is drawn of builtins.int"):
            ewa.render([files[0], 3])  # type: ignore[list-item]
        with self.assertRaisesRegex(TypeError, "nothing is drawn of"):
            ewa.Scene(3)  # type: ignore[arg-type]

    def test_materials_and_environment(self) -> None:
        plain = ewa.render(self.cloud, self.camera, shading="phong")
        shiny = ewa.render(self.cloud, self.camera, materials=[{"specular": 2.0, "reflection": 1.0}],
                           environment=np.ones((8, 16, 3), np.float32))
        self.assertGreater(np.asarray(shiny).mean(), np.asarray(plain).mean())

    def test_messages_name_the_range(self) -> None:
        with self.assertRaisesRegex(ewa.ArgumentError, r"opacity: 2.0 is outside \[0, 1\]"):
            ewa.render(self.cloud, self.camera, opacity=2)
        with self.assertRaisesRegex(ewa.ArgumentError, r"opacity: -0.1 is outside \[0, 1\]"):
            ewa.render(self.cloud, self.camera, opacity=-0.1)
        with self.assertRaisesRegex(ewa.ArgumentError, r"edge_threshold: 0.0 is outside \(0, 4\]"):
            ewa.render(self.cloud, self.camera, edge_threshold=0)
        with self.assertRaisesRegex(ewa.ArgumentError, r"passes: 2 is outside 1\|3"):
            ewa.render(self.cloud, self.camera, passes=2)

    def test_wrong_options(self) -> None:
        wrong: list[dict[str, Any]] = [
            {"kernel": "square"}, {"kernel": 9}, {"kernel": 1.5}, {"opacity": 2}, {"opacity": "1"},
            {"prefilter_px": float("nan")}, {"passes": 2}, {"passes": -3}, {"edge_antialiasing": 1}, {"background": "red?"},
            {"background": (1, 2)}, {"background": (-1, 0, 0)}, {"background": (np.nan, 0, 0)}, {"lights": [(1, 2)]},
            {"lights": [(1, 0, 0)] * 9}, {"layers": -1}, {"layers": "some"}, {"level": 8}, {"planes": "red"},
            {"planes": ()}, {"section_planes": [(0, 0, 0, 1)]}, {"section_planes": [(1, 0, 0, 1)] * 9},
            {"section_box": [1, 2]}, {"materials": []}, {"materials": [{"ambient": -1}]}, {"environment_up": (0, 0)},
            {"environment_up": (0, 0, 0)}, {"size": (0, 0)}, {"backend": "tea"}, {"ambient": 1e300},
            {"out": ewa.render(self.cloud, size=(8, 8))}, {"cutoff": 5}, {"radius_scale": 0}]
        for options in wrong:
            with self.subTest(str(options)[:60]), self.assertRaises(ewa.Error):
                ewa.render(self.cloud, self.camera, **options)
        more: list[dict[str, Any]] = [{"light_count": 3}, {"nothing": 1}, {"materials": [{"nothing": 1}]}]
        for options in more:
            with self.subTest(str(options)), self.assertRaises(TypeError):
                ewa.render(self.cloud, self.camera, **options)
        for scene in (3, None, [None]):
            with self.assertRaises(TypeError):
                ewa.render(scene, self.camera)  # type: ignore[arg-type]
        with self.assertRaises(ewa.ArgumentError):
            ewa.render([], self.camera)
        with self.assertRaisesRegex(TypeError, "an ewa.Camera, not ndarray$"):
            ewa.render(self.cloud, np.eye(4))  # type: ignore[arg-type]
        for draw in (ewa.render, ewa.render_backward):
            with self.assertRaisesRegex(TypeError, r"not str; ewa.cameras\(\) reads those of a file"):
                draw(self.cloud, "camera.json")  # type: ignore[operator]


class Others(Case):
    def test_volumes(self) -> None:
        grid = np.linspace(-1, 1, 24)
        z, y, x = np.meshgrid(grid, grid, grid, indexing="ij")
        field = np.exp(-4 * (x * x + y * y + z * z)).astype(np.float32)
        volume = ewa.Volume(field, spacing=0.1)
        self.assertTrue(np.shares_memory(volume.voxels, field))
        volume.save(self.path("a.nrrd"))
        again = ewa.read_volume(self.path("a.nrrd"))
        np.testing.assert_array_equal(again.voxels, field)
        np.testing.assert_allclose(again.index_to_world, volume.index_to_world)
        transfer = ewa.Transfer([(0.2, (1, 1, 1), 0), (1, (1, 0.5, 0), 2)])
        transfer.save(self.path("t.json"))
        self.assertEqual(len(ewa.Transfer.of(volume, self.path("t.json")).points), 2)
        image = ewa.render_volume(volume, transfer=transfer, size=(40, 40), planes=("rgba8", "depth"))
        self.assertGreater(int(image.rgba8[20, 20, 0]), int(image.rgba8[0, 0, 0]))
        surface = ewa.render(ewa.generate("sphere", 2000, size_world=0.5), image.camera, planes=("rgba", "depth"))
        ewa.render_volume(volume, image.camera, transfer=transfer, surfaces=surface)
        wrong: list[Any] = [np.zeros((2, 2)), np.full((2, 2, 2), 2**24 + 1), np.zeros((0, 2, 2), np.uint8), "a", np.zeros(8, np.uint8)]
        for voxels in wrong:
            with self.assertRaises(ewa.ArgumentError):
                ewa.Volume(voxels)
        for make in (lambda: ewa.Volume(field, spacing=0), lambda: ewa.Volume(field, index_to_world=np.zeros((3, 4)))
                     and ewa.render_volume(ewa.Volume(field, index_to_world=np.zeros((3, 4)))),
                     lambda: ewa.Transfer([(1, (0, 0, 0), 0)]), lambda: ewa.render_volume(volume, planes="axes"),
                     lambda: ewa.render_volume(volume, transfer=ewa.Transfer([(1, (0, 0, 0), 1), (0, (0, 0, 0), 1)])),
                     lambda: ewa.render_volume(volume, transfer="nothing"),
                     lambda: ewa.render_volume(ewa.Volume(np.full((4, 4, 4), np.nan, np.float32))),
                     lambda: ewa.render_volume(volume, surfaces=image)):
            with self.assertRaises(ewa.Error):
                make()

    def test_depth_images(self) -> None:
        camera = ewa.Camera(size=(40, 30))
        depth, color = np.full((30, 40), 2000, np.uint16), np.full((30, 40, 3), 90, np.uint8)
        image = ewa.warp(ewa.DepthImage(depth, color, camera, scale=1000), shift=(0.2, 0, 0))
        self.assertTrue(0 < (image.holes > 0).mean() < 0.5)
        np.testing.assert_array_equal(image.rgba8[15, 10], [90, 90, 90, 255])
        wrong: list[Any] = [
            ewa.DepthImage(depth[:5], color, camera), ewa.DepthImage(depth, color[:5], camera),
            ewa.DepthImage(depth, color, camera, kind="far"), ewa.DepthImage(depth, color, camera, scale=0),
            ewa.DepthImage(depth.astype(np.int32), color, camera), ewa.DepthImage(depth, color.astype(float), camera),
            ewa.DepthImage(depth, color, camera, kind="disparity")]
        for source in wrong:
            with self.assertRaises(ewa.Error):
                ewa.warp(source)
        with self.assertRaises(TypeError):
            ewa.warp([])

    def test_textures(self) -> None:
        picture = np.zeros((20, 30, 3), np.uint8)
        picture[:, :15] = 255
        image = ewa.texture(picture, corners=[[0, 0], [30, 0], [30, 20], [0, 20]])
        np.testing.assert_allclose(image.rgba[10, [5, 25], 0], [1, 0], atol=1e-3)
        seen = ewa.texture(picture, camera=ewa.Camera.look_at((0, 0, 3), (0, 0, 0), (0, 1, 0), size=(60, 40)))
        self.assertAlmostEqual(float(seen.rgba[20, 25, 0]), 1, delta=0.01)
        wrong: list[dict[str, Any]] = [
            {}, {"corners": [[0, 0]] * 4}, {"homography": np.zeros((3, 3))}, {"corners": np.zeros((3, 2))},
            {"corners": np.full((4, 2), np.nan)}, {"homography": np.eye(3), "camera": ewa.Camera()},
            {"homography": np.eye(3), "size": (0, 0)}]
        for options in wrong:
            with self.subTest(str(options)[:40]), self.assertRaises(ewa.Error):
                ewa.texture(picture, **options)


if __name__ == "__main__":
    unittest.main()
