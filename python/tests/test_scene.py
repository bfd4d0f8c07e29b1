# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""One scene behind all doors: every pair and some triples of kinds, by program, viewer script and package, in all planes."""
from __future__ import annotations

import itertools
import json
import os
import shutil
import struct
import subprocess
import warnings
from typing import Any

import numpy as np

import ewa
from common import Case, program

MESH = """v -1 -1 -1
v 1 -1 -1
v 1 1 -1
v -1 1 -1
v 0 0 1
f 4 3 2 1
f 1 2 5
f 2 3 5
f 3 4 5
f 4 1 5
"""
SIZE = (96, 72)


class SameScene(Case):
    def setUp(self) -> None:
        super().setUp()
        # What stands here by different conventions is joined as it is.
        warnings.filterwarnings("ignore", ".*they are joined by their numbers", ewa.EwaWarning)
        self.run_program("generate", "terrain", "-o", "bare.ply", "-n", "4000", "--positions-only")
        self.run_program("generate", "sphere", "-o", "surfels.ply", "-n", "4000", "--extent", "1.5")
        self.run_program("generate", "torus", "-o", "torus.ply", "-n", "9000")
        self.run_program("lod", "torus.ply", "-o", "tree.copc.laz")
        self.run_program("generate", "ball", "-o", "ball.nrrd", "--dims", "24")
        with open(self.path("mesh.obj"), "w", encoding="ascii") as file:
            file.write(MESH)
        with open(self.path("four.splat"), "wb") as file:
            for i in range(4):
                file.write(struct.pack("<6f", 0.4 * i - 0.6, 0.1 * i, 1, 0.1, 0.2, 0.3))
                file.write(bytes([200, 100, 50, 250, 255, 128, 128, 128]))
        # An octree that is moved, enlarged, coloured, filtered and lets light through.
        with open(self.path("moved.json"), "w", encoding="ascii") as file:
            json.dump({"ewa_scene": 1, "items": [
                {"file": "tree.copc.laz", "levels": "always", "to_world": [0, -1.2, 0, 0.5, 1.2, 0, 0, 0, 0, 0, 1.2, 0.3,
                                                                           0, 0, 0, 1],
                 "color_by": "z", "filter": "x>-0.7", "opacity": 0.7, "radius_scale": 1.2}]}, file)
        self.kinds = ["bare.ply", "surfels.ply", "mesh.obj", "moved.json", "four.splat", "ball.nrrd"]
        self.triples = [("bare.ply", "tree.copc.laz", "four.splat"), ("surfels.ply", "mesh.obj", "ball.nrrd"),
                        ("moved.json", "tree.copc.laz", "ball.nrrd")]

    def test_outlines(self) -> None:
        scene = ewa.Scene(self.path("surfels.ply"))
        image = scene.render(size=SIZE)
        before = image.rgba8.copy()
        scene.draw_outlines(image, 0)
        self.assertTrue((image.rgba8 == before).all())
        scene.draw_outlines(image, 12)
        changed = (image.rgba8 != before).any(2)
        self.assertTrue(50 < changed.sum() < SIZE[0] * SIZE[1] / 2)
        self.run_program("render", "surfels.ply", "-o", "outlines.png", "--size", "96x72", "--outlines", "12")
        image.save(self.path("ours.png"))
        self.assertEqual(open(self.path("ours.png"), "rb").read(), open(self.path("outlines.png"), "rb").read())

    def test_profiles(self) -> None:
        """One profile by program, package and window; of an octree it is that of its points."""
        self.run_program("profile", "torus.ply", "--line", "-2,0.1;2,0.3", "--width", "0.5", "--up", "0,0,1", "-o",
                         "theirs.ply", "--graph", "theirs.png", "--size", "300x200", "--color-by", "z")
        scene = ewa.Scene()
        scene.add(self.path("torus.ply"), color_by="z")
        profile = scene.profile([(-2, 0.1), (2, 0.3)], 0.5, up=(0, 0, 1))
        profile.cloud.save(self.path("ours.ply"))
        profile.draw((300, 200)).save(self.path("ours.png"))
        self.assertEqual(self.bytes("ours.ply"), self.bytes("theirs.ply"))
        self.assertEqual(self.bytes("ours.png"), self.bytes("theirs.png"))
        self.assertEqual(profile.colors.shape, (len(profile.cloud), 3))
        self.assertAlmostEqual(profile.length, np.hypot(4, 0.2))
        stations, offsets = profile.cloud["station"], profile.cloud["offset"]
        self.assertTrue((np.diff(stations) >= 0).all() and (abs(offsets) <= 0.25).all())
        place = profile.cloud["position"] + profile.cloud.origin
        np.testing.assert_allclose(stations, (4 * (place[:, 0] + 2) + 0.2 * (place[:, 1] - 0.1)) / profile.length, atol=1e-6)
        with open(self.path("profile.txt"), "w", encoding="ascii") as file:
            file.write("do color 0 z\ndo profile -2,0.1;2,0.3 0.5\ndo profile save window.ply\n"
                       "do profile save window.png 300x200\n")
        self.run_program("view", "torus.ply", "--script", "profile.txt", "--up", "0,0,1")
        self.assertEqual(self.bytes("window.png"), self.bytes("theirs.png"))
        self.assertEqual(self.bytes("window.ply"), self.bytes("theirs.ply"))
        tree = ewa.Scene()
        tree.add(self.path("tree.copc.laz"), levels="always")
        of_tree = tree.profile([(-2, 0.1), (2, 0.3)], 0.5, up=(0, 0, 1))
        self.assertTrue(abs(len(of_tree.cloud) - len(profile.cloud)) <= 3)  # coordinates of LAZ are rounded
        np.testing.assert_allclose(of_tree.cloud["profile_height"].mean(), profile.cloud["profile_height"].mean(), atol=1e-3)
        with self.assertRaises(ewa.ArgumentError):
            scene.profile([(0, 0)])
        with self.assertRaises(ewa.ArgumentError):
            profile.draw((0, 3))

    def test_measures(self) -> None:
        square = [(0, 0, 0), (3, 0, 3), (3, 3, 3), (0, 3, 0)]
        found = ewa.measure("area", square)
        self.assertAlmostEqual(found.area, 9 * 2 ** 0.5)
        self.assertEqual(found.horizontal_area, 9)
        self.assertEqual(ewa.measure("angle", [(1, 0, 0), (0, 0, 0), (0, 5, 0)]).angle, 90)
        self.assertEqual(ewa.measure("height", [(0, 1, 0), (3, 6, 4)], up=(0, 1, 0)).rise, 5)
        with self.assertRaises(ewa.ArgumentError):
            ewa.measure("angle", square)

    def test_bar_room(self) -> None:
        """The camera that leaves room for a colour bar is the program's."""
        self.run_program("render", "bare.ply", "-o", "bar.png", "--size", "320x240", "--color-by", "z", "--color-bar", "--save-camera", "bar.json")
        scene = ewa.Scene(self.path("bare.ply"))
        scene.camera(size=(320, 240), color_bar=True).save(self.path("python.json"))
        with open(self.path("bar.json"), "rb") as one, open(self.path("python.json"), "rb") as other:
            self.assertEqual(one.read(), other.read())
        self.assertLess(scene.camera(size=(320, 240), color_bar=True).K[0, 2], 130)

    def test_regions(self) -> None:
        """What is hidden in Python, in a scene file and in the window is the same, and is left out of what is written."""
        scene = ewa.Scene(self.path("torus.ply"))
        seen = scene.camera(size=SIZE)
        scene.hide(box=[(-9, -9, -9), (0, 9, 9)])
        scene.keep(outline=[(20, 10), (80, 10), (80, 60), (20, 60)], camera=seen)
        left = scene.points()
        self.assertTrue(100 < len(left) < 4000 and left["position"][:, 0].min() > 0)
        left.save(self.path("ours.ply"))
        scene.save(self.path("hidden.json"), seen)
        self.run_program("convert", "hidden.json", "-o", "theirs.ply")
        self.assertEqual(self.bytes("ours.ply"), self.bytes("theirs.ply"))
        scene.render(seen).save(self.path("ours.png"))
        self.run_program("render", "hidden.json", "-o", "theirs.png")
        self.assertEqual(self.bytes("ours.png"), self.bytes("theirs.png"))
        with open(self.path("hide.txt"), "w", encoding="ascii") as file:
            file.write("do select box -9,-9,-9,0,9,9\ndo hide\ndo select rectangle 20 10 80 60\ndo cut window.ply\ndo keep\n"
                       "do scene save window.json\n")
        self.run_program("view", "torus.ply", "--size", f"{SIZE[0]}x{SIZE[1]}", "--script", "hide.txt")
        self.assertEqual(self.bytes("ours.ply"), self.bytes("window.ply"))
        self.run_program("render", "window.json", "-o", "window.png")
        self.assertEqual(self.bytes("ours.png"), self.bytes("window.png"))
        scene.show_all()
        self.assertEqual(len(scene.points()), len(ewa.read(self.path("torus.ply"))))
        with self.assertRaises(ewa.ArgumentError):
            scene.hide(classes=[256])
        with self.assertRaises(ewa.ArgumentError):
            scene.hide(outline=[(0, 0), (1, 1)], camera=seen)

    def test_regions_of_others(self) -> None:
        """So are Gaussians and voxels, which are where their centres are."""
        for name, suffix, some in (("four.splat", "ply", 2), ("ball.nrrd", "nrrd", 0)):
            scene = ewa.Scene(self.path(name))
            seen = scene.camera(size=SIZE)
            scene.keep(box=[(-9, -9, -9), (0, 9, 9)])
            left = scene.gaussians() if some else scene.volume()
            if some:
                self.assertEqual(len(left), some)
            else:
                self.assertEqual(left.voxels.shape, (24, 24, 12))
            left.save(self.path(f"ours.{suffix}"))
            scene.save(self.path("kept.json"), seen)
            scene.render(seen).save(self.path("ours.png"))
            self.run_program("render", "kept.json", "-o", "theirs.png")
            self.assertEqual(self.bytes("ours.png"), self.bytes("theirs.png"))
            if some:
                self.run_program("convert", "kept.json", "-o", "theirs.ply")
                self.assertEqual(self.bytes("ours.ply"), self.bytes("theirs.ply"))
            with open(self.path("keep.txt"), "w", encoding="ascii") as file:
                file.write(f"do select box -9,-9,-9,0,9,9\ndo cut window.{suffix}\ndo keep\ndo scene save window.json\n")
            self.run_program("view", name, "--size", f"{SIZE[0]}x{SIZE[1]}", "--script", "keep.txt")
            self.assertEqual(self.bytes(f"ours.{suffix}"), self.bytes(f"window.{suffix}"))
            self.run_program("render", "window.json", "-o", "window.png")
            self.assertEqual(self.bytes("ours.png"), self.bytes("window.png"))
        with self.assertRaises(ewa.ArgumentError):
            ewa.Scene(self.path("ball.nrrd")).gaussians()

    def sets(self) -> list[tuple[str, ...]]:
        """Every kind, every pair and some triples."""
        return [*((kind,) for kind in self.kinds), *itertools.combinations(self.kinds, 2), *self.triples]

    def save_camera(self) -> None:
        self.run_program("render", "torus.ply", "--size", f"{SIZE[0]}x{SIZE[1]}", "-o", "any.png", "--elevation", "20",
                         "--save-camera", "camera.json")

    def plane(self, name: str) -> np.ndarray:
        with open(self.path(name), "rb") as file:
            file.readline()
            width, height = map(int, file.readline().split())
            kind = "<f4" if float(file.readline()) < 0 else ">f4"
            return np.frombuffer(file.read(), kind).reshape(height, width, -1)[::-1].squeeze()

    def check(self, files: tuple[str, ...], camera: str | None) -> None:
        size = f"{SIZE[0]}x{SIZE[1]}"
        # Of a camera, only the program and the package take a file.
        placed = ("--camera", camera) if camera else ("--size", size)
        self.run_program("render", *files, "--levels", "always", *placed, "-o", "theirs.png",
                         "--aov", "depth=z.pfm,normal=n.pfm,coverage=c.pfm")
        with ewa.Context() as context:
            scene = ewa.Scene(context=context)
            for name in files:
                scene.add(self.path(name), levels="always")
            seen = ewa.cameras(self.path(camera))[0] if camera else None
            image = scene.render(seen, size=SIZE, planes="all")
            image.save(self.path("ours.png"))
            self.assertEqual(self.bytes("ours.png"), self.bytes("theirs.png"))
            for name, ours in (("z.pfm", image.depth), ("n.pfm", image.normal), ("c.pfm", image.coverage)):
                np.testing.assert_array_equal(self.plane(name), ours, f"{files}: {name}")
            scene.close()
        if camera:
            return
        with open(self.path("script.txt"), "w", encoding="ascii") as file:
            file.write(f"do shot window.png {size}\n")
        self.run_program("view", *files, "--levels", "always", "--size", size, "--script", "script.txt")
        # Beside depths colours are summed in finer steps, 1e-5 apart: the window draws none.
        self.run_program("render", *files, "--levels", "always", *placed, "-o", "alone.png")
        ours, theirs = ewa.read_image(self.path("alone.png")), ewa.read_image(self.path("window.png"))
        np.testing.assert_array_equal(ours[..., :3], theirs[..., :3], f"{files}: the window")

    def test_scene_files(self) -> None:
        size = f"{SIZE[0]}x{SIZE[1]}"
        files = [*self.kinds, "tree.copc.laz"]
        self.run_program("render", *files, "--levels", "always", "--size", size, "-o", "made.png", "--elevation", "30",
                         "--background", "0.2,0.4,0.6", "--ambient", "0.4", "--edl", "0.5", "--save-scene", "scene.json")
        self.run_program("render", "scene.json", "-o", "opened.png", "--save-scene", "again.json")
        self.assertEqual(self.bytes("made.png"), self.bytes("opened.png"))
        self.assertEqual(self.bytes("scene.json"), self.bytes("again.json"))
        with ewa.Context() as context:
            scene = ewa.Scene(self.path("scene.json"), context=context)
            self.assertEqual(len(scene), len(files))
            scene.render().save(self.path("ours.png"))
            self.assertEqual(self.bytes("made.png"), self.bytes("ours.png"))
            told = scene.describe()
            self.assertEqual([item["kind"] for item in told["items"]],
                             ["points", "points", "mesh", "octree", "gaussians", "volume", "octree"])
            np.testing.assert_allclose([told["low_world"], told["high_world"]], scene.bounds)
            scene.save(self.path("python.json"), scene.camera())
            self.assertEqual(self.bytes("scene.json"), self.bytes("python.json"))
            with self.assertRaises(ewa.ArgumentError):
                scene.add(self.path("scene.json"), opacity=0.5)
            scene.close()
        with open(self.path("script.txt"), "w", encoding="ascii") as file:
            file.write(f"do shot window.png {size}\ndo scene save window.json\n")
        self.run_program("view", "scene.json", "--size", size, "--script", "script.txt")
        ours, theirs = ewa.read_image(self.path("made.png")), ewa.read_image(self.path("window.png"))
        np.testing.assert_array_equal(ours[..., :3], theirs[..., :3])
        self.run_program("render", "window.json", "-o", "window2.png")
        np.testing.assert_array_equal(ours, ewa.read_image(self.path("window2.png")))

    def write_items(self) -> dict[str, dict[str, Any]]:
        """An item of a scene file for each kind, with all that only some doors might know: attributes and levels."""
        classes = ewa.read(self.path("torus.ply"))
        place = classes["position"]
        classes["classification"] = (2 + (np.arctan2(place[:, 1], place[:, 0]) > 0.5)).astype(np.uint8)
        classes["intensity"] = (1000 + 900 * place[:, 2]).astype(np.uint16)
        classes.save(self.path("classes.ply"))
        self.run_program("lod", "classes.ply", "-o", "classes.copc.laz")
        bare = ewa.read(self.path("bare.ply"))
        bare["classification"] = (np.arange(len(bare)) % 3 + 1).astype(np.uint8)
        bare.save(self.path("ground.las"))
        many = np.zeros(140000, np.dtype([("center", "<3f4"), ("scale", "<3f4"), ("rest", "u1", 8)]))
        turns = np.arange(len(many)) * 0.618034
        many["center"] = np.column_stack([np.cos(6.28319 * turns), np.sin(6.28319 * turns), np.arange(len(many)) / 7e4 - 1])
        many["scale"] = 0.02
        many["rest"] = 200, 100, 50, 150, 255, 128, 128, 128
        many.tofile(self.path("many.splat"))
        away = [0, -0.8, 0, 0.5, 0.8, 0, 0, 0.3, 0, 0, 0.8, 0.6, 0, 0, 0, 1]
        return {
            "bare": {"file": "ground.las", "color_by": "classification", "filter": "classification!=2"},
            "surfels": {"file": "classes.ply", "color_by": "intensity", "range": ["2%", "90%"], "opacity": 0.8},
            "mesh": {"file": "mesh.obj", "to_world": away, "tint": [0.2, 0.5, 0.9]},
            "octree": {"file": "classes.copc.laz", "levels": "always", "color_by": "classification",
                       "filter": "intensity>700", "radius_scale": 1.2},
            "gaussians": {"file": "many.splat", "to_world": away},
            "volume": {"file": "ball.nrrd", "transfer": "fog"},
        }

    def test_saved_pairs(self) -> None:
        """Scene files with levels of Gaussians, attributes, regions and measurements, of triples in which every pair is."""
        items = self.write_items()
        options = {"up": "z", "surfels": {"radius_scale": 1.1}, "render": {"eye_dome": 0.4, "background": [0.2, 0.4, 0.6, 1]},
                   "gaussians": {"merge_px": 3}, "section_planes": [[0, 0, -1, 0.9]],
                   "regions": [{"keep": False, "box": [-0.3, -2, -2, 0.1, 2, 2], "classes": [3]},
                               {"keep": True, "box": [-9, -9, -9, 9, 1.5, 9]}]}
        measures = [{"kind": "distance", "name": "across", "places_world": [-1, 0, 0, 1, 0, 0]}]
        made = {"ewa_scene": 1, "options": options, "measures": measures}
        self.save_camera()
        with open(self.path("camera.json"), encoding="ascii") as file:
            placed = {**made, "camera": json.load(file)}
        # Triples that have every pair of kinds in them: of two groups of two both, and one of the third.
        groups = [("bare", "surfels"), ("mesh", "octree"), ("gaussians", "volume")]
        sets = [(made, (*groups[i], one)) for i in range(3) for one in groups[(i + 1) % 3]] + [(placed, tuple(items))]
        for scene, kinds in sets:
            with self.subTest(" ".join(kinds)):
                with open(self.path("made.json"), "w", encoding="ascii") as file:
                    json.dump({**scene, "items": [items[kind] for kind in kinds]}, file)
                self.check_saved()
        self.check_ranks("made.json")

    def check_saved(self) -> None:
        """Program, package and window show made.json alike, and save what looks the same."""
        size = f"{SIZE[0]}x{SIZE[1]}"
        self.run_program("render", "made.json", "--size", size, "-o", "theirs.png", "--aov",
                         "depth=z.pfm,normal=n.pfm,coverage=c.pfm", "--save-scene", "theirs.json")
        with ewa.Context() as context:
            scene = ewa.Scene(self.path("made.json"), context=context)
            seen = scene.camera(size=SIZE)
            image = scene.render(seen, planes="all")
            for name, ours in (("z.pfm", image.depth), ("n.pfm", image.normal), ("c.pfm", image.coverage)):
                np.testing.assert_array_equal(self.plane(name), ours, name)
            image.save(self.path("ours.png"))
            scene.save(self.path("ours.json"), seen)
            # Beside depths colours are summed in finer steps: the window draws none.
            scene.render(seen).save(self.path("alone.png"))
            scene.close()
        self.assertEqual(self.bytes("ours.png"), self.bytes("theirs.png"))
        self.assertEqual(self.bytes("ours.json"), self.bytes("theirs.json"))
        with open(self.path("script.txt"), "w", encoding="ascii") as file:
            file.write(f"do scene save window.json\ndo measure delete all\ndo shot window.png {size}\n")
        self.run_program("view", "theirs.json", "--size", size, "--script", "script.txt")
        self.run_program("render", "window.json", "-o", "again.png", "--save-scene", "again.json")
        self.assertEqual(self.bytes("again.png"), self.bytes("alone.png"))
        alone, window = ewa.read_image(self.path("alone.png")), ewa.read_image(self.path("window.png"))
        np.testing.assert_array_equal(window[..., :3], alone[..., :3])
        self.assertEqual(self.bytes("window.json"), self.bytes("again.json"))

    def test_octree_in_two_places(self) -> None:
        self.save_camera()
        away = [0, -0.8, 0, 0.5, 0.8, 0, 0, 0.3, 0, 0, 0.8, 0.6, 0, 0, 0, 1]
        with open(self.path("twice.json"), "w", encoding="ascii") as file:
            json.dump({"ewa_scene": 1, "items": [
                {"file": "tree.copc.laz", "levels": "always"},
                {"file": "tree.copc.laz", "levels": "always", "to_world": away, "tint": [0.2, 0.5, 0.9]}]}, file)
        self.run_program("render", "twice.json", "--camera", "camera.json", "-o", "theirs.png", "--aov", "depth=z.pfm")
        with ewa.Context() as context:
            octree = ewa.Octree(self.path("tree.copc.laz"), context=context)
            scene = ewa.Scene(octree, context=context)
            scene.add(octree, to_world=away, tint=(0.2, 0.5, 0.9))
            image = scene.render(ewa.cameras(self.path("camera.json"))[0], planes="all")
            image.save(self.path("ours.png"))
            self.assertEqual(self.bytes("ours.png"), self.bytes("theirs.png"))
            np.testing.assert_array_equal(self.plane("z.pfm"), image.depth)
            scene.close()

    def check_ranks(self, *shown: str) -> None:
        """Two ranks that share every frame give the planes of one process."""
        ranks = os.path.join(os.path.dirname(program() or ""), os.pardir, "mpi", "ewa-mpi")
        if not os.path.exists(ranks) or not shutil.which("mpirun"):
            self.skipTest("there is no ewa-mpi or no mpirun")
        self.run_program("render", *shown, "--aov", "depth=z1.pfm,normal=n1.pfm,coverage=c1.pfm", "-o", "1.png")
        done = subprocess.run(["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", "2", ranks, "render", *shown, "--aov",
                               "depth=z2.pfm,normal=n2.pfm,coverage=c2.pfm", "-o", "2.png", "--split", "cloud", "--threads", "1"],
                              cwd=self.path(""), capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        for name in ("{}.png", "z{}.pfm", "n{}.pfm", "c{}.pfm"):
            self.assertEqual(self.bytes(name.format(1)), self.bytes(name.format(2)), name)

    def test_every_pair_on_ranks(self) -> None:
        self.save_camera()
        shown = [(files, ("--size", f"{SIZE[0]}x{SIZE[1]}")) for files in self.sets()]
        shown += [(files, ("--camera", "camera.json")) for files in self.triples]
        for files, placed in shown:
            with self.subTest(" ".join(files)):
                self.check_ranks(*files, "--levels", "always", *placed)

    def test_every_pair(self) -> None:
        self.save_camera()
        for files in self.sets():
            with self.subTest(" ".join(files)):
                self.check(files, None)
                self.check(files, "camera.json")
