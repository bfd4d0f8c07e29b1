# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""What shines on a picture, what surfaces are made of, and what cuts the scene."""
from __future__ import annotations

import ctypes
from typing import Any, Mapping, Sequence, Union

from . import _bindings as b
from ._context import Context, core_of
from ._errors import ArgumentError
from ._library import functions as lib
from ._struct import fill, numbers, path_bytes
from .image import Color, as_picture, linear, pixels_struct

#: Direction towards a light x, y, z, or with its linear colour x, y, z, r, g, b; 0, 0, 0 is the eye's.
Light = Sequence[float]
#: A table of materials: a JSON file, or members of ewa_material by name for each.
Materials = Union[str, Sequence[Mapping[str, float]]]


class Environment:
    """Surroundings that surfaces mirror.

    Parameters
    ----------
    picture : path or array_like, shape (height, width, 1, 3 or 4)
        Equirectangular; its upper edge is the direction +y, its middle +z. Floats are linear light.

    Raises
    ------
    ArgumentError, FileError, FormatError
    """

    def __init__(self, picture: Any, *, context: Context | None = None) -> None:
        core = core_of(context)
        image = pixels_struct(as_picture(picture, "environment"), core.address)
        self._handle = core.make(lib.ewa_environment_create, ctypes.byref(image),
                                 destroy=lib.ewa_environment_destroy, what="the environment")


def set_lights(options: Any, lights: Sequence[Light] | None) -> None:
    """Fill `lights` of a struct of options."""
    if lights is None:
        return
    if len(lights) > b.EWA_MAX_LIGHTS:
        raise ArgumentError(f"lights: {len(lights)} of them; at maximum {b.EWA_MAX_LIGHTS}")
    for i, light in enumerate(lights):
        given = numbers(light, 3 if len(light) == 3 else 6, f"lights[{i}]")
        lib.ewa_light_init(ctypes.byref(options.lights[i]))
        options.lights[i].direction_world[:] = given[:3]
        if len(given) == 6:
            options.lights[i].color[:] = given[3:]
    options.light_count = len(lights)


def set_materials(options: b.ewa_render_options, materials: Materials | None) -> Any:
    """Fill `materials`; returns what has to live as long as the options."""
    if materials is None:
        return None
    table = (b.ewa_material * b.EWA_MAX_MATERIALS)()
    count = ctypes.c_uint32()
    if isinstance(materials, (str, bytes)):
        core = core_of(None)
        core.call(lib.ewa_materials_load, core.address, path_bytes(materials, "materials"), table, ctypes.byref(count))
    else:
        if not 1 <= len(materials) <= b.EWA_MAX_MATERIALS:
            raise ArgumentError(f"materials: {len(materials)} of them; [1, {b.EWA_MAX_MATERIALS}]")
        for i, material in enumerate(materials):
            lib.ewa_material_init(ctypes.byref(table[i]))
            fill(table[i], "ewa_material", material)
        count.value = len(materials)
    options.materials = ctypes.cast(table, ctypes.POINTER(b.ewa_material))
    options.material_count = count.value
    return table


def set_section(options: Any, box: Any, planes: Sequence[Sequence[float]] | None) -> None:
    """Fill `section_planes`, those of a box first, as the program does."""
    all_planes: list[Sequence[float]] = []
    if box is not None:
        corners = numbers(box, 6, "section_box")
        for side in range(6):
            axis, inward = side // 2, -1.0 if side % 2 else 1.0
            normal = [inward if c == axis else 0.0 for c in range(3)]
            all_planes.append(normal + [-inward * corners[axis + 3 * (side % 2)]])
    all_planes += list(planes or ())
    if len(all_planes) > b.EWA_MAX_SECTION_PLANES:
        raise ArgumentError(f"section_planes: {len(all_planes)} with the box's six; at maximum {b.EWA_MAX_SECTION_PLANES}")
    for i, plane in enumerate(all_planes):
        options.section_planes[i][:] = numbers(plane, 4, f"section_planes[{i}]")
    options.section_count = len(all_planes)


def set_background(options: Any, background: Color | None) -> bool:
    """Fill `background`; returns whether it is opaque."""
    if background is not None:
        fill(options, type(options).__name__, {"background": linear(background)}, own=True)
    return bool(options.background[3] == 1)
