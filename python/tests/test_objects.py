# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""What objects of Python are expected to do: pickles and copies, planes that are there or not, colours of other maps."""
from __future__ import annotations

import copy
import pickle
import unittest
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from typing import Any

import numpy as np

import ewa
from common import Case


def drawn(thing: Any) -> bytes:
    """A picture, also in another process."""
    return ewa.render(thing, size=(64, 48)).rgba8.tobytes()


class Pickles(Case):
    def things(self) -> dict[str, Any]:
        rng = np.random.default_rng(1)
        scan = ewa.generate("terrain", 2000)
        scan["classification"] = np.arange(2000, dtype=np.uint8) % 3
        scan.save(self.path("a.las"))
        ewa.save_image(self.path("p.png"), rng.random((8, 8, 3)).astype(np.float32))
        corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
        quaternions = rng.normal(size=(200, 4))
        gaussians = ewa.Gaussians(rng.normal(size=(200, 3)), np.full((200, 3), 0.2),
                                  quaternions / np.linalg.norm(quaternions, axis=1)[:, None], np.full(200, 0.7),
                                  rng.normal(size=(200, 4, 3)), origin=(1, 2, 3), antialiased=True)
        gaussians.save(self.path("g.ply"))
        ewa.build_octree(self.path("a.las"), self.path("a.copc.laz"))
        return {
            "cloud": ewa.generate("torus", 2000), "las": ewa.read(self.path("a.las")),
            "wide": ewa.Cloud(rng.normal(size=(500, 3)), colors=np.full((500, 3), 2**31, np.uint32), origin=(5e5, 6e6, 1)),
            "mesh": ewa.Mesh(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], colors=np.eye(4, 3), normals=-np.eye(4, 3),
                             texcoords=corners[:, :2], materials=[((1, 1, 1, 1), None), ((1, 0.5, 1, 1), self.path("p.png"))],
                             triangle_materials=[0, 1, 1, 0], heat=corners[:, 2]),
            "volume": ewa.generate_volume("ball", dims=[12, 14, 16]), "gaussians": gaussians,
            "read": ewa.read_gaussians(self.path("g.ply")), "octree": ewa.Octree(self.path("a.copc.laz"))}

    def test_draw_the_same(self) -> None:
        for name, thing in self.things().items():
            with self.subTest(name):
                theirs = drawn(thing)
                self.assertEqual(drawn(pickle.loads(pickle.dumps(thing))), theirs)
                self.assertEqual(drawn(copy.deepcopy(thing)), theirs)
                self.assertEqual(drawn(copy.copy(thing)), theirs)

    def test_keep_all(self) -> None:
        cloud = self.things()["las"]
        again = pickle.loads(pickle.dumps(cloud))
        self.assertEqual(again.keys(), cloud.keys())
        for name in cloud:
            self.assertEqual(again[name].dtype, cloud[name].dtype)
            np.testing.assert_array_equal(again[name], cloud[name])
        np.testing.assert_array_equal(again.origin, cloud.origin)
        self.assertEqual(again.notes, cloud.notes)
        np.testing.assert_array_equal(pickle.loads(pickle.dumps(self.things()["mesh"])).attributes["heat"], [0, 0, 0, 1])
        cloud.save(self.path("b.las"))
        again.save(self.path("c.las"))
        self.assertEqual(self.bytes("b.las"), self.bytes("c.las"))
        transfer = ewa.Transfer([(0.3, (0.1, 0.2, 1), 0), (1, (1, 1, 1), 1)])
        self.assertEqual(pickle.loads(pickle.dumps(transfer)).points, transfer.points)
        image = ewa.render(cloud, size=(32, 24), planes="all")
        other = pickle.loads(pickle.dumps(image))
        self.assertEqual((other.planes, other.camera, other.stats), (image.planes, image.camera, image.stats))
        for kind in (ewa.ArgumentError("a"), ewa.ClosedError("b"), ewa.FileError("c", "EWA_ERROR_IO")):
            found = pickle.loads(pickle.dumps(kind))
            self.assertEqual((type(found), str(found), found.status), (type(kind), str(kind), kind.status))

    def test_in_another_process(self) -> None:
        cloud = ewa.generate("torus", 2000)
        with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
            self.assertEqual(pool.submit(drawn, cloud).result(), drawn(cloud))

    def test_resident_things_say_why_not(self) -> None:
        cloud = ewa.generate("torus", 200)
        for thing in (cloud.surfels(), ewa.Scene(cloud), ewa.default_context(), ewa.Renderer(),
                      ewa.Voxels(ewa.generate_volume("ball", dims=[12, 12, 12]))):
            with self.subTest(type(thing).__name__), self.assertRaisesRegex(TypeError, "no pickle is made"):
                pickle.dumps(thing)


