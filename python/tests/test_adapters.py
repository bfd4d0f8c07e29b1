# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Objects of other packages: each is drawn, and so is a file of the same data; the pictures are the same bytes.

Packages that Debian has are installed by tools/setup.sh, small ones of PyPI by tools/test_python.sh where it can be reached.
"""
from __future__ import annotations

import importlib
import io
import struct
import types
import unittest
from typing import Any

import numpy as np

import ewa
from common import Case

CAMERA = ewa.Camera.look_at((2.4, -2.0, 1.6), (0.3, 0, 0), size=(160, 120), fov=50)


def package(name: str) -> Any:
    """A package, or a skip that says where it is to be had."""
    try:
        return importlib.import_module(name)
    except Exception as error:  # noqa: B902 - packages that are broken raise anything
        raise unittest.SkipTest(f"{name} cannot be imported ({type(error).__name__}); pip install {name}") from None


def ball(count: int = 4000) -> tuple[np.ndarray, np.ndarray]:
    """Points on a sphere whose coordinates are exact in float32, and colours of 8 bits."""
    points = np.random.default_rng(1).normal(size=(count, 3))
    points = (points / np.linalg.norm(points, axis=1)[:, None]).astype(np.float32)
    return points.astype(np.float64), (255 * (points * 0.5 + 0.5)).astype(np.uint8)


def cube() -> tuple[np.ndarray, np.ndarray]:
    """Corners and triangles."""
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return corners, np.array([(q[0], q[i], q[i + 1]) for q in quads for i in (1, 2)])


def ply(points: np.ndarray, colors: np.ndarray, kind: str = "double") -> bytes:
    """A binary PLY, which no package wrote."""
    code = {"double": "d", "float": "f"}[kind]
    head = "".join(f"property {kind} {name}\n" for name in "xyz") + "".join(
        f"property uchar {name}\n" for name in ("red", "green", "blue"))
    return (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n{head}end_header\n".encode()
            + b"".join(struct.pack(f"<3{code}3B", *p, *c) for p, c in zip(points.tolist(), colors.tolist())))


class Both(Case):
    def setUp(self) -> None:
        super().setUp()
        self.files: dict[str, bytes] = {}

    def drawn(self, thing: Any) -> bytes:
        pixels = ewa.render(thing, CAMERA).rgba8
        self.assertGreater((pixels[..., :3] != 255).any(-1).mean(), 0.03, "nearly nothing is drawn")
        return bytes(pixels.tobytes())

    def same(self, thing: Any, path: str) -> None:
        """Drawn as an object, and as the file of that name in the test's folder."""
        if path not in self.files:
            self.files[path] = self.drawn(self.path(path))
        self.assertTrue(self.drawn(thing) == self.files[path], f"{path} is drawn otherwise")

    def write(self, name: str, data: bytes) -> bytes:
        with open(self.path(name), "wb") as file:
            file.write(data)
        return data


