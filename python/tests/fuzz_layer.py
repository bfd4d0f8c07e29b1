#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Calls the package with wrong arrays, numbers and orders of calls, by hypothesis: only exceptions of Python may come.

    PYTHONPATH=python python3 python/tests/fuzz_layer.py [SECONDS]     default 60; needs hypothesis

With the library's memory watched by sanitizers:

    cmake --preset asan -DCMAKE_BUILD_TYPE=RelWithDebInfo -DEWA_BUILD_TESTS=OFF -DEWA_BUILD_CLI=OFF
    cmake --build build/asan --target ewa_shared
    ASAN_OPTIONS=detect_leaks=0 LD_PRELOAD="$(cc -print-file-name=libasan.so) $(cc -print-file-name=libubsan.so)" \\
        EWA_LIBRARY=build/asan/libewa.so PYTHONPATH=python python3 python/tests/fuzz_layer.py
"""
from __future__ import annotations

import gc
import sys
import tempfile
import time
import warnings
from pathlib import Path
from typing import Any

import numpy as np
from hypothesis import HealthCheck, Phase, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from hypothesis.stateful import RuleBasedStateMachine, initialize, rule, run_state_machine_as_test

import ewa
from ewa import _struct

#: What may come of a call.
EXPECTED = (ewa.Error, TypeError, ValueError, KeyError, MemoryError, OverflowError, IndexError, AttributeError)

DTYPES = [np.float32, np.float64, np.int8, np.uint8, np.int16, np.uint16, np.int32, np.uint32, np.int64, np.float16,
          np.bool_, np.complex64, np.dtype(">f4"), np.dtype("U3")]
#: Calls that were done, and those that raised.
tried = [0, 0]
numbers = st.one_of(st.floats(), st.integers(-3, 70000), st.integers(), st.sampled_from([0, -1, 1, 2**31, 2**63, 1e-300, 1e300]),
                    st.none(), st.text(max_size=3), st.booleans())
vectors = st.lists(numbers, max_size=5)
good = st.floats(-3, 3)


@st.composite
def arrays(draw: Any, columns: int = 3) -> Any:
    """Arrays, mostly near to what fits, of all strides."""
    count = draw(st.sampled_from([0, 1, 2, 17, 60, 60, 60]))
    kind = draw(st.integers(0, 9))
    if kind == 0:
        return draw(hnp.arrays(draw(st.sampled_from(DTYPES)), hnp.array_shapes(min_dims=0, max_dims=4, min_side=0, max_side=5)))
    if kind == 1:
        return draw(st.one_of(numbers, vectors, st.dictionaries(st.text(max_size=2), numbers, max_size=2)))
    rng = np.random.default_rng(draw(st.integers(0, 5)))
    array = rng.normal(size=(count, columns)).astype(draw(st.sampled_from([np.float32, np.float64])))
    if kind == 2 and count:
        with np.errstate(all="ignore"):
            array[rng.integers(count, size=3)] = draw(st.sampled_from([np.nan, np.inf, -np.inf, 1e300, 0]))
    if kind == 3:
        array = np.asfortranarray(array)
    if kind == 4:
        array = array[::draw(st.sampled_from([-1, 2, -3]))]
    if kind == 5:
        array = np.repeat(array, 3, axis=1)[:, :draw(st.integers(0, 6))]
    if kind == 6:
        array = np.lib.stride_tricks.as_strided(array, strides=(0, array.strides[1])) if count else array
    if kind == 7:
        array = array.astype(draw(st.sampled_from(DTYPES[:11])))
    if kind == 8:
        raw = bytearray(array.nbytes + 1)
        array = np.frombuffer(raw, np.uint8)[1:].view(array.dtype).reshape(array.shape)
    return array


@st.composite
def options(draw: Any, struct: str) -> dict[str, Any]:
    """Some options of a struct, in their range or not."""
    table = _struct.table(struct)
    chosen: dict[str, Any] = {}
    for name in draw(st.lists(st.sampled_from(sorted(table) + ["nothing"]), max_size=3)):
        option = table.get(name)
        value: Any = numbers
        if option is not None and draw(st.booleans()):
            low, high = max(option.low, -1e3), min(option.high, 1e3)
            if option.words:
                value = st.sampled_from(option.words)
            elif low <= high:
                value = st.floats(low, high) if option.kind >= 4 else st.integers(int(low), int(high))
        if option is not None and option.length:
            value = st.lists(value, min_size=0, max_size=option.length + 1)
        chosen[name] = draw(value)
    if any(isinstance(v, int) and v > 200000 for k, v in chosen.items() if k in ("point_count", "dims")):
        chosen.pop("point_count", None)
    return chosen


class Layer(RuleBasedStateMachine):
    """Objects of a few contexts, used and closed in any order."""

    @initialize()
    def begin(self) -> None:
        self.contexts = [ewa.Context(thread_count=1), ewa.Context(thread_count=2)]
        self.clouds: list[Any] = []
        self.surfels: list[Any] = []
        self.volumes: list[Any] = []
        self.views: list[Any] = []
        self.owned: list[Any] = []
        self.cameras = [ewa.Camera.look_at((0, -4, 0), (0, 0, 0), size=(24, 16))]
        self.folder = tempfile.TemporaryDirectory()

    def teardown(self) -> None:
        if hasattr(self, "contexts"):
            for view in self.views:
                view.tobytes()  # what arrays show is there to the end; by memcpy(), which sanitizers watch
            self.clouds.clear()
            self.folder.cleanup()

    def attempt(self, function: Any, *arguments: Any, into: Any = None, **keywords: Any) -> Any:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                result = function(*arguments, **keywords)
            except EXPECTED:
                tried[1] += 1
                return None
        tried[0] += 1
        if into is not None:
            into.append(result)
            if len(into) > 6:
                into.pop(0)
        return result

    def one(self, data: Any, things: list[Any]) -> Any:
        if not things or data.draw(st.integers(0, 30)) == 0:
            return data.draw(st.sampled_from([None, 3, "cloud", np.zeros((2, 3))]))
        return data.draw(st.sampled_from(things))

    def context(self, data: Any) -> Any:
        return data.draw(st.sampled_from(self.contexts + [None]))

    @rule(data=st.data())
    def make_cloud(self, data: Any) -> None:
        positions = data.draw(arrays())
        streams: dict[str, Any] = {}
        for name in data.draw(st.lists(st.sampled_from(["normals", "colors", "radius", "tangent_u", "tangent_v", "clip0",
                                                        "clip1", "clip_mode", "material", "", "é", "n" * 70]), max_size=3)):
            streams[name] = data.draw(arrays(data.draw(st.sampled_from([1, 3, 3, 4]))))
        if isinstance(positions, np.ndarray):
            self.owned.append(positions)
        if data.draw(st.booleans()):
            streams["origin"] = data.draw(st.one_of(vectors, st.lists(good, min_size=3, max_size=3)))
        self.attempt(ewa.Cloud, positions, copy=data.draw(st.sampled_from([None, True, False])), context=self.context(data),
                     into=self.clouds, **streams)

    @rule(data=st.data(), kind=st.sampled_from(["plane", "cube", "sphere", "csg", "teapot"]))
    def generate(self, data: Any, kind: str) -> None:
        self.attempt(ewa.generate, kind, data.draw(st.sampled_from([0, 10, 300, 1500, -1])), context=self.context(data),
                     into=self.clouds, **data.draw(options("ewa_generate_options")))

    @rule(data=st.data())
    def derive(self, data: Any) -> None:
        cloud = self.one(data, self.clouds)
        name = data.draw(st.sampled_from(["estimate", "features", "procedure", "refit_colors", "transform", "select", "filter",
                                          "crop", "thin", "color_by", "surfels", "merge", "csg"]))
        structs = {"estimate": "ewa_estimate_options", "features": "ewa_feature_options", "refit_colors": "ewa_refit_options",
                   "surfels": "ewa_surfels_options", "procedure": "ewa_procedure_options"}
        keywords = data.draw(options(structs[name])) if name in structs else {}
        arguments: tuple[Any, ...] = ()
        if name == "transform":
            arguments = (data.draw(st.one_of(arrays(4), st.just(np.diag([2.0, 1, -1, 1])))),)
        elif name == "select":
            arguments = (data.draw(st.one_of(arrays(1), st.lists(st.integers(-2, 80), max_size=9))),)
        elif name == "filter":
            arguments = (data.draw(st.one_of(st.text(max_size=12), st.sampled_from(["x>0", "z<=0 and y=..1", "material=1"]))),)
        elif name == "crop":
            arguments = (data.draw(vectors), data.draw(st.lists(good, min_size=3, max_size=3)))
        elif name == "thin":
            keywords = {data.draw(st.sampled_from(["voxel", "distance"])): data.draw(st.one_of(numbers, st.floats(0.01, 2)))}
        elif name == "color_by":
            arguments = (data.draw(st.sampled_from(["x", "normal.x", "red", "radius", "", "w"])),
                         data.draw(st.sampled_from([None, "turbo", "gray", "classes", "?"])),
                         data.draw(st.one_of(st.none(), vectors)))
        elif name == "procedure":
            arguments = (data.draw(st.sampled_from(["marble", "noise", "?"])),)
        if name == "merge":
            self.attempt(ewa.merge, [cloud, self.one(data, self.clouds)], into=self.clouds)
        elif name == "csg":
            self.attempt(ewa.csg, cloud, self.one(data, self.clouds), "difference", into=self.clouds)
        elif isinstance(cloud, ewa.Cloud):
            self.attempt(getattr(cloud, name), *arguments, into=self.surfels if name == "surfels" else self.clouds,
                         **keywords)

    @rule(data=st.data())
    def look(self, data: Any) -> None:
        cloud = self.one(data, self.clouds)
        if not isinstance(cloud, ewa.Cloud):
            return
        for name in self.attempt(cloud.keys) or []:
            view = self.attempt(cloud.__getitem__, name)
            if view is not None and not self.attempt(cloud.borrows, name):
                self.views.append(view)
        self.views = self.views[-20:]
        self.attempt(lambda: (len(cloud), cloud.bounds, cloud.notes, repr(cloud), cloud.origin, cloud.scalar("y")))
        self.attempt(cloud.__setitem__, data.draw(st.sampled_from(["radius", "normal", "position", "x"])),
                     data.draw(arrays()))
        self.attempt(cloud.__delitem__, "radius")
        path = Path(self.folder.name) / data.draw(st.sampled_from(["a.ply", "a.las", "a.csv", "a.xyz", "a.nothing", ""]))
        self.attempt(cloud.save, path, **data.draw(options("ewa_cloud_save_options")))
        self.attempt(ewa.read, path, filter=data.draw(st.sampled_from([None, "x>0", "?"])), context=self.context(data),
                     into=self.clouds)

    @rule(data=st.data())
    def make_camera(self, data: Any) -> None:
        size = data.draw(st.one_of(vectors, st.tuples(st.integers(1, 40), st.integers(1, 40))))
        self.attempt(ewa.Camera, data.draw(st.one_of(st.none(), arrays(3))), data.draw(st.one_of(st.none(), arrays(4))),
                     size, into=self.cameras)
        place = st.one_of(vectors, st.lists(good, min_size=3, max_size=3))
        size = data.draw(st.tuples(st.integers(1, 40), st.integers(1, 40)))
        self.attempt(ewa.Camera.look_at, data.draw(place), data.draw(place), data.draw(place), size=size,
                     fov=data.draw(st.one_of(st.none(), numbers)), into=self.cameras)
        self.attempt(ewa.Camera.frame, self.one(data, self.clouds + self.surfels),
                     data.draw(st.sampled_from([None, "iso", "top", "?", (0, 0, 1)])),
                     data.draw(st.one_of(st.sampled_from([None, "y", "z"]), vectors)), size=size, into=self.cameras)

    @rule(data=st.data())
    def render(self, data: Any) -> None:
        scene = self.one(data, self.surfels + self.clouds)
        if data.draw(st.integers(0, 4)) == 0:
            scene = [scene, self.one(data, self.surfels)]
        keywords = data.draw(options("ewa_render_options"))
        own: dict[str, Any] = {
            "planes": st.sampled_from(["all", "rgba8", ("rgba", "depth"), "x", ()]),
            "background": st.one_of(vectors, st.text(max_size=5), st.just("white")), "lights": st.lists(vectors, max_size=9),
            "layers": st.one_of(numbers, st.sampled_from(["auto", "exact", 3])), "section_box": arrays(3),
            "section_planes": st.lists(vectors, max_size=9), "materials": st.lists(options("ewa_material"), max_size=3)}
        for name in data.draw(st.lists(st.sampled_from(sorted(own)), max_size=2)):
            keywords[name] = data.draw(own[name])
        image = self.attempt(ewa.render, scene, self.one(data, self.cameras), size=(24, 16) if data.draw(st.booleans()) else None,
                             **keywords)
        if isinstance(image, ewa.Image):
            self.attempt(image.save, Path(self.folder.name) / data.draw(st.sampled_from(["a.png", "a.exr", "a.pfm", "a"])))

    @rule(data=st.data())
    def volumes(self, data: Any) -> None:
        grid = hnp.arrays(data.draw(st.sampled_from(DTYPES[:11])), hnp.array_shapes(min_dims=2, max_dims=4, min_side=0, max_side=6))
        self.attempt(ewa.Volume, data.draw(grid), spacing=data.draw(st.one_of(numbers, vectors, st.just(1.0))),
                     context=self.context(data), into=self.volumes)
        volume = self.one(data, self.volumes)
        points = st.lists(st.tuples(numbers, vectors, numbers), max_size=3)
        transfer = self.attempt(ewa.Transfer, data.draw(points)) or data.draw(st.sampled_from(["auto", "fog", "bone", "?"]))
        image = self.attempt(ewa.render_volume, volume, self.one(data, self.cameras + [None]), transfer=transfer, size=(24, 16),
                             **data.draw(options("ewa_volume_options")))
        if isinstance(volume, ewa.Volume):
            self.attempt(lambda: (volume.range, self.views.append(volume.voxels.copy()), image))

    @rule(data=st.data())
    def warp_and_texture(self, data: Any) -> None:
        camera = self.one(data, self.cameras)
        depth = data.draw(st.one_of(arrays(4), st.just(np.full((16, 24), 3, np.float32))))
        color = data.draw(st.one_of(st.none(), arrays(3), st.just(np.full((16, 24, 3), 9, np.uint8))))
        self.attempt(ewa.warp, ewa.DepthImage(depth, color, camera, data.draw(st.sampled_from(["z", "ray", "disparity", "?"])),
                                              data.draw(st.one_of(st.none(), numbers))),
                     shift=data.draw(st.one_of(st.none(), vectors)), **data.draw(options("ewa_warp_options")))
        shapes = hnp.array_shapes(min_dims=2, max_dims=3, min_side=0, max_side=4)
        self.attempt(ewa.texture, data.draw(hnp.arrays(data.draw(st.sampled_from([np.uint8, np.float32])), shapes)),
                     corners=data.draw(st.one_of(arrays(2), st.just([[0, 0], [9, 1], [8, 8], [1, 9]]))), size=(12, 10),
                     **data.draw(options("ewa_texture_options")))

    @rule(data=st.data())
    def files(self, data: Any) -> None:
        """Files of the package's own, with some bytes changed, and names that are none."""
        folder = Path(self.folder.name)
        name = data.draw(st.sampled_from(["b.ply", "b.laz", "b.copc.laz", "b.png", "b.exr", "b.json", "b.nrrd", "b.tum"]))
        path = folder / name
        if name.endswith("copc.laz"):
            self.attempt(ewa.generate("plane", 200).save, folder / "c.ply")
            self.attempt(ewa.build_octree, folder / "c.ply", path, **data.draw(options("ewa_lod_build_options")))
        elif name.endswith((".ply", ".laz")):
            self.attempt(ewa.generate("plane", 50).save, path)
        elif name.endswith((".png", ".exr")):
            self.attempt(ewa.save_image, path, np.ones((4, 5, 3), np.float32))
        elif name.endswith(".json"):
            self.attempt(self.cameras[0].save, path)
        elif name.endswith(".nrrd"):
            self.attempt(ewa.generate_volume("ball", dims=[4, 4, 4]).save, path)
        else:
            path.write_text("0 1 2 3 0 0 0 1\n")
        if path.exists():
            content = bytearray(path.read_bytes())
            for _ in range(data.draw(st.integers(0, 3))):
                content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
            path.write_bytes(content[:data.draw(st.sampled_from([len(content), len(content), len(content) // 2]))])
        context = self.context(data)
        readers = [ewa.read, ewa.read_mesh, ewa.read_image, ewa.read_depth, ewa.read_volume, ewa.Octree]
        made = self.attempt(data.draw(st.sampled_from(readers)), path, context=context)
        self.attempt(ewa.cameras, path, data.draw(st.sampled_from([None, self.cameras[0], path])))
        self.attempt(ewa.convert, path, folder / data.draw(st.sampled_from(["d.csv", "d.las", "d"])), crop=data.draw(
            st.sampled_from([None, [[-1, -1, -1], [0, 0, 1]], [1]])))
        if isinstance(made, ewa.Octree):
            self.attempt(made.render, self.one(data, self.cameras), size=(24, 16), **data.draw(options("ewa_lod_options")))
            self.attempt(made.read, data.draw(vectors), spacing=data.draw(numbers))
            self.attempt(made.sample, data.draw(numbers))
            self.attempt(made.close)

    @rule(data=st.data())
    def mesh(self, data: Any) -> None:
        triangles = data.draw(hnp.arrays(data.draw(st.sampled_from([np.int32, np.uint32, np.int64])), (4, 3),
                                         elements=st.integers(0, 6)))
        made: list[Any] = []
        self.attempt(ewa.Mesh, data.draw(arrays()), triangles, context=self.context(data), into=made)
        for mesh in made:
            keywords = data.draw(options("ewa_mesh_sample_options"))
            keywords.update({"point_count": 300, "spacing_world": 0.0})
            self.attempt(mesh.sample, into=self.clouds, **keywords)
            self.attempt(lambda: (mesh.closed, mesh.vertices.sum(), mesh.triangles.sum()))

    @rule(data=st.data())
    def close(self, data: Any) -> None:
        thing = self.one(data, self.clouds + self.surfels + self.volumes)
        if hasattr(thing, "close"):
            thing.close()

    @rule(data=st.data(), which=st.integers(0, 1))
    def close_context(self, data: Any, which: int) -> None:
        if data.draw(st.integers(0, 2)) == 0:
            self.contexts[which].close()
            if data.draw(st.booleans()):
                self.contexts[which] = ewa.Context(thread_count=1)

    @rule(data=st.data())
    def free_an_array(self, data: Any) -> None:
        array = self.one(data, self.owned[-4:])
        if isinstance(array, np.ndarray) and array.base is None and array.flags.owndata and array.ndim == 2:
            # Views of memory that is gone are numpy's own affair; ours are dropped before.
            self.attempt(array.resize, (data.draw(st.sampled_from([0, 1, 9999])), array.shape[1]), refcheck=False)

    @rule()
    def collect(self) -> None:
        gc.collect()


def main() -> None:
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 60.0
    started, runs = time.monotonic(), 0
    while time.monotonic() - started < seconds:
        settings_ = settings(max_examples=20, stateful_step_count=25, deadline=None, database=None, print_blob=False,
                             phases=[Phase.generate], suppress_health_check=list(HealthCheck))
        run_state_machine_as_test(Layer, settings=settings_)
        runs += 20
    print(f"{runs} sequences in {time.monotonic() - started:.0f} s: {tried[0]} calls were done, {tried[1]} raised one of "
          "the exceptions of Python that may come, and nothing else happened")


if __name__ == "__main__":
    main()
