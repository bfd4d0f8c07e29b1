# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""The library's scenes, below all that is drawn, looked at or made resident: what is shown is decided there."""
from __future__ import annotations

import ctypes
import os
from typing import TYPE_CHECKING, Any, Callable, Iterable, Mapping, Sequence

from . import _bindings as b
from ._context import Core, Handle, core_of
from ._errors import ArgumentError
from ._library import functions as lib
from ._struct import fill, initialised, numbers, path_bytes

if TYPE_CHECKING:
    from typing_extensions import TypeGuard

VIEWS = ("front", "back", "left", "right", "top", "bottom", "iso")
UPS = {"y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0), "-y": (0.0, -1.0, 0.0), "-z": (0.0, 0.0, -1.0)}


def view_options(view: Any = None, up: Any = None, *, size: Sequence[int] | None = None, fov: float | None = None,
                 ortho: float | None = None, eye: Any = None, target: Any = None, azimuth: float = 0,
                 elevation: float = 0, turntable: bool = False, color_bar: bool = False) -> b.ewa_view_options:
    """How a camera is placed, as :meth:`Camera.frame` and :meth:`Scene.camera` are asked."""
    made = initialised(b.ewa_view_options, lib.ewa_view_options_init)
    members: dict[str, Any] = {"azimuth_deg": float(azimuth), "elevation_deg": float(elevation), "turntable": turntable,
                               "color_bar": color_bar}
    if size is not None:
        members.update(width_px=size[0], height_px=size[1])
    if fov is not None:
        members["fov_deg"] = fov
    if ortho is not None:
        members["ortho_height_world"] = ortho
    if isinstance(up, str) and up not in UPS:
        raise ArgumentError(f"up: '{up}' is none of {', '.join(UPS)}, nor 3 numbers")
    if up is not None:
        members["up_world"] = UPS[up] if isinstance(up, str) else list(numbers(up, 3, "up"))
    if eye is not None:
        members.update(has_eye=True, eye_world=list(numbers(eye, 3, "eye")))
    if target is not None:
        members.update(has_target=True, target_world=list(numbers(target, 3, "target")))
    if isinstance(view, str) and view not in VIEWS:
        raise ArgumentError(f"view: '{view}' is none of {', '.join(VIEWS)}, nor 3 numbers")
    if view is not None and not isinstance(view, str):
        members["direction_world"] = list(numbers(view, 3, "view"))
    fill(made, "ewa_view_options", members)
    if isinstance(view, str):
        made.view = VIEWS.index(view)
    return made


def is_path(thing: Any) -> TypeGuard[str | os.PathLike[str]]:
    """Whether something names a file."""
    return isinstance(thing, (str, os.PathLike))


def core_of_object(thing: Any) -> Core:
    """The context of an object that a scene takes."""
    core: Core = thing._core if hasattr(thing, "_core") else thing._h.core
    return core


#: What makes things that a scene takes of objects of other packages: it makes clouds and such, and so is above all of
#: these, which is why it adds itself.
adapters: list[Callable[..., list[Any]]] = []


def drawables_of(thing: Any, core: Core | None = None) -> list[Any]:
    """What a scene takes of something, whose objects are made from a context."""
    return [thing] if hasattr(thing, "_asset_members") else adapters[0](thing, context=core)


def things_of(things: Any) -> list[Any]:
    """The things that one argument stands for: those of a list or tuple, else itself."""
    return list(things) if isinstance(things, (list, tuple)) else [things]


def core_of_things(things: Iterable[Any]) -> Core:
    """The context of the first object among objects and paths; the default one of paths alone."""
    own = next((thing for thing in things if hasattr(thing, "_asset_members")), None)
    return core_of(None) if own is None else core_of_object(own)


def make_asset(core: Core, members: Mapping[str, Any], options: b.ewa_asset_options | None = None) -> Handle:
    """The asset of an object, whose `_asset_members()` are members of ``ewa_asset_source``."""
    handles = tuple(value for value in members.values() if isinstance(value, Handle))
    held = next((value for value in members.values() if hasattr(value, "_bound")), None)
    if any(handle.core is not core for handle in handles) or (held is not None and held._h.core is not core):
        raise ArgumentError("objects of different contexts do not make one picture")

    def create(*given: Any) -> int:
        source = b.ewa_asset_source()
        for name, value in members.items():
            if isinstance(value, Handle):
                setattr(source, name, core.resolve(value))
            elif value is held:
                setattr(source, name, ctypes.cast(given[0], type(getattr(source, name))))
            elif name == "up_world":
                source.up_world[:] = value
            else:
                setattr(source, name, value)
        status: int = lib.ewa_asset_create(core.address, ctypes.byref(source), *given[-2:])
        return status

    made = ctypes.byref(options) if options is not None else None
    return core.make(create if held is None else held._bound(create), made, destroy=lib.ewa_asset_release,
                     what="the asset", keep=handles)


class World:
    """A scene of the library, and what it needs."""

    def __init__(self, core: Core, *, close_gaps: bool = True, up: str = "auto", keep_points: bool = True,
                 surfels: Mapping[str, Any] | None = None) -> None:
        options = initialised(b.ewa_scene_options, lib.ewa_scene_options_init)
        fill(options, "ewa_scene_options", {"close_gaps": close_gaps, "up": up, "keep_points": keep_points})
        fill(options.surfels, "ewa_surfels_options", surfels or {})
        self.core = core
        self.handle = core.make(lib.ewa_scene_create, core.address, ctypes.byref(options),
                                destroy=lib.ewa_scene_destroy, what="the scene")

    def add(self, thing: Any, options: b.ewa_asset_options | None = None, instance: b.ewa_instance | None = None) -> None:
        """Add an object, or what a file has; of objects that never change an asset is made once. What is of other packages is
        converted."""
        if is_path(thing):
            self._add_file(thing, options, instance)
            return
        if not hasattr(thing, "_asset_members"):
            for part in drawables_of(thing, self.core):
                self.add(part, options, instance)
            return
        asset: Handle | None = getattr(thing, "_asset", None) if options is None else None
        if asset is None or asset.core is not self.core:
            asset = make_asset(self.core, thing._asset_members(), options)
            if options is None and hasattr(thing, "_asset"):
                thing._asset = asset
        self.add_asset(asset, instance)

    def _add_file(self, path: Any, options: b.ewa_asset_options | None, instance: b.ewa_instance | None) -> None:
        """Of a scene file, everything that it names, as it says."""
        name = path_bytes(path)
        if options is None:
            options = initialised(b.ewa_asset_options, lib.ewa_asset_options_init)
        if self.core.value(lib.ewa_scene_file_probe, name):
            self.core.call(lib.ewa_scene_open, self.handle, name, ctypes.byref(options))
            return
        self.add_asset(self.core.make(lib.ewa_asset_load, self.core.address, name, ctypes.byref(options),
                                      destroy=lib.ewa_asset_release, what="the asset"), instance)

    def add_asset(self, asset: Handle, instance: b.ewa_instance | None = None) -> None:
        self.core.call(lib.ewa_scene_add, self.handle, asset, ctypes.byref(instance) if instance is not None else None)
        self.handle.keep += (asset,)

    def place(self, options: b.ewa_view_options) -> b.ewa_camera:
        """The camera of ``ewa render`` with the same options."""
        return self.view(options)[0]

    def view(self, options: b.ewa_view_options) -> tuple[b.ewa_camera, b.ewa_view_info]:
        """That camera, and what was chosen for it."""
        camera, info = b.ewa_camera(), b.ewa_view_info()
        self.core.call(lib.ewa_scene_place_camera, self.handle, ctypes.byref(options), ctypes.byref(camera), ctypes.byref(info))
        return camera, info


def place_at_box(core: Core, corners: Any, options: b.ewa_view_options) -> b.ewa_camera:
    """A camera that has a box in its picture."""
    box = numbers(corners, 6, "what")
    places = (ctypes.c_double * 24)(*[box[3 * (i >> c & 1) + c] for i in range(8) for c in range(3)])
    cloud = core.make(lib.ewa_cloud_create, core.address, 8, destroy=lib.ewa_cloud_destroy, what="the box")
    core.call(lib.ewa_cloud_borrow, cloud, b"position", b.ewa_type.EWA_F64, 3, ctypes.addressof(places), 24)
    camera = b.ewa_camera()
    core.call(lib.ewa_cloud_place_camera, cloud, 1.0, 0, b.ewa_scene_up.EWA_UP_AUTO, ctypes.byref(options), ctypes.byref(camera), None)
    return camera