class Data(Both):
    def test_arrays(self) -> None:
        points, colors = ball()
        self.write("a.ply", ply(points, colors))
        self.same(ewa.Cloud(points, colors=colors), "a.ply")
        for kind in (np.int32, np.int64, np.uint64, object):  # codes of lists and tables
            wide = colors.tolist() if kind is object else colors.astype(kind)
            self.same(ewa.Cloud(points, colors=wide), "a.ply")
        self.same(ewa.Cloud(points.astype(np.longdouble), colors=colors), "a.ply")
        self.same({"x": points[:, 0], "y": points[:, 1], "z": points[:, 2], "rgb": colors}, "a.ply")
        self.same({"X": points[:, 0], "Y": points[:, 1], "Z": points[:, 2], "Red": colors[:, 0].astype(int), "Green":
                   colors[:, 1].astype(int), "Blue": colors[:, 2].astype(int)}, "a.ply")
        rows = np.zeros(len(points), [("x", "f8"), ("y", "f8"), ("z", "f8"), ("red", "u1"), ("green", "u1"), ("blue", "u1")])
        rows["x"], rows["y"], rows["z"] = points.T
        rows["red"], rows["green"], rows["blue"] = colors.T
        self.same(rows, "a.ply")
        bare = np.zeros(len(points), [("xyz", "f8", 3)])
        bare["xyz"] = points
        self.assertEqual(self.drawn(bare), self.drawn(points))
        self.assertEqual(ewa.as_cloud({"x": [0, 1], "y": [0, 1], "z": [0, 1], "i": [5, 6]}).keys(),
                         ["position", "intensity"])
        with self.assertWarnsRegex(ewa.EwaWarning, "left out: name"):
            ewa.as_cloud({"x": [0.0], "y": [0.0], "z": [0.0], "name": ["a"]})
        wrong: list[tuple[Any, type[Exception]]] = [
            ({"a": [1], "b": [2]}, ewa.ArgumentError), (np.zeros((4, 6)), ewa.ArgumentError), ({}, ewa.ArgumentError),
            (np.zeros(4), ewa.ArgumentError), (types.SimpleNamespace(), TypeError), (3, TypeError), (None, TypeError)]
        for value, kind in wrong:
            with self.subTest(str(value)[:30]), self.assertRaises(kind):
                ewa.render(value)
            with self.assertRaises(kind):
                ewa.as_volume(value)

    def test_bytes(self) -> None:
        points, colors = ball()
        for name, thing in (("a.ply", ewa.Cloud(points, colors=colors)), ("a.las", ewa.generate("terrain", 3000)),
                            ("b.ply", ewa.generate("sphere", 3000))):
            thing.save(self.path(name))
            data = self.bytes(name)
            for given in (data, memoryview(data), io.BytesIO(data)):
                self.same(given, name)
            self.assertEqual(ewa.read(data).keys(), ewa.read(self.path(name)).keys())
            with open(self.path(name), "rb") as file:
                self.assertEqual(len(ewa.read(file)), len(thing))
        self.write("part.stl", bytes(80) + struct.pack("<I", 12) + b"".join(
            struct.pack("<12fH", 0, 0, 0, *cube()[0][face].ravel(), 0) for face in cube()[1]))
        self.same(self.bytes("part.stl"), "part.stl")
        self.assertEqual(len(ewa.read_mesh(self.bytes("part.stl")).triangles), 12)
        ewa.generate_volume("ball", dims=[20, 20, 20]).save(self.path("v.nrrd"))
        self.same(self.bytes("v.nrrd"), "v.nrrd")
        self.assertEqual(ewa.read_volume(self.bytes("v.nrrd")).voxels.tobytes(),
                         ewa.read_volume(self.path("v.nrrd")).voxels.tobytes())
        random = np.random.default_rng(2)
        quaternions = random.normal(size=(300, 4))
        ewa.Gaussians(points[:300], np.full((300, 3), 0.2), quaternions / np.linalg.norm(quaternions, axis=1)[:, None],
                      np.full(300, 0.8), random.normal(size=(300, 1, 3))).save(self.path("g.ply"))
        self.same(self.bytes("g.ply"), "g.ply")
        self.assertEqual(len(ewa.read_gaussians(self.bytes("g.ply"))), 300)
        ewa.save_image(self.path("i.png"), random.random((8, 8, 3)).astype(np.float32))
        np.testing.assert_array_equal(ewa.read_image(self.bytes("i.png")), ewa.read_image(self.path("i.png")))
        for data in (b"", b"nothing", self.bytes("part.stl")[:60]):
            with self.assertRaises(ewa.Error):
                ewa.render(data)
        with open(self.path("b.ply"), encoding="latin-1") as text, self.assertRaises(TypeError):
            ewa.read(text)  # type: ignore[arg-type]

    def test_tensors(self) -> None:
        torch = package("torch")
        try:
            torch.zeros(1).numpy()
        except RuntimeError as error:
            self.skipTest(f"this PyTorch is of another numpy: {error}")
        points, colors = ball()
        self.write("a.ply", ply(points, colors))
        tensor = torch.from_numpy(points)
        self.same(ewa.Cloud(tensor, colors=torch.from_numpy(colors)), "a.ply")
        self.same(ewa.Cloud(tensor.clone().requires_grad_(), colors=torch.from_numpy(colors.astype(np.int64))), "a.ply")
        self.assertEqual(self.drawn(tensor), self.drawn(points))
        self.assertTrue(np.shares_memory(ewa.Cloud(tensor, copy=False)["position"], points))
        half = ewa.Cloud(tensor.bfloat16())
        np.testing.assert_array_equal(half["position"], tensor.bfloat16().float().numpy())
        self.assertEqual(self.drawn(torch.full((8, 8, 8), 3.0) * torch.arange(8)),
                         self.drawn(np.broadcast_to(3 * np.arange(8, dtype=np.float32), (8, 8, 8))))

    def test_dlpack(self) -> None:
        class Capsule:
            """What has DLPack and nothing else."""

            def __init__(self, array: np.ndarray) -> None:
                self.array = array

            def __dlpack__(self, **options: Any) -> Any:
                return self.array.__dlpack__(**options)

            def __dlpack_device__(self) -> Any:
                return self.array.__dlpack_device__()

        points, colors = ball()
        self.write("a.ply", ply(points, colors))
        self.same(ewa.Cloud(Capsule(points), colors=Capsule(colors), copy=False), "a.ply")
        self.assertEqual(self.drawn(Capsule(points)), self.drawn(points))

    def test_pandas(self) -> None:
        pandas = package("pandas")
        points, colors = ball()
        table = pandas.DataFrame({"X": points[:, 0], "Y": points[:, 1], "Z": points[:, 2], "red": colors[:, 0], "green":
                                  colors[:, 1], "blue": colors[:, 2], "intensity": np.arange(len(points))})
        table.to_csv(self.path("a.csv"), index=False)
        self.same(table, "a.csv")
        self.same(table.astype({"red": int, "green": int, "blue": int}), "a.csv")
        self.assertEqual(ewa.as_cloud(table).keys(), ["position", "color", "intensity"])
        table["intensity"] = pandas.array([None, *range(1, len(points))], "Int64")
        self.assertTrue(np.isnan(ewa.as_cloud(table)["intensity"][0]))
        self.assertEqual(len(ewa.as_cloud(table[table["Z"] > 0])), (points[:, 2] > 0).sum())

    def test_laspy(self) -> None:
        laspy = package("laspy")
        points, colors = ball()
        for shift, name in ((0, "a.las"), (8, "b.las")):  # files have codes of 16 bits, or of 8 in their place
            header = laspy.LasHeader(point_format=3, version="1.2")
            header.scales = [0.0001] * 3
            las = laspy.LasData(header)
            las.x, las.y, las.z = points.T
            las.red, las.green, las.blue = (colors.astype(np.uint16) << shift).T
            las.classification = np.arange(len(points)) % 3
            las.write(self.path(name))
            self.same(las, name)
            self.assertEqual(ewa.Camera.frame(las), ewa.Camera.frame(self.path(name)))
            cloud = ewa.as_cloud(las)
            self.assertEqual(cloud.keys(), ewa.read(self.path(name)).keys())
            self.assertEqual(cloud["color"].dtype, np.uint16 if shift else np.uint8)
            np.testing.assert_array_equal(cloud["classification"], np.arange(len(points)) % 3)

    def test_pye57(self) -> None:
        pye57 = package("pye57")
        points, colors = ball()
        scan = {**{f"cartesian{axis}": points[:, i] for i, axis in enumerate("XYZ")},
                **{f"color{name}": colors[:, i] for i, name in enumerate(("Red", "Green", "Blue"))}}
        file = pye57.E57(self.path("a.e57"), mode="w")
        file.write_scan_raw(scan)
        file.close()
        self.write("a.ply", ply(points, colors))  # the file says where the scanner stood, too
        self.same(pye57.E57(self.path("a.e57")).read_scan(0, colors=True, ignore_missing_fields=True), "a.ply")
        self.same(scan, "a.ply")
        theirs, ours = ewa.read(self.path("a.e57")), ewa.as_cloud(scan)
        for name in ("position", "color"):
            np.testing.assert_array_equal(theirs[name], ours[name])


