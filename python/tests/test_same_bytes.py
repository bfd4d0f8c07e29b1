# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""The same bytes from the package as from the program, for jobs of docs/cli.md."""
from __future__ import annotations

import struct
import warnings

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
                ewa.render(ewa.read(self.path("scan.ply")), background="white").save(self.path("ours.png"))
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
        cloud = ewa.read(self.path("scan.ply"))
        camera = ewa.Camera.frame(cloud, "front", "z")
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            ewa.render(cloud, camera, background="white").save(self.path("ours.png"))
        self.assertIn("leaves gaps", str(caught[0].message))
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


if __name__ == "__main__":
    import unittest

    unittest.main()