class Images(Case):
    def test_planes(self) -> None:
        image = ewa.render(ewa.generate("torus", 500), size=(32, 24), planes=("rgba", "depth"))
        self.assertEqual(image.planes, ("rgba", "depth"))
        self.assertEqual(image.depth.dtype, np.float32)
        with self.assertRaisesRegex(ewa.ArgumentError, "normal was not drawn"):
            image.normal
        with self.assertRaisesRegex(ewa.ArgumentError, "rgba8 was not drawn"):
            image.save(self.path("a.jpg"))
        with self.assertRaisesRegex(ewa.ArgumentError, "written to .png, .jpg, .exr and .pfm"):
            ewa.render(ewa.generate("torus", 500), size=(32, 24)).save(self.path("a.webp"))
        image.save(self.path("a.exr"))
        self.assertEqual(ewa.read_image(self.path("a.exr")).shape[:2], (24, 32))
        self.assertEqual(np.asarray(image).dtype, np.float32)

    def test_jpeg(self) -> None:
        image = ewa.render(ewa.generate("torus", 5000), size=(64, 48))
        for name in ("a.jpg", "b.JPEG"):
            image.save(self.path(name))
            self.assertGreater(ewa.compare_images(self.path(name), image).psnr_db, 30)
        small, large = image.encode(".jpg", quality=20), image.encode(".jpg", quality=100)
        self.assertLess(len(small), len(image.encode(".jpg")))
        self.assertLess(len(image.encode(".jpg")), len(large))
        self.assertEqual(image.encode(".jpg", quality=95), image.encode(".jpg"))
        image.save(self.path("c.jpg"), quality=20)
        with open(self.path("c.jpg"), "rb") as file:
            self.assertEqual(file.read(), small)
        for quality in (101, -1, 0.5):
            with self.assertRaisesRegex(ewa.ArgumentError, "quality"):
                image.encode(".jpg", quality=quality)  # type: ignore[arg-type]
        with self.assertRaisesRegex(ewa.ArgumentError, r"\.jpg alone"):
            image.save(self.path("a.png"), quality=90)


class Colormaps(Case):
    def setUp(self) -> None:
        super().setUp()
        self.cloud = ewa.generate("torus", 3000)

    def test_lists(self) -> None:
        z = self.cloud.scalar("z")
        made = self.cloud.color_by("z", [[0, 0, 0], [255, 255, 255]])["color"]
        np.testing.assert_allclose(made, self.cloud.color_by("z", "gray")["color"], atol=1)
        self.assertTrue((np.diff(made[np.argsort(z), 0].astype(int)) >= 0).all())
        red = self.cloud.color_by("z", [(1.0, 0, 0)], range=(0, 1))["color"]
        self.assertEqual(set(map(tuple, red.tolist())), {(255, 0, 0)})
        np.testing.assert_array_equal(self.cloud.color_by("z", ["#ff0000", (0, 0.2, 1.0), "white"])["color"],
                                      self.cloud.color_by("z", [[1.0, 0, 0], [0, 0.2, 1.0], [1, 1, 1]])["color"])
        holes = np.where(z > 0, z, np.nan)
        self.cloud["height"] = holes
        with self.assertWarnsRegex(ewa.EwaWarning, "not finite"):
            ours = self.cloud.color_by("height", [[0, 0, 0], [1.0, 1, 1]])["color"]
        with self.assertWarnsRegex(ewa.EwaWarning, "not finite"):
            theirs = self.cloud.color_by("height", "gray")["color"]
        np.testing.assert_array_equal(ours[z <= 0], theirs[z <= 0])
        wrong: list[Any] = ["no such map", [[1, 2]], [], object(), ["no such colour"]]
        for colormap in wrong:
            with self.assertRaises(ewa.ArgumentError):
                self.cloud.color_by("z", colormap)

    def test_matplotlib(self) -> None:
        try:
            import matplotlib
        except ImportError:
            self.skipTest("matplotlib is not installed; Debian: python3-matplotlib")
        theirs = matplotlib.colormaps["viridis"]
        np.testing.assert_allclose(self.cloud.color_by("z", theirs)["color"], self.cloud.color_by("z", "viridis")["color"],
                                   atol=3)
        z = self.cloud.scalar("z")
        for name in ("Spectral", "tab10", "jet"):
            expected = matplotlib.colormaps[name](np.clip((z + 0.2) / 0.4, 0, 1))[:, :3]
            found = self.cloud.color_by("z", name, range=(-0.2, 0.2))["color"]
            self.assertGreater((np.abs(found - 255 * expected) <= 1).all(1).mean(), 0.999, name)


if __name__ == "__main__":
    unittest.main()