class Trimesh(Both):
    def setUp(self) -> None:
        super().setUp()
        self.trimesh = package("trimesh")
        corners, triangles = cube()
        self.plain = self.trimesh.Trimesh(corners, triangles, process=False)

    def test_meshes(self) -> None:
        self.plain.export(self.path("plain.ply"))
        self.same(self.plain, "plain.ply")
        self.assertEqual(len(ewa.as_cloud(self.plain)), len(ewa.read(self.path("plain.ply"))))
        vertex = self.plain.copy()
        vertex.visual.vertex_colors = np.random.default_rng(3).integers(0, 255, (8, 4), np.uint8) | [0, 0, 0, 255]
        vertex.export(self.path("vertex.ply"))
        self.same(vertex, "vertex.ply")
        face = self.plain.copy()
        face.visual.face_colors = np.random.default_rng(4).integers(0, 255, (12, 4), np.uint8) | [0, 0, 0, 255]
        face.export(self.path("face.ply"))
        self.same(face, "face.ply")

        face.vertex_attributes["heat"] = np.arange(8.0)
        self.assertEqual(set(np.unique(ewa.as_drawables(face)[0].attributes["heat"])), set(range(8)))

        class Own(self.trimesh.Trimesh):  # type: ignore[name-defined,misc]
            pass

        self.same(Own(*cube(), process=False), "plain.ply")

    def test_cloud(self) -> None:
        points, colors = ball()
        self.write("a.ply", ply(points, colors))
        self.same(self.trimesh.PointCloud(points, colors=colors), "a.ply")

    def test_pictures(self) -> None:
        image = package("PIL.Image")
        pixels = np.random.default_rng(5).integers(0, 255, (16, 16, 3)).astype(np.uint8)
        uv = np.random.default_rng(6).random((8, 2)).astype(np.float32).astype(np.float64)
        visual = self.trimesh.visual
        mesh = self.plain.copy()
        mesh.visual = visual.TextureVisuals(uv=uv, material=visual.material.PBRMaterial(
            baseColorTexture=image.fromarray(pixels), baseColorFactor=[255, 128, 64, 255]))
        mesh.export(self.path("pbr.glb"))
        self.same(mesh, "pbr.glb")
        mesh.visual = visual.TextureVisuals(uv=uv, image=image.fromarray(pixels))
        mesh.export(self.path("simple.obj"))
        self.same(mesh, "simple.obj")
        self.assertNotEqual(self.drawn(mesh), self.drawn(self.plain))

    def test_scene(self) -> None:
        scene = self.trimesh.Scene()
        red = self.plain.copy()
        red.visual.vertex_colors = np.tile(np.array([[255, 0, 0, 255]], np.uint8), (8, 1))
        shift = np.eye(4)
        shift[:3, 3] = 1, 0.5, 0
        turn = np.array([[0, -1, 0, 0], [1, 0, 0, -1], [0, 0, 1, 0.25], [0, 0, 0, 1.0]])
        scene.add_geometry(red, transform=shift)
        scene.add_geometry(self.plain, transform=turn)
        scene.export(self.path("scene.glb"))
        self.same(scene, "scene.glb")
        scene.add_geometry(self.trimesh.PointCloud(ball()[0] * 0.2))
        self.assertEqual([type(thing) for thing in ewa.as_drawables(scene)], [ewa.Mesh, ewa.Cloud])
        with self.assertRaises(TypeError):
            ewa.render(self.trimesh.load_path([[0, 0, 0], [1, 0, 0]]))


