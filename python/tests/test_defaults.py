# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""A default is a default: writing out what an argument or an option is by default changes no byte of what a call gives."""
from __future__ import annotations

import hashlib
import inspect
import json
import os
from typing import Any, Callable

import numpy as np

import ewa
from ewa._options import OWN

from common import ROOT, Case

TABLES = json.loads((ROOT / "docs" / "options.json").read_text())
#: Options whose default the package says otherwise than the library, as its docstrings have it.
OTHERWISE: dict[str, dict[str, Any]] = {
    "Cloud.estimate": {"viewpoint_world": None}, "Cloud.procedure": {"colors": None},
    "Gaussians.save": {"up_world": None},
    "render_gaussians": {"near_world": 0},
    "render_volume": {"shading": "auto"},
}


#: Arguments that the calls have already, so that they are quick.
_OF_CALLS = ("size", "planes", "dims", "point_count", "camera")


def default_of(row: dict[str, Any]) -> Any:
    value = row["default"]
    if row["type"] == "bool":
        return bool(value)
    if row["type"] == "choice":
        return row["range"].split("|")[value]
    if "count" in row and not isinstance(value, list):
        return [value] * row["count"]
    return int(value) if row["type"] in ("u32", "u64") else value


def options_of(function: Callable[..., Any]) -> dict[str, Any]:
    """The options of the library's structs that a call takes as keyword arguments, with the library's defaults."""
    called: Any = function.__init__ if inspect.isclass(function) else function  # type: ignore[misc]
    return {name: default_of(row) for struct in getattr(called, "option_structs", ()) for name, row in TABLES[struct].items()
            if name not in OWN.get(struct, ()) and name in inspect.signature(function).parameters}


def keywords_of(function: Callable[..., Any]) -> dict[str, Any]:
    """The arguments that have a default."""
    return {parameter.name: parameter.default for parameter in inspect.signature(function).parameters.values()
            if parameter.default is not parameter.empty and parameter.kind is not parameter.VAR_KEYWORD}


def functions() -> dict[str, Callable[..., Any]]:
    """Every public call that takes options, or arguments with defaults."""
    found: dict[str, Callable[..., Any]] = {}
    for name in ewa.__all__:
        thing = getattr(ewa, name)
        members = [(name, thing)]
        if inspect.isclass(thing) and not issubclass(thing, BaseException):
            members += [(f"{name}.{key}", value) for key, value in inspect.getmembers(thing, inspect.isroutine)
                        if not key.startswith("_")]
        for label, member in members:
            if callable(member) and label not in ("Array",):
                try:
                    if options_of(member):
                        found[label] = member
                except ValueError:  # without a signature
                    pass
    return found


def told(result: Any) -> Any:
    """Everything that a result holds, as bytes and numbers."""
    if isinstance(result, ewa.Image):
        return {name: getattr(result, name).tobytes() for name in result.planes}, result.camera
    if isinstance(result, ewa.Cloud):
        return {name: result[name].tobytes() for name in result}, result.origin.tobytes()
    if isinstance(result, ewa.Volume):
        return result.voxels.tobytes(), result.index_to_world.tobytes()
    if isinstance(result, ewa.Surfels):
        return told(ewa.render(result, size=(48, 32), planes="all")), result.resident_bytes
    if isinstance(result, ewa.Context):
        return told(ewa.generate("sphere", 100, context=result))
    return result


