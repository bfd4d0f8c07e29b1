# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""A view in a notebook that drags turn; drawn by the processor. Imports anywidget, which the package does not need."""
from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Sequence

import anywidget  # type: ignore[import-not-found,unused-ignore]
import numpy as np
import traitlets  # type: ignore[import-not-found,unused-ignore]

from ._arrays import Array
from ._scene import view_options
from .camera import Camera, checked
from .scene import Scene

#: Degrees that a drag of a pixel turns by, and how much nearer a step of the wheel goes.
_TURN_DEG, _NEARER = 0.4, 1.1
#: How much smaller pictures are while something moves.
_QUICK = 2
#: The eye stays so far from what is straight up or down.
_POLE_DEG = 1.0


class View(anywidget.AnyWidget):  # type: ignore[misc,unused-ignore]
    """A picture of a scene in Jupyter, VS Code, Colab or marimo: drags turn it about what is up, with Shift or the right
    button they shift it, the wheel goes nearer. While it moves, it is drawn at half the size.

    Parameters
    ----------
    scene : Scene, or anything that one takes; a list of these
    camera : Camera, optional
        The first one. Default: one that has all in its picture.
    size : (int, int), optional
        Width and height in pixels.
    **options
        As of :meth:`Scene.render`.

    Attributes
    ----------
    camera : Camera
        That of the picture that is shown, to draw the same elsewhere.
    """

    _esm = Path(__file__).with_name("notebook.js")
    width_px = traitlets.Int(640).tag(sync=True)

    def __init__(self, scene: Any, camera: Camera | None = None, *, size: Sequence[int] = (640, 480), **options: Any) -> None:
        super().__init__()
        self._scene = scene if isinstance(scene, Scene) else Scene(*(scene if isinstance(scene, (list, tuple)) else [scene]))
        info = self._scene._world.view(view_options())[1]
        self._up, self._pivot = np.array(info.up_world), np.array(info.pivot_world)
        self.camera = camera.resized(*size) if camera is not None else self._scene.camera(size=size)
        self._options = options
        self._scene.render(self.camera.resized(8, 8), **options)  # says at once what is wrong with them
        self.width_px = self.camera.size[0]
        self.on_msg(self._receive)

    def _receive(self, _: Any, message: dict[str, Any], buffers: Any) -> None:
        """Draws what the page asks for; numbers that are none change nothing."""
        turn, shift, nearer = message.get("turn", (0, 0)), message.get("shift", (0, 0)), message.get("nearer", 0)
        if all(math.isfinite(number) for number in (*turn, *shift, nearer)):
            self._turn(*turn)
            self._shift(*shift)
            self._go(_NEARER ** max(-50.0, min(50.0, nearer)))
        self.show(quick=not message.get("whole", True))

    def show(self, *, quick: bool = False) -> None:
        """Draw the picture anew, as after a change of the scene or of `camera`."""
        width, height = self.camera.size
        small = (max(1, width // _QUICK), max(1, height // _QUICK))
        image = self._scene.render(self.camera.resized(*small) if quick else self.camera, **self._options)
        suffix, kind = (".jpg", "image/jpeg") if image.opaque else (".png", "image/png")
        self.send({"kind": "picture", "type": kind}, [image.encode(suffix)])

    def _turn(self, x_px: float, y_px: float) -> None:
        """About what is up, then up and down, as far as the poles."""
        camera = self.camera.orbit(self._pivot, self._up, -_TURN_DEG * x_px)
        matrix = camera.world_to_camera[:3, :3]
        away = -matrix[2] / np.linalg.norm(matrix[2])
        elevation = math.degrees(math.asin(max(-1.0, min(1.0, float(away @ self._up)))))
        rise = max(_POLE_DEG - 90 - elevation, min(90 - _POLE_DEG - elevation, _TURN_DEG * y_px))
        self.camera = camera.orbit(self._pivot, matrix[0], -rise)

    def _depth(self) -> float:
        """What a pixel's share of the focal length is of camera space at the middle."""
        matrix = self.camera.world_to_camera
        depth = float(matrix[2] @ np.append(self._pivot, 1))
        size = float(np.linalg.norm(matrix[2, :3]))
        return size if self.camera.orthographic else max(depth, 1e-12 * size)

    def _shift(self, x_px: float, y_px: float) -> None:
        matrix, focal = self.camera.world_to_camera, self.camera.K
        step = np.array([x_px / focal[0, 0], y_px / focal[1, 1], 0]) * self._depth()
        moved = np.linalg.solve(matrix[:3, :3], step)
        self._pivot = self._pivot - moved
        self._place(matrix[:3, 3] + step)

    def _go(self, factor: float) -> None:
        """Nearer to the middle by a factor; what is orthographic grows."""
        matrix = self.camera.world_to_camera
        if self.camera.orthographic:
            struct = self.camera._copy()
            struct.fx_px *= factor
            struct.fy_px *= factor
            self.camera = Camera._of(checked(struct))
            return
        middle = matrix[:3, :3] @ self._pivot + matrix[:3, 3]
        self._place(matrix[:3, 3] + middle * (1 / factor - 1))

    def _place(self, translation: Array) -> None:
        struct = self.camera._copy()
        for i in range(3):
            struct.world_to_camera[4 * i + 3] = translation[i]
        self.camera = Camera._of(checked(struct))
