# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Surfels: the resident form of a cloud, made as the program makes it."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Mapping

import numpy as np

from . import _bindings as b
from ._arrays import Array
from ._context import Core, Handle
from ._errors import ClosedError
from ._library import functions as lib
from ._scene import World

if TYPE_CHECKING:
    from .cloud import Cloud


class Surfels:
    """What is drawn: discs or ellipses in the order and packing of the renderer, at most 33 bytes each.

    Made by :meth:`Cloud.surfels`; immutable, needs the cloud no longer, may be drawn any number of times.
    """

    _handle: Handle | None
    _world: World | None
    _asset: Handle | None = None

    def __init__(self) -> None:
        raise TypeError("Cloud.surfels() makes these")

    @staticmethod
    def _made(cloud: Cloud, close_gaps: bool, options: Mapping[str, Any]) -> Surfels:
        """What a scene of the cloud alone makes resident."""
        world = World(cloud._core, close_gaps=close_gaps, keep_points=False, surfels=options)
        given = cloud._h  # stays until the points are no longer needed
        world.add(cloud)
        world.handle.keep = ()  # the scene alone has the asset, and so lets go of its points when the surfels are made

        def commit(scene: int, made: Any) -> int:
            info = b.ewa_scene_info()
            status: int = lib.ewa_scene_commit(scene)
            lib.ewa_scene_describe(scene, ctypes.byref(info))
            made._obj.value = None if status else info.resident
            return status

        surfels = Surfels.__new__(Surfels)
        surfels._handle = world.core.make(commit, world.handle, destroy=_nothing, what="the surfels",
                                          keep=(world.handle,))
        surfels._world = world
        del given
        return surfels

    def _whole(self) -> World | None:
        """The scene of them alone."""
        return self._world if self._h else None

    def _asset_members(self) -> dict[str, Any]:
        return {"surfels": self._h}

    @property
    def _h(self) -> Handle:
        if self._handle is None:
            raise ClosedError("the surfels are closed")
        return self._handle

    @property
    def _core(self) -> Core:
        return self._h.core

    @property
    def _info(self) -> b.ewa_surfels_info:
        info = b.ewa_surfels_info()
        self._core.value(lib.ewa_surfels_describe, self._h, ctypes.byref(info))
        return info

    def __len__(self) -> int:
        """Points that can be drawn."""
        return self._info.point_count

    @property
    def left_out_count(self) -> int:
        """Points of the cloud that cannot be drawn."""
        return self._info.left_out_count

    @property
    def resident_bytes(self) -> int:
        """Memory of all levels."""
        return self._info.resident_bytes

    @property
    def level_count(self) -> int:
        """Levels of detail."""
        return self._info.level_count

    @property
    def transparent(self) -> bool:
        """Whether some colour has an alpha below 1."""
        return bool(self._info.transparent)

    @property
    def bounds(self) -> Array:
        """Lower and upper corner of the centres, world units; float64, shape (2, 3)."""
        box = self._info.bounds
        return np.array([box.low_world, box.high_world])

    def close(self) -> None:
        """Free the surfels; later use raises ClosedError."""
        self._handle = self._world = self._asset = None

    def __repr__(self) -> str:
        return "<ewa.Surfels, closed>" if self._handle is None else f"<ewa.Surfels, {len(self)}>"


def _nothing(_: Any) -> None:
    """The scene owns its surfels."""