class Defaults(Case):
    def calls(self) -> dict[str, Callable[..., Any]]:
        """A call of each function, which takes options by name."""
        cloud = ewa.generate("sphere", 600)
        bare = ewa.Cloud(np.array(cloud["position"]))
        bare.save(self.path("bare.ply"))
        ewa.build_octree(self.path("bare.ply"), self.path("tree.copc.laz"))
        octree = ewa.Octree(self.path("tree.copc.laz"))
        mesh = ewa.Mesh([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
        with open(self.path("mesh.obj"), "w") as file:
            file.write("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        volume = ewa.generate_volume("checkerbox", dims=(9, 9, 9))
        rng = np.random.default_rng(1)
        gaussians = ewa.Gaussians(rng.normal(size=(20, 3)), np.full((20, 3), 0.2), np.tile([1.0, 0, 0, 0], (20, 1)),
                                  np.full(20, 0.7), rng.normal(size=(20, 4, 3)))
        size, scene = {"size": (48, 32), "planes": "all"}, ewa.Scene(bare)
        profile = scene.profile([(-1, 0), (1, 0)])
        camera = ewa.Camera.frame(cloud, size=(48, 32))
        image = ewa.render(cloud, camera, planes=("rgba", "depth"))
        depths = ewa.DepthImage(image.depth, image.rgba, camera)

        def saved(name: str, save: Callable[..., Any], *before: Any) -> Callable[..., Any]:
            def run(**options: Any) -> Any:
                save(*before, self.path(name), **options)
                return hashlib.sha256(self.bytes(name)).hexdigest()

            return run

        def added(**options: Any) -> ewa.Image:
            shown = ewa.Scene()
            shown.add(bare, **options)
            return shown.render(**size)

        return {
            "Context": lambda **o: ewa.Context(**o), "Cloud.estimate": lambda **o: bare.estimate(**o),
            "Cloud.surfels": lambda **o: bare.surfels(**o),
            "Cloud.features": lambda **o: ewa.generate("cube", 600).features(**o),
            "Cloud.procedure": lambda **o: cloud.procedure("wood", **o), "Cloud.refit_colors": lambda **o: cloud.refit_colors(**o),
            "Cloud.color_from_photos": lambda **o: tuple(map(str, map(told, cloud.color_from_photos([(camera, image.rgba)], **o)))),
            "Cloud.save": saved("out.ply", cloud.save), "generate": lambda **o: ewa.generate(**{"point_count": 200, **o}),
            "generate_volume": lambda **o: ewa.generate_volume(**{"dims": (8, 8, 8), **o}),
            "Gaussians.save": saved("out.spz", gaussians.save), "Mesh.sample": lambda **o: mesh.sample(**{"point_count": 300, **o}),
            "sample": lambda **o: ewa.sample(self.path("mesh.obj"), **{"point_count": 300, **o}),
            "convert": saved("other.ply", ewa.convert, self.path("bare.ply")),
            "build_octree": saved("again.copc.laz", ewa.build_octree, self.path("bare.ply")),
            "Octree.render": lambda **o: octree.render(**{**size, **o}),
            "Scene.add": added, "Profile.draw": lambda **o: profile.draw(**{"size": (96, 64), **o}),
            "render": lambda **o: ewa.render(bare, **{**size, **o}),
            "Renderer.render": lambda **o: ewa.Renderer().render(bare, **{**size, **o}),
            "Scene.draw_furniture": lambda **o: scene.draw_furniture(scene.render(size=(96, 64)), **{"axes": True, **o}),
            "Scene": lambda **o: ewa.Scene(bare, **o).render(**size), "Scene.render": lambda **o: ewa.Scene(bare).render(**{**size, **o}),
            "render_backward": lambda **o: tuple(map(str, ewa.render_backward(
                cloud, camera, **{**o, "rgba": np.ones((32, 48, 4), np.float32)}))),
            "render_gaussians": lambda **o: ewa.render_gaussians(gaussians, **{**size, **o}),
            "render_volume": lambda **o: ewa.render_volume(volume, **{**size, **o}),
            "warp": lambda **o: ewa.warp(depths, camera.orbit((0, 0, 0), (0, 0, 1), 5), **o),
            "texture": lambda **o: ewa.texture(image, camera=camera, **o),
        }

    def test_options_and_arguments(self) -> None:
        calls, known = self.calls(), functions()
        self.assertEqual(set(calls), set(known))
        count = 0
        for name, call in calls.items():
            plain = told(call())
            options = {key: value for key, value in options_of(known[name]).items() if key not in _OF_CALLS}
            given = {**options, **keywords_of(known[name]), **OTHERWISE.get(name, {})}
            for key in _OF_CALLS:
                given.pop(key, None)
            count += len(given)
            if told(call(**given)) == plain and told(call(**dict.fromkeys(options))) == plain:
                continue
            for key, value in given.items():
                with self.subTest(call=name, option=key, value=value):
                    self.assertEqual(told(call(**{key: value})), plain)
                    if key in options:
                        self.assertEqual(told(call(**{key: None})), plain)
            self.fail(f"{name}: together, all defaults, or all None, change what it gives")
        self.assertGreater(count, 150)
        self.assertTrue(os.path.exists(self.path("out.ply")))
