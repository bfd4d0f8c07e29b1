# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Pictures as functions of tensors: PyTorch differentiates through them. Imports torch, which the package does not need."""
from __future__ import annotations

from typing import Any, Iterable, Mapping

import numpy as np
import torch  # type: ignore[import-not-found,unused-ignore]

from ._arrays import Array
from ._errors import ArgumentError
from .camera import Camera, checked
from .cloud import Cloud
from .gradients import STREAMS, SURFELS_OPTIONS, CameraGradient, Gradients, render_backward
from .rendering import render as render_image

#: Tensors of the camera by name, and their shapes.
_CAMERA = {"world_to_camera": (4, 4), "focal_px": (2,), "principal_px": (2,)}
_PLANES = ("rgba", "depth", "normal", "coverage")


def render(camera: Camera, *, position: torch.Tensor, color: torch.Tensor, normal: torch.Tensor | None = None,
           radius: torch.Tensor | None = None, tangent_u: torch.Tensor | None = None,
           tangent_v: torch.Tensor | None = None, opacity: torch.Tensor | None = None,
           world_to_camera: torch.Tensor | None = None, focal_px: torch.Tensor | None = None,
           principal_px: torch.Tensor | None = None, planes: str | Iterable[str] = "rgba", exact: bool = False,
           unit_coverage: float | None = None, **options: Any) -> Any:
    """Draw surfels; derivatives by every tensor that wants one come from :func:`ewa.render_backward`.

    Parameters
    ----------
    camera : Camera
    position, color : Tensor, shape (n, 3), float32 or float64, on the CPU
        World units; linear light.
    normal, radius : Tensor, shape (n, 3) and (n,), optional
        Of discs.
    tangent_u, tangent_v : Tensor, shape (n, 3), optional
        Of ellipses, in their place.
    opacity : Tensor, shape (n,), optional
        In [0, 1]. Default: 1.
    world_to_camera : Tensor, shape (4, 4), optional
        In place of the camera's: a rotation and a translation. Its gradient is that along rotations.
    focal_px, principal_px : Tensor, shape (2,), optional
        In place of the camera's.
    planes : some of "rgba", "depth", "normal", "coverage", optional
        What is drawn. Default: "rgba", linear, premultiplied.
    exact : bool, optional
        Draw "rgba" in double precision by the derivative's own pictures, which takes longer: for torch.autograd.gradcheck.
    unit_coverage : float, optional
        Of exact pictures: as of :func:`ewa.render_backward`.
    **options
        As of :func:`ewa.render_backward`.

    Returns
    -------
    Tensor, or a tuple of one for each of several planes
        Shape (height, width, 4), (height, width) or (height, width, 3); float32, exact ones float64.

    Raises
    ------
    ArgumentError
        A tensor of another shape, type or device.
    """
    names = (planes,) if isinstance(planes, str) else tuple(planes)
    if not names or any(name not in _PLANES for name in names) or (exact and names != ("rgba",)):
        raise ArgumentError(f"planes: {', '.join(names)}: some of {', '.join(_PLANES)}, and of exact pictures rgba alone")
    given = {"position": position, "color": color, "opacity": opacity, "normal": normal, "radius": radius,
             "tangent_u": tangent_u, "tangent_v": tangent_v, "world_to_camera": world_to_camera, "focal_px": focal_px,
             "principal_px": principal_px}
    tensors = {name: tensor for name, tensor in given.items() if tensor is not None}
    for name, tensor in tensors.items():
        wanted = _CAMERA.get(name) or ((len(position), 3) if STREAMS[name] == 3 else (len(position),))
        if tuple(tensor.shape) != wanted or tensor.device.type != "cpu" or not tensor.dtype.is_floating_point:
            raise ArgumentError(f"{name}: {tuple(tensor.shape)} {tensor.dtype} on {tensor.device}; {wanted} floats on the "
                                "CPU are needed")
    frame = _Frame(camera, tuple(tensors), names, exact, unit_coverage, options)
    made = _Render.apply(frame, *tensors.values())
    return made[0] if len(names) == 1 else made


class _Frame:
    """What of a call are no tensors."""

    def __init__(self, camera: Camera, inputs: tuple[str, ...], planes: tuple[str, ...], exact: bool,
                 unit_coverage: float | None, options: Mapping[str, Any]) -> None:
        self.camera, self.inputs, self.planes, self.exact = camera, inputs, planes, exact
        self.unit_coverage, self.options = unit_coverage, dict(options)

    def cloud_of(self, arrays: Mapping[str, Array]) -> Cloud:
        """The cloud that the tensors make; it borrows their memory where it can."""
        color = arrays["color"]
        if "opacity" in arrays:
            color = np.concatenate([color, np.clip(arrays["opacity"], 0, 1)[:, None]], axis=1)
        streams: dict[str, Any] = {name: arrays[name] for name in ("radius", "tangent_u", "tangent_v") if name in arrays}
        return Cloud(arrays["position"], normals=arrays.get("normal"), colors=color, **streams)

    def camera_of(self, arrays: Mapping[str, Array]) -> Camera:
        """The camera, with what of it are tensors."""
        made = self.camera._copy()
        if "focal_px" in arrays:
            made.fx_px, made.fy_px = map(float, arrays["focal_px"])
        if "principal_px" in arrays:
            made.cx_px, made.cy_px = map(float, arrays["principal_px"])
        if "world_to_camera" in arrays:
            made.world_to_camera[:] = arrays["world_to_camera"].ravel().tolist()
        return Camera._of(checked(made))