class Open3D(Both):
    def setUp(self) -> None:
        super().setUp()
        self.o3d = package("open3d")

    def test_clouds(self) -> None:
        o3d, (points, colors) = self.o3d, ball()
        cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(points))
        cloud.colors = o3d.utility.Vector3dVector(colors / 255)
        o3d.io.write_point_cloud(self.path("a.ply"), cloud)
        self.same(cloud, "a.ply")
        self.assertTrue(np.shares_memory(ewa.as_cloud(cloud)["position"], np.asarray(cloud.points)))
        tensors = o3d.t.geometry.PointCloud.from_legacy(cloud)
        tensors.point["intensity"] = np.arange(len(points), dtype=np.float32)[:, None]
        self.assertEqual(ewa.as_cloud(tensors).keys(), ["position", "color", "intensity"])
        tensors.point["positions"] = tensors.point["positions"].to(o3d.core.float64)
        self.same(tensors, "a.ply")

    def test_meshes(self) -> None:
        o3d, (corners, triangles) = self.o3d, cube()
        mesh = o3d.geometry.TriangleMesh(o3d.utility.Vector3dVector(corners), o3d.utility.Vector3iVector(triangles))
        mesh.vertex_colors = o3d.utility.Vector3dVector(np.random.default_rng(3).integers(0, 256, (8, 3)) / 255)
        o3d.io.write_triangle_mesh(self.path("m.ply"), mesh)
        self.same(mesh, "m.ply")
        self.same(o3d.t.geometry.TriangleMesh.from_legacy(mesh), "m.ply")
        with self.assertRaises(TypeError):
            ewa.render(o3d.geometry.LineSet())

    def test_pictures(self) -> None:
        o3d, (corners, triangles) = self.o3d, cube()
        mesh = o3d.geometry.TriangleMesh(o3d.utility.Vector3dVector(corners), o3d.utility.Vector3iVector(triangles))
        mesh.triangle_uvs = o3d.utility.Vector2dVector(np.random.default_rng(6).integers(0, 65, (36, 2)) / 64)
        mesh.textures = [o3d.geometry.Image(np.random.default_rng(5).integers(0, 255, (16, 16, 3)).astype(np.uint8))]
        mesh.triangle_material_ids = o3d.utility.IntVector([0] * 12)
        o3d.io.write_triangle_mesh(self.path("m.obj"), mesh)
        self.same(mesh, "m.obj")


