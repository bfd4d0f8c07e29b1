# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Films: cameras of a turn about something, and pictures one after the other into a file."""
from __future__ import annotations

import os
import re
import shutil
import subprocess
import tempfile
import time
from typing import Any, Iterable, Iterator, NamedTuple, Sequence

import numpy as np

from ._arrays import Array
from ._errors import ArgumentError, FileError, FormatError
from ._scene import World, core_of_things, things_of, view_options
from .camera import Camera, PathLike
from .image import Image


class _Format(NamedTuple):
    """What ffmpeg is told of a kind of film; as cli/render/video.c has it, to which a test holds it."""

    muxer: str
    codec: str | None
    further: tuple[str, ...]
    best: float  # constant rate factors
    worst: float
    alpha: bool


_FORMATS = {".mp4": _Format("mp4", "libx264", ("-movflags", "+faststart"), 10, 42, False),
            ".mkv": _Format("matroska", "libx264", (), 10, 42, False),
            ".webm": _Format("webm", "libvpx-vp9", ("-b:v", "0", "-row-mt", "1"), 18, 62, True),
            ".gif": _Format("gif", None, (), 0, 0, False)}
_GIF = "split[a][b];[a]palettegen[p];[b][p]paletteuse"
_YUV = "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=black@0,scale=out_color_matrix=bt709:out_range=tv"


def turntable(scene: Any, count: int, camera: Camera | None = None, *, view: str | Sequence[float] | None = None,
              up: str | Sequence[float] | None = None, size: Sequence[int] | None = None, fov: float | None = None,
              ortho: float | None = None, eye: Sequence[float] | None = None, target: Sequence[float] | None = None,
              azimuth: float = 0, elevation: float = 0) -> list[Camera]:
    """Return the cameras of one turn about what is up, as ``ewa render --turntable`` has them.

    Parameters
    ----------
    scene : Scene, or anything that one takes; a list of these
    count : int
        Of frames, at least 1.
    camera : Camera, optional
        The first one. Default: one that has all in every picture of the turn.
    view, up, size, fov, ortho, eye, target, azimuth, elevation : optional
        As of :meth:`Scene.camera`, where no `camera` is given.

    Raises
    ------
    ArgumentError, NumericError
    """
    if not 1 <= count <= 1000000:
        raise ArgumentError(f"count: {count} is outside [1, 1000000]")
    things = things_of(scene)
    world = things[0]._whole() if len(things) == 1 and hasattr(things[0], "_whole") else None
    if world is None:
        world = World(core_of_things(things))
        for thing in things:
            world.add(thing)
    first, info = world.view(view_options(view, up, size=size, fov=fov, ortho=ortho, eye=eye, target=target, azimuth=azimuth,
                                          elevation=elevation, turntable=True))
    start = Camera._of(first) if camera is None else camera
    return [start.orbit(list(info.pivot_world), list(info.up_world), 360 * i / count) for i in range(count)]


def film(path: PathLike, frames: Iterable[Any], *, fps: float = 30.0, quality: int = 75) -> int:
    """Write pictures as a film, or as numbered files; returns how many.

    Parameters
    ----------
    path : path
        .mp4, .mkv (H.264), .webm (VP9, with transparency), .gif, by the program ffmpeg; or numbered files, such as
        "frame_%04d.png".
    frames : iterable of Image or array_like of uint8, shape (height, width, 3 or 4)
        All of one size; they are taken one after the other, so that a generator needs the memory of one. A picture that is
        drawn into again (``out``) may be given again.
    fps : float, optional
        Frames per second of films, in (0, 1000].
    quality : int, optional
        From 0 (small) to 100 (good), of H.264 and VP9.

    Raises
    ------
    ArgumentError
        No frames, sizes that differ, transparency where the film has none.
    FileError
        There is no ffmpeg, or it says why not.
    """
    name = os.fspath(path)
    if "%" in name:
        return _numbered(name, frames)
    kind = _FORMATS.get(os.path.splitext(name)[1].lower())
    if kind is None:
        raise FormatError(f"{name}: the suffix is none of {' '.join(_FORMATS)}, nor has the name a place for a number (%04d)",
                          "EWA_ERROR_UNSUPPORTED")
    if not 0 < fps <= 1000 or not 0 <= quality <= 100:
        raise ArgumentError(f"fps: {fps}, quality: {quality}; (0, 1000] and [0, 100] are needed")
    program = shutil.which("ffmpeg")
    if program is None:
        raise FileError(f"{name}: films are made by the program ffmpeg, which is not there", "EWA_ERROR_IO")
    pending = f"{name}.ewa-{os.getpid()}-{time.monotonic_ns()}.tmp"
    try:
        count = _encode(program, name, pending, kind, _pixels_of(frames), fps, quality)
        os.replace(pending, name)
    finally:
        if os.path.exists(pending):
            os.unlink(pending)
    return count