def _arrays_of(frame: _Frame, tensors: Iterable[torch.Tensor]) -> dict[str, Array]:
    return {name: tensor.detach().contiguous().numpy() for name, tensor in zip(frame.inputs, tensors)}


class _Render(torch.autograd.Function):  # type: ignore[misc,unused-ignore]
    """Forward by the pipeline, backward by the library's derivative."""

    @staticmethod
    def forward(ctx: Any, frame: _Frame, *tensors: torch.Tensor) -> tuple[torch.Tensor, ...]:
        arrays = _arrays_of(frame, tensors)
        cloud, camera = frame.cloud_of(arrays), frame.camera_of(arrays)
        ctx.frame, ctx.unit_coverage = frame, frame.unit_coverage
        ctx.save_for_backward(*tensors)
        if frame.exact:
            exact = render_backward(cloud, camera, by="rgba", unit_coverage=frame.unit_coverage, **frame.options).rgba
            return (torch.from_numpy(exact),)
        surfels = cloud.surfels(close_gaps=False, **{name: value for name, value in frame.options.items()
                                                     if name in SURFELS_OPTIONS})
        drawn = {name: value for name, value in frame.options.items() if name not in SURFELS_OPTIONS}
        drawn["supersampling"] = drawn.get("supersampling") or 1  # as derivatives have it
        image = render_image(surfels, camera, planes=frame.planes, **drawn)
        ctx.unit_coverage = surfels._info.unit_coverage
        made = tuple(torch.from_numpy(getattr(image, name)) for name in frame.planes)
        ctx.empty = None
        if "depth" in frame.planes:  # where nothing is, a loss may give anything
            ctx.empty = ~np.isfinite(np.asarray(image.depth))
        return made

    @staticmethod
    def backward(ctx: Any, *cotangents: torch.Tensor | None) -> tuple[Any, ...]:
        frame, tensors = ctx.frame, ctx.saved_tensors
        arrays = _arrays_of(frame, tensors)
        wanted = [name for name, needed in zip(frame.inputs, ctx.needs_input_grad[1:]) if needed]
        by = [name for name in wanted if name in STREAMS]
        by += ["camera"] if any(name in _CAMERA for name in wanted) else []
        by += ["rgba"] if frame.exact else []  # of the picture in double precision, colours too
        planes: dict[str, Any] = {}
        for name, cotangent in zip(frame.planes, cotangents):
            if cotangent is None:
                continue
            plane = cotangent.detach().to(torch.float32).contiguous().numpy()
            planes[name] = np.where(ctx.empty, 0, plane) if name == "depth" else plane
        camera = frame.camera_of(arrays)
        found = render_backward(frame.cloud_of(arrays), camera, by=by, unit_coverage=ctx.unit_coverage, **planes,
                                **frame.options)
        return (None, *(_gradient(found, name, camera, tensor) if name in wanted else None
                        for name, tensor in zip(frame.inputs, tensors)))


def _gradient(found: Gradients, name: str, camera: Camera, tensor: torch.Tensor) -> torch.Tensor:
    """One tensor's gradient."""
    array = getattr(found, name) if name in STREAMS else _camera_gradient(found.camera, name, camera)
    return torch.from_numpy(np.ascontiguousarray(array)).to(tensor.dtype)


def _camera_gradient(of: CameraGradient | None, name: str, camera: Camera) -> Array:
    """By the camera's own numbers. p = A w + t turned by r and moved by s: A becomes A + [r] A, t becomes t + r x t + s. For
    a rotation A that is what <dA, [r] A> + dt . (r x t + s) with dA = [g] A / 2, g = rotation - t x translation, gives."""
    assert of is not None
    if name != "world_to_camera":
        made: Array = getattr(of, name)
        return made
    pose = np.asarray(camera.world_to_camera)
    x, y, z = of.rotation - np.cross(pose[:3, 3], of.translation)
    scale = np.linalg.norm(pose[0, :3])
    gradient = np.zeros((4, 4))
    gradient[:3, :3] = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]) @ pose[:3, :3] / (2 * scale**2)
    gradient[:3, 3] = of.translation
    return gradient


__all__ = ["render"]