class PyVista(Both):
    def setUp(self) -> None:
        super().setUp()
        self.pv = package("pyvista")

    def test_meshes(self) -> None:
        pv, (corners, triangles) = self.pv, cube()
        mesh = pv.PolyData(corners.astype(np.float32), np.column_stack([np.full(12, 3), triangles]).ravel())
        mesh["RGB"] = np.random.default_rng(3).integers(0, 255, (8, 3)).astype(np.uint8)
        mesh.save(self.path("m.ply"), texture="RGB")
        self.same(mesh, "m.ply")
        self.assertEqual(self.drawn(pv.MultiBlock([mesh, None])), self.drawn(mesh))
        box = pv.Box((-0.5, 0.5, -0.5, 0.5, -0.5, 0.5)).triangulate()
        box.save(self.path("box.vtp"))
        self.same(box, "box.vtp")
        self.assertEqual(type(ewa.as_drawables(box.cast_to_unstructured_grid())[0]), ewa.Mesh)
        numbers = pv.Sphere()  # with normals, behind which VTK's files have more arrays
        numbers["heat"], numbers["radius"] = numbers.points[:, 2], numbers.points[:, 0]
        numbers.cell_data["heat"] = np.arange(numbers.n_cells, dtype=np.float32)
        numbers["part"] = np.arange(numbers.n_points) // 100
        numbers.save(self.path("numbers.vtp"))
        for name in ("heat", "part", "scalar_radius", "cell_heat"):
            pixels = []
            for thing in (numbers, self.path("numbers.vtp")):
                scene = ewa.Scene()
                scene.add(thing, color_by=name)
                pixels.append(scene.render(CAMERA).rgba8)
            np.testing.assert_array_equal(pixels[0], pixels[1])
        both = ewa.as_drawables(pv.MultiBlock([numbers, box]))[0].attributes
        self.assertEqual(np.isnan(both["heat"]).sum(), 8)

    def test_cloud(self) -> None:
        pv, (points, colors) = self.pv, ball()
        self.write("a.ply", ply(points, colors, "float"))
        cloud = pv.PolyData(points.astype(np.float32))
        cloud["RGB"], cloud["tensor"] = colors, np.zeros((len(points), 9))
        self.same(cloud, "a.ply")

    def test_images(self) -> None:
        pv = self.pv
        image = pv.ImageData(dimensions=(20, 22, 24), spacing=(0.1, 0.1, 0.05), origin=(-1, -1, -0.6))
        image["v"] = np.exp(-4 * (image.points**2).sum(1)).astype(np.float32)
        image.save(self.path("v.vti"))
        theirs = ewa.read_volume(self.path("v.vti"))
        np.testing.assert_array_equal(ewa.as_volume(image).voxels, theirs.voxels)
        np.testing.assert_allclose(ewa.as_volume(image).index_to_world, theirs.index_to_world, atol=1e-12)
        self.same(image, "v.vti")
        self.assertEqual(ewa.render_volume(image, size=(90, 60)).rgba8.tobytes(),
                         ewa.render_volume(theirs, size=(90, 60)).rgba8.tobytes())


def stand_in(module: str, **members: Any) -> Any:
    """An object that looks like one of a package that may not be there."""
    made = type("StandIn", (), {"__module__": module})()
    for name, value in members.items():
        setattr(made, name, value)
    return made