def _numbered(pattern: str, frames: Iterable[Any]) -> int:
    places = re.findall(r"%0?\d*d", pattern.replace("%%", ""))
    if len(places) != 1:
        raise ArgumentError(f"path: {pattern!r} has no place, or several, for a number (%04d)")
    count = 0
    for frame in frames:
        if not isinstance(frame, Image):
            raise TypeError(f"frames: numbered files are written of ewa.Image, not {type(frame).__name__}")
        frame.save(pattern % count)
        count += 1
    if not count:
        raise ArgumentError("frames: there are none")
    return count


def _pixels_of(frames: Iterable[Any]) -> Iterator[tuple[Array, bool]]:
    """RGBA of every frame, and whether alpha says nothing."""
    for i, frame in enumerate(frames):
        pixels = np.asarray(frame.rgba8 if isinstance(frame, Image) else frame)
        if pixels.dtype != np.uint8 or pixels.ndim != 3 or pixels.shape[2] not in (3, 4):
            raise ArgumentError(f"frames: {pixels.dtype} of shape {pixels.shape} (frame {i}); uint8 of (height, width, 3 or 4)")
        opaque = frame.opaque if isinstance(frame, Image) else bool(pixels.shape[2] == 3 or (pixels[..., 3] == 255).all())
        if pixels.shape[2] == 3:
            pixels = np.concatenate([pixels, np.full(pixels.shape[:2] + (1,), 255, np.uint8)], axis=2)
        yield np.ascontiguousarray(pixels), opaque


def _encode(program: str, name: str, pending: str, kind: _Format, frames: Iterator[tuple[Array, bool]], fps: float,
            quality: int) -> int:
    """Run ffmpeg; raw frames go to its standard input."""
    count, shape, ffmpeg = 0, (0, 0, 0), None
    with tempfile.TemporaryFile() as said:
        try:
            for pixels, opaque in frames:
                if ffmpeg is None:
                    if not opaque and not kind.alpha:
                        raise ArgumentError(f"{name}: this film has no transparency; .webm has, and so have numbered pictures")
                    shape = pixels.shape
                    words = _words(program, pending, kind, shape, opaque, fps, quality)
                    ffmpeg = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=said, stderr=said)
                if pixels.shape != shape:
                    raise ArgumentError(f"frames: frame {count} is {pixels.shape[1]} x {pixels.shape[0]} pixels, not "
                                        f"{shape[1]} x {shape[0]}")
                assert ffmpeg.stdin is not None
                try:
                    ffmpeg.stdin.write(pixels.data)
                except BrokenPipeError:  # ffmpeg knows why
                    break
                count += 1
            if ffmpeg is None:
                raise ArgumentError("frames: there are none")
            try:
                ffmpeg.communicate()
            except BrokenPipeError:
                pass
            if ffmpeg.wait():
                said.seek(0)
                raise FileError(f"{name}: ffmpeg: {said.read().decode('utf-8', 'replace').strip()}", "EWA_ERROR_IO")
        finally:
            if ffmpeg is not None:
                ffmpeg.kill()  # nothing where it has ended
                ffmpeg.wait()
                _close(ffmpeg.stdin)
    return count


def _close(pipe: Any) -> None:
    try:
        pipe.close()
    except BrokenPipeError:  # what it still had goes nowhere
        pass


def _words(program: str, pending: str, kind: _Format, shape: tuple[int, ...], opaque: bool, fps: float,
           quality: int) -> list[str]:
    words = [program, "-hide_banner", "-loglevel", "error", "-nostdin", "-y", "-f", "rawvideo", "-pixel_format",
             "rgb0" if opaque else "rgba", "-video_size", f"{shape[1]}x{shape[0]}", "-framerate", f"{fps:.6g}", "-i", "pipe:0",
             "-an"]
    if kind.codec:
        rate = f"{kind.worst + (kind.best - kind.worst) * quality / 100:.0f}"
        words += ["-c:v", kind.codec, "-crf", rate, "-vf", _YUV, "-pix_fmt", "yuv420p" if opaque else "yuva420p", "-colorspace",
                  "bt709", "-color_primaries", "bt709", "-color_trc", "iec61966-2-1", "-color_range", "tv", *kind.further]
    else:
        words += ["-filter_complex", _GIF]
    return words + ["-f", kind.muxer, f"file:{pending}"]
