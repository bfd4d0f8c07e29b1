# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""The same bytes from the package as from the program, for jobs of docs/cli.md."""
from __future__ import annotations

import struct

import numpy as np

import ewa
from common import Case


class SameBytes(Case):
    def generate(self, name: str, kind: str, count: int, *more: str) -> None:
        self.run_program("generate", kind, "-o", name, "-n", str(count), *more)

    def same(self, ours: str, theirs: str) -> None:
        a, b = self.bytes(ours), self.bytes(theirs)
        self.assertGreater(len(a), 100)
        self.assertEqual(a, b, f"{ours} and {theirs} differ: {len(a)}, {len(b)} bytes")

    def test_render_without_options(self) -> None:
        for kind in ("torus", "sphere", "terrain", "cube"):
            with self.subTest(kind):
                self.generate("scan.ply", kind, 8000)
                self.run_program("render", "scan.ply", "-o", "theirs.png")
                ewa.render(ewa.read(self.path("scan.ply"))).save(self.path("ours.png"))
                self.same("ours.png", "theirs.png")

    def test_render_positions_only(self) -> None:
        self.generate("scan.ply", "torus", 9000, "--positions-only")
        self.run_program("render", "scan.ply", "-o", "theirs.png", "--up", "0,0,1")
        cloud = ewa.read(self.path("scan.ply"))
        camera = ewa.Camera.frame(cloud.estimate(), up="z")
        ewa.render(cloud, camera, background="white").save(self.path("ours.png"))
        self.same("ours.png", "theirs.png")

    def test_render_view_size_transparent(self) -> None:
        self.generate("scan.ply", "cube", 9000, "--sharp")
        self.run_program("render", "scan.ply", "-o", "theirs.png", "--view", "right", "--size", "640x360",
                         "--background", "transparent", "--azimuth", "30", "--elevation", "20")
        cloud = ewa.read(self.path("scan.ply"))
        camera = ewa.Camera.frame(cloud, "right", size=(640, 360), azimuth=30, elevation=20)
        ewa.render(cloud, camera, background="transparent").save(self.path("ours.png"))
        self.same("ours.png", "theirs.png")

    def test_render_tiles_by_height(self) -> None:
        self.generate("tile1.ply", "terrain", 70000)
        self.generate("tile2.ply", "sphere", 70000, "--extent", "0.5")
        self.run_program("render", "tile1.ply", "tile2.ply", "-o", "theirs.png", "--color-by", "z", "--colormap",
                         "turbo", "--shading", "lambert")
        cloud = ewa.read(self.path("tile1.ply"), self.path("tile2.ply")).color_by("z", "turbo")
        ewa.render(cloud, background="white", shading="lambert").save(self.path("ours.png"))
        self.same("ours.png", "theirs.png")

    def test_panoramas(self) -> None:
        self.generate("scan.ply", "torus", 8000)
        scan = ewa.read(self.path("scan.ply"))
        for kind, size in (("equirectangular", (120, 60)), ("fisheye", (60, 60))):
            self.run_program("render", "scan.ply", "-o", "theirs.png", "--panorama", kind, "--size", f"{size[0]}x{size[1]}")
            ewa.render(scan, panorama=kind, size=size).save(self.path("ours.png"))
            self.same("ours.png", "theirs.png")
            # A camera that is tilted: what is up in the scene is upright.
            tilted = ewa.Camera.look_at((0.1, 0, 0), (1, 0.3, 0.8), size=size)
            tilted.save(self.path("camera.json"))
            self.run_program("render", "scan.ply", "-o", "theirs.png", "--panorama", kind, "--camera", "camera.json")
            ewa.Scene(self.path("scan.ply")).render(tilted, panorama=kind).save(self.path("ours.png"))
            self.same("ours.png", "theirs.png")
        image = ewa.render(scan, ewa.Camera.look_at((0, 0, 0), (1, 0, 0), size=(60, 60)), planes=("rgba", "depth"),
                           panorama={"kind": "fisheye", "fov_deg": 360}, background="transparent")
        hit = image.rgba[..., 3] == 1
        # Nothing is nearer than the ring's hole is wide.
        self.assertGreater(image.depth[hit].min(), 0.1)
        with self.assertRaises(ewa.ArgumentError):
            ewa.render(scan, panorama="cylinder")

    def test_render_exr_with_camera(self) -> None:
        self.generate("scan.ply", "csg", 9000)
        camera = ewa.Camera.look_at((2, -1.5, 1), (0, 0, 0), size=(200, 150), fov=40)
        camera.save(self.path("camera.json"))
        self.run_program("render", "scan.ply", "-o", "theirs.exr", "--camera", "camera.json", "--aov",
                         "depth=theirs.pfm,normal=theirs_normal.exr")
        [again] = ewa.cameras(self.path("camera.json"))
        self.assertEqual(camera, again)
        image = ewa.render(ewa.read(self.path("scan.ply")), again, planes="all", background="white")
        image.save(self.path("ours.exr"))
        image.save_plane("depth", self.path("ours.pfm"))
        image.save_plane("normal", self.path("ours_normal.exr"))
        for name in (".exr", ".pfm", "_normal.exr"):
            self.same("ours" + name, "theirs" + name)

    def test_render_glass_cut_and_lit(self) -> None:
        self.generate("scan.ply", "torus", 8000)
        self.run_program("render", "scan.ply", "-o", "theirs.png", "--opacity", "0.4", "--clip-plane", "0,1,0,0.1",
                         "--clip-box", "-1,-1,-1,1,1,0.2", "--light", "1,-1,2,2,1.5,1", "--light", "-1,0,0", "--shading",
                         "phong", "--edl", "0.5", "--eye", "3,2,2", "--target", "0,0,0", "--up", "0,0,1", "--fov", "25")
        camera = ewa.Camera.look_at((3, 2, 2), (0, 0, 0), fov=25)
        image = ewa.render(ewa.read(self.path("scan.ply")), camera, background="white", opacity=0.4, shading="phong",
                           section_box=[[-1, -1, -1], [1, 1, 0.2]], section_planes=[(0, 1, 0, 0.1)], eye_dome=0.5,
                           lights=[(1, -1, 2, 2, 1.5, 1), (-1, 0, 0)])
        image.save(self.path("ours.png"))
        self.same("ours.png", "theirs.png")

    def test_render_points_and_gaps(self) -> None:
        self.generate("scan.ply", "sphere", 4000, "--radius-scale", "0.3")
        self.run_program("render", "scan.ply", "-o", "theirs.png", "--view", "front", "--up", "0,0,1")
        cloud = ewa.read(self.path("scan.ply"), context=ewa.Context(message_level="note"))
        camera = ewa.Camera.frame(cloud, "front", "z")
        with self.assertLogs("ewa") as said:
            ewa.render(cloud, camera, background="white").save(self.path("ours.png"))
        self.assertTrue(any("leaves gaps" in line for line in said.output), said.output)
        self.same("ours.png", "theirs.png")
        self.run_program("render", "scan.ply", "-o", "theirs.png", "--view", "front", "--up", "0,0,1", "--point-size",
                         "3", "--layers", "exact")
        ewa.render(cloud, camera, background="white", point_size_px=3, layers="exact").save(self.path("ours.png"))
        self.same("ours.png", "theirs.png")

    def test_orthographic_camera(self) -> None:
        self.generate("scan.ply", "torus", 8000)
        self.run_program("render", "scan.ply", "-o", "theirs.png", "--ortho", "3", "--view", "top")
        cloud = ewa.read(self.path("scan.ply"))
        ewa.render(cloud, ewa.Camera.frame(cloud, "top", ortho=3), background="white").save(self.path("ours.png"))
        self.same("ours.png", "theirs.png")

    def test_surfels(self) -> None:
        self.generate("scan.ply", "sphere", 6000, "--positions-only")
        self.run_program("surfels", "scan.ply", "-o", "theirs.ply", "--viewpoint", "0,0,1.7", "--outliers", "3")
        cloud = ewa.read(self.path("scan.ply")).estimate(viewpoint_world=(0, 0, 1.7), outlier_factor=3)
        cloud.save(self.path("ours.ply"))
        self.same("ours.ply", "theirs.ply")

    def test_convert(self) -> None:
        self.generate("scan.ply", "terrain", 20000)
        box = ("-0.5,-0.5,-1,0.5,0.5,1", [[-0.5, -0.5, -1], [0.5, 0.5, 1]])
        for name, more, options in (
                ("text.ply", ("--ascii",), {"ply_encoding": "ascii"}),
                ("part.las", ("--crop", box[0]), {"crop": box[1]}),
                ("thin.laz", ("--filter", "z>0.01", "--min-distance", "0.02"), {"filter": "z>0.01", "distance": 0.02}),
                ("voxels.csv", ("--voxel", "0.1"), {"voxel": 0.1})):
            with self.subTest(name):
                self.run_program("convert", "scan.ply", "-o", "theirs_" + name, *more)
                ewa.convert(self.path("scan.ply"), self.path("ours_" + name), **options)  # type: ignore[arg-type]
                self.same("ours_" + name, "theirs_" + name)

    def test_features(self) -> None:
        self.generate("scan.ply", "csg", 12000, "--positions-only")
        self.run_program("features", "scan.ply", "-o", "theirs.ply", "--angle", "45")
        ewa.read(self.path("scan.ply")).features(angle_deg=45).save(self.path("ours.ply"))
        self.same("ours.ply", "theirs.ply")

    def test_csg(self) -> None:
        self.generate("cube.ply", "cube", 6000)
        self.generate("ball.ply", "sphere", 6000, "--extent", "2.4")
        self.run_program("csg", "cube.ply", "ball.ply", "--op", "difference", "-o", "theirs.ply")
        cube, ball = (ewa.read(self.path(name)) for name in ("cube.ply", "ball.ply"))
        ewa.csg(cube, ball, "difference").save(self.path("ours.ply"))
        self.same("ours.ply", "theirs.ply")

    def test_sample(self) -> None:
        corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], np.float32)
        with open(self.path("part.stl"), "wb") as file:
            file.write(bytes(80) + struct.pack("<I", 4))
            for face in ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)):
                file.write(struct.pack("<12fH", 0, 0, 0, *corners[list(face)].ravel(), 0))
        self.run_program("sample", "part.stl", "-o", "theirs.ply", "--points", "5000")
        ewa.sample(self.path("part.stl"), point_count=5000).save(self.path("ours.ply"))
        self.same("ours.ply", "theirs.ply")
        self.run_program("render", "part.stl", "-o", "theirs.png", "--size", "200x200")
        ewa.render(ewa.read(self.path("part.stl")), background="white", size=(200, 200)).save(self.path("ours.png"))
        self.same("ours.png", "theirs.png")

    def test_volume(self) -> None:
        self.run_program("generate", "vessels", "-o", "vessels.nrrd", "--dims", "48")
        for preset in ("auto", "fog"):
            self.run_program("volume", "vessels.nrrd", "-o", "theirs.png", "--size", "320x200", "--transfer", preset)
            image = ewa.render_volume(ewa.read_volume(self.path("vessels.nrrd")), transfer=preset, size=(320, 200))
            image.save(self.path("ours.png"))
            self.same("ours.png", "theirs.png")

    def test_raw_volume(self) -> None:
        for dims in ((24, 20, 16), (32, 32, 2), (2, 30, 30)):
            with self.subTest(dims):
                k, j, i = np.indices(dims[::-1])
                voxels = (127 + 120 * np.sin(i / 5 + 1) * np.cos(j / 7) * np.sin(k / 3 + 0.5)).astype(np.uint8)
                voxels.tofile(self.path("v.raw"))
                self.run_program("volume", "v.raw", "-o", "theirs.png", "--dims", ",".join(map(str, dims)), "--spacing",
                                 "1,1,2", "--size", "200x160")
                volume = ewa.read_volume(self.path("v.raw"), dims=dims, spacing=(1, 1, 2))
                ewa.render_volume(volume, size=(200, 160)).save(self.path("ours.png"))
                self.same("ours.png", "theirs.png")
                ours = ewa.render_volume(ewa.Volume(voxels, spacing=(1, 1, 2)), size=(200, 160)).rgba8
                assert ours is not None
                self.assertEqual(ours.tobytes(), ewa.render_volume(volume, size=(200, 160)).rgba8.tobytes())

    def test_cameras_that_nobody_chose(self) -> None:
        """Of clouds of all kinds the camera is that of the program, to the last bit."""
        rng = np.random.default_rng(7)
        u, v = np.meshgrid(np.linspace(-0.6, 0.6, 120), np.linspace(-0.4, 0.4, 80))
        z = 2 + 0.3 * np.sin(3 * u) + 0.2 * v
        ball = rng.normal(size=(9000, 3))
        ball /= np.linalg.norm(ball, axis=1)[:, None]
        box = rng.uniform(-1, 1, (9000, 3))
        box[np.arange(9000), rng.integers(3, size=9000)] = np.sign(rng.uniform(-1, 1, 9000))
        clouds = {
            "range image": np.stack([u * z, v * z, z], 2).reshape(-1, 3), "range image behind":
                np.stack([u * z, v * z, -z], 2).reshape(-1, 3), "strip": np.stack([u * z, 0.01 * v * z, z], 2).reshape(-1, 3),
            "ball": ball, "cone": ball * (1.2 - ball[:, 2:]) / 2, "tall": box * [1, 1, 4], "long": box * [6, 1, 1],
            "deep": box * [1, 1, 5] + [0, 0, 30], "map": box * [5, 5, 1] + [5e5, 6e6, 100], "flat": box * [1, 1, 1e-6],
            "wall": box * [1e-6, 1, 1], "ground": np.concatenate([box * [3, 3, 0.1], ball * 0.2]),
            "far points": np.concatenate([ball, [[500, 0, 0], [0, -900, 3]]]), "one place": np.ones((40, 3)),
            "table": np.concatenate([box * [2, 0.05, 1] + [0, 1, 0], box[::3] * [0.1, 1, 0.1]]),
            "many": np.repeat(rng.normal(size=(90000, 3)), 2, 0), "scattered": rng.normal(size=(150000, 3))}
        for name, points in clouds.items():
            for dtype in (np.float64, np.float32):
                with self.subTest(name, dtype=dtype.__name__):
                    cloud = ewa.Cloud(points.astype(dtype), normals=np.tile([0, 0, 1.0], (len(points), 1)),
                                      radius=rng.uniform(0.001, 0.1, len(points)).astype(np.float32))
                    cloud.save(self.path("c.ply"))
                    self.run_program("render", "c.ply", "-o", "theirs.png", "--save-camera", "theirs.json", "--size", "9x7",
                                     "--close-gaps", "off", "-q")
                    [theirs] = ewa.cameras(self.path("theirs.json"))
                    ours = ewa.Camera.frame(ewa.read(self.path("c.ply")), size=(9, 7))
                    np.testing.assert_array_equal(ours.world_to_camera, theirs.world_to_camera)
                    np.testing.assert_array_equal(ours.K, theirs.K)

    def test_octree(self) -> None:
        self.generate("scan.ply", "terrain", 60000)
        self.run_program("lod", "scan.ply", "-o", "theirs.copc.laz")
        ewa.build_octree(self.path("scan.ply"), self.path("ours.copc.laz"))
        self.same("ours.copc.laz", "theirs.copc.laz")
        self.run_program("render", "theirs.copc.laz", "-o", "theirs.png", "--levels", "always", "--memory", "64M", "--size",
                         "300x200", "--save-camera", "camera.json")
        octree = ewa.Octree(self.path("ours.copc.laz"))
        [camera] = ewa.cameras(self.path("camera.json"))
        octree.render(camera, background="white", memory_bytes=64 << 20).save(self.path("ours.png"))
        self.same("ours.png", "theirs.png")
        self.assertEqual(len(octree.read((-1, -1, -1), (0, 1, 1))) + len(octree.read((1e-9, -1, -1), (1, 1, 1))), 60000)
        self.assertEqual(len(octree), 60000)
        octree.close()
        with self.assertRaises(ewa.ClosedError):
            octree.sample()
        chosen = ewa.read(self.path("scan.ply"))
        chosen["user_data"] = (np.arange(60000) % 3).astype(np.uint8)
        chosen.save(self.path("chosen.ply"))
        self.run_program("lod", "chosen.ply", "-o", "theirs.copc.laz", "--attributes", "user_data")
        ewa.build_octree(self.path("chosen.ply"), self.path("ours.copc.laz"), attributes=["user_data"])
        self.same("ours.copc.laz", "theirs.copc.laz")
        self.run_program("render", "theirs.copc.laz", "-o", "theirs.png", "--levels", "always", "--lod-spacing", "8", "--size", "300x200",
                         "--color-by", "user_data")
        self.run_program("render", "theirs.copc.laz", "-o", "theirs.png", "--levels", "always", "--lod-spacing", "8", "--size", "300x200",
                         "--filter", "user_data == 1", "--threads", "1")

    def test_warp(self) -> None:
        rng = np.random.default_rng(3)
        depth = np.full((60, 80), 2, np.float32)
        depth[20:40, 30:60] = 1
        ewa.save_image(self.path("color.png"), rng.random((60, 80, 3)).astype(np.float32))
        ewa.save_image(self.path("depth.pfm"), depth)
        camera = ewa.Camera([[90, 0, 40], [0, 90, 30], [0, 0, 1]], size=(80, 60))
        self.run_program("warp", "color.png", "depth.pfm", "--intrinsics", "90,90,40,30", "--shift", "0.1,0,0.2", "-o",
                         "theirs.png", "--hole-mask", "theirs_holes.png")
        source = ewa.DepthImage(self.path("depth.pfm"), self.path("color.png"), camera)
        ewa.warp(source, shift=(0.1, 0, 0.2)).save(self.path("ours.png"))
        self.same("ours.png", "theirs.png")

    def gaussians(self, count: int = 400, degree: int = 2) -> ewa.Gaussians:
        random = np.random.default_rng(5)
        rotations = random.normal(size=(count, 4))
        rotations /= np.linalg.norm(rotations, axis=1, keepdims=True)
        return ewa.Gaussians(random.uniform(-1, 1, (count, 3)), random.uniform(0.02, 0.2, (count, 3)), rotations,
                             random.uniform(0.1, 1, count),
                             random.normal(scale=0.5, size=(count, (degree + 1) ** 2, 3)))

    def test_render_gaussians(self) -> None:
        self.gaussians().save(self.path("set.ply"))
        gaussians = ewa.read_gaussians(self.path("set.ply"))
        for projection in ("trained", "exact"):
            for order in ("auto", "centre", "ray"):
                self.run_program("render", "set.ply", "-o", "theirs.png", "--projection", projection, "--order", order,
                                 "--size", "320x180")
                ewa.render_gaussians(gaussians, projection=projection, order=order, size=(320, 180)).save(self.path("ours.png"))
                self.same("ours.png", "theirs.png")

    def test_render_mixture(self) -> None:
        self.gaussians().save(self.path("set.spz"))
        self.gaussians(100, 0).save(self.path("other.splat"))
        self.generate("ring.ply", "torus", 20000)
        self.run_program("generate", "ball", "-o", "ball.nrrd", "--dims", "24", "--extent", "3")
        camera = ewa.Camera.look_at((3, -2, -4), (0, 0, 0), up=(0, -1, 0), size=(300, 200), fov=40)
        camera.save(self.path("camera.json"))
        self.run_program("render", "set.spz", "other.splat", "ball.nrrd", "ring.ply", "-o", "theirs.png", "--camera",
                         "camera.json", "--transfer", "fog", "--shading", "phong", "--clip-plane", "1,0,0.5,0.3")
        cut = [(1, 0, 0.5, 0.3)]
        ring = ewa.render(ewa.read(self.path("ring.ply")), camera, background="transparent", shading="phong",
                          planes=("rgba", "depth"), section_planes=cut)
        fog = ewa.Voxels(ewa.read_volume(self.path("ball.nrrd")), "fog", level_count=1)
        fog._flat = False  # the program was told to shade
        sets = [ewa.read_gaussians(self.path(name)) for name in ("set.spz", "other.splat")]
        ewa.render_gaussians(sets, camera, volumes=fog, surfaces=ring, section_planes=cut).save(self.path("ours.png"))
        self.same("ours.png", "theirs.png")

    def test_texture(self) -> None:
        ewa.save_image(self.path("photo.png"), np.random.default_rng(4).random((48, 64, 3)).astype(np.float32))
        self.run_program("texture", "photo.png", "-o", "theirs.exr", "--corners", "8,4,60,1,63,47,2,40")
        ewa.texture(self.path("photo.png"), corners=[[8, 4], [60, 1], [63, 47], [2, 40]]).save(self.path("ours.exr"))
        a, b = ewa.read_image(self.path("ours.exr")), ewa.read_image(self.path("theirs.exr"))
        self.assertEqual(a.tobytes(), b.tobytes())
        self.run_program("texture", "photo.png", "-o", "theirs.pfm", "--homography", "1,0,8,0,1,3,0,0.01,1",
                         "--background", "1,0,0")
        image = ewa.texture(self.path("photo.png"), homography=[[1, 0, 8], [0, 1, 3], [0, 0.01, 1]],
                            background="1,0,0")
        image.save(self.path("ours.pfm"))
        self.same("ours.pfm", "theirs.pfm")
        for background in ("transparent", "#336699"):
            self.run_program("texture", "photo.png", "-o", "theirs.png", "--corners", "8,4,60,1,63,47,2,40", "--background", background)
            image = ewa.texture(self.path("photo.png"), corners=[[8, 4], [60, 1], [63, 47], [2, 40]], background=background)
            image.save(self.path("ours.png"))
            self.same("ours.png", "theirs.png")
            self.assertEqual(image._repr_png_(), image.encode())


if __name__ == "__main__":
    import unittest

    unittest.main()