class StandIns(Both):
    """Large packages are seldom there: what is taken of their objects is also held to objects that look like them."""

    def test_open3d(self) -> None:
        points, colors = ball()
        self.write("a.ply", ply(points, colors))
        cloud = stand_in("open3d.geometry", points=points, colors=colors / 255, has_normals=lambda: False,
                         has_colors=lambda: True)
        self.same(cloud, "a.ply")
        self.assertTrue(np.shares_memory(ewa.as_cloud(cloud)["position"], points))
        corners, triangles = cube()
        shades = np.random.default_rng(3).integers(0, 256, (8, 3)).astype(np.uint8)
        nothing: dict[str, Any] = {name: np.zeros((0, 3)) for name in (
            "vertex_normals", "triangle_uvs", "triangle_material_ids")}
        mesh = stand_in("open3d.geometry", vertices=corners, triangles=triangles, vertex_colors=shades / 255, textures=[],
                        **nothing)
        self.assertEqual(self.drawn(mesh), self.drawn(ewa.Mesh(corners, triangles, colors=shades)))

    def test_pyvista(self) -> None:
        points, colors = ball()
        self.write("a.ply", ply(points, colors, "float"))
        self.same(stand_in("pyvista.core", points=points.astype(np.float32), faces=[], strips=[], point_data={
            "RGB": colors, "tensor": np.zeros((len(points), 9))}), "a.ply")
        corners, triangles = cube()
        shades = np.random.default_rng(3).integers(0, 256, (12, 3)).astype(np.uint8)
        mesh = stand_in("pyvista.core", points=corners, faces=np.column_stack([np.full(12, 3), triangles]).ravel(), strips=[],
                        is_all_triangles=True, point_data={}, cell_data={"RGB": shades})
        self.assertEqual(self.drawn(mesh), self.drawn(ewa.Mesh(
            corners[triangles.ravel()], np.arange(36).reshape(-1, 3), colors=np.repeat(shades, 3, axis=0))))
        mesh.point_data, mesh.cell_data = {"heat": corners[:, 2], "text": np.array(["a"] * 8)}, {"heat": np.arange(12)}
        found = ewa.as_drawables(mesh)[0].attributes
        self.assertEqual(list(found), ["heat", "cell_heat"])
        np.testing.assert_array_equal(found["cell_heat"], np.repeat(np.arange(12), 3))
        np.testing.assert_array_equal(found["heat"], corners[triangles.ravel(), 2])
        voxels = np.random.default_rng(4).random((4, 5, 6)).astype(np.float32)
        image = stand_in("pyvista.core", dimensions=(7, 6, 5), spacing=(0.1, 0.2, 0.3), origin=(1, 2, 3), point_data={},
                         cell_data={"v": voxels.ravel()})
        volume = ewa.as_volume(image)
        np.testing.assert_array_equal(volume.voxels, voxels)
        np.testing.assert_allclose(volume.index_to_world, [[0.1, 0, 0, 1.05], [0, 0.2, 0, 2.1], [0, 0, 0.3, 3.15]])


class Everywhere(Both):
    """What is drawn may stand wherever a cloud may."""

    def test_calls(self) -> None:
        points, colors = ball()
        cloud = ewa.Cloud(points, colors=colors)
        self.assertEqual(ewa.Camera.frame(points), ewa.Camera.frame(ewa.Cloud(points)))
        for name, up in (("-y", [0, -1, 0]), ("-z", [0, 0, -1]), ("y", [0, 1, 0])):
            self.assertEqual(ewa.Camera.frame(points, up=name), ewa.Camera.frame(points, up=up))
            self.assertEqual(ewa.Camera.frame([[-1, -1, -1], [1, 1, 1]], up=name), ewa.Camera.frame([[-1, -1, -1], [1, 1, 1]], up=up))
        down = ewa.Camera.frame(points, up="-y").world_to_camera
        np.testing.assert_array_equal(down[2, :3], -ewa.Camera.frame(points, up="y", view="front").world_to_camera[2, :3])
        self.assertEqual(ewa.Camera.frame([[-1, -1, -1], [1, 1, 1]]), ewa.Camera.frame(np.array([[-1.0] * 3, [1.0] * 3])))
        scene = ewa.Scene(cloud)
        self.assertEqual(self.drawn(scene), self.drawn(cloud))
        self.assertEqual(ewa.Camera.frame(scene), ewa.Camera.frame(cloud))
        self.assertEqual(len(ewa.merge([points, points])), 2 * len(points))
        mesh = ewa.Mesh(*cube())
        cut = ewa.csg(mesh, ewa.Mesh(cube()[0] * 0.7, cube()[1]), "difference")
        self.assertGreater(len(cut), 1000)
        several = ewa.render([mesh, points, ewa.generate_volume("ball", dims=[20, 20, 20])], CAMERA)
        self.assertEqual(several.size, (160, 120))
        scene.close()
        with self.assertRaises(ewa.ClosedError):
            ewa.render(scene)
        with self.assertRaises(TypeError):
            ewa.render(cloud.surfels(), radius_scale=2)
        wrong: list[tuple[Any, dict[str, Any], str]] = [
            ([[0, 0, 0], [1, 0, 0]], {}, r"places in lists are ewa.Cloud"), (points, {"shadng": "phong"}, "shading\\?"),
            (points, {"color_by": "z"}, r"ewa.Scene\(\).add")]
        for thing, options, said in wrong:
            with self.assertRaisesRegex(TypeError, said):
                ewa.render(thing, **options)


if __name__ == "__main__":
    unittest.main()
