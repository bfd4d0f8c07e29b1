# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Clouds of named columns: tables, structured arrays, dicts of arrays."""
from __future__ import annotations

import warnings
from typing import Any, Mapping

import numpy as np

from ._arrays import Array, as_colors, as_numbers
from ._context import Context, call_depth
from ._errors import ArgumentError, EwaWarning, FormatError
from .cloud import Cloud
from .mesh import read

#: Columns of several numbers for each point that stand for streams by another name.
_WIDE = {"positions": "position", "points": "position", "xyz": "position", "normals": "normal", "colors": "color",
         "rgb": "color", "rgba": "color"}


def cloud_of_columns(columns: Mapping[str, Any], context: Context | None) -> Cloud:
    """A cloud of columns of one number for each point, whose names say what they are as those of a text's columns do, or of
    up to four, which are streams of their names."""
    streams: dict[str, Any] = {}
    single: dict[str, Array] = {}
    left_out = []
    for name, value in columns.items():
        try:
            array = as_numbers(value, name)
        except ArgumentError:
            left_out.append(str(name))
            continue
        if array.ndim == 1:
            single[str(name)] = array
        elif array.ndim == 2 and 1 <= array.shape[1] <= 4:
            streams[_WIDE.get(str(name).lower(), str(name))] = array
        else:
            left_out.append(str(name))
    try:
        made = _parts(list(single), "position" in streams)
    except FormatError:
        raise ArgumentError(f"columns {', '.join(map(str, columns))}: none are x, y and z, by any usual name") from None
    for name, parts in made.items():
        arrays = [single[part] for part in parts]
        if name == "color":  # wide whole numbers first, whose codes may have fewer bits
            arrays = [as_colors(array, name) for array in arrays]
        streams[name] = arrays[0] if len(arrays) == 1 else np.stack(arrays, axis=1)
    if left_out:
        warnings.warn(f"columns that are no numbers are left out: {', '.join(left_out)}", EwaWarning,
                      stacklevel=call_depth())
    position = streams.pop("position")
    if position.dtype.kind == "f" and position.dtype.itemsize < 8:
        position = position.astype(np.float32)
    return Cloud(position, context=context, **streams)


def _parts(names: list[str], placed: bool) -> dict[str, list[str]]:
    """The streams that columns make up, and which, in the order of their components; `placed`: places are elsewhere.

    The reader of texts knows what programs call columns: it is given a line that has the number of each.
    """
    words = ["".join("_" if c in ",;\"'" or c.isspace() else c for c in name) or "-" for name in names]
    words += ["x", "y", "z"] if placed else []
    probe = read(" ".join(str(i + 1) for i in range(len(words))).encode(), columns=words)
    found: dict[str, list[str]] = {}
    for stream in probe:
        numbers = probe[stream].reshape(-1).astype(np.float64) + (probe.origin if stream == "position" else 0)
        if not (placed and stream == "position"):
            found[stream] = [names[int(round(number)) - 1] for number in numbers]
    return found
