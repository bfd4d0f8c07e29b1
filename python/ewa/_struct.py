# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Structs of options, filled by name and held to the library's own tables of types and ranges."""
from __future__ import annotations

import ctypes
import difflib
import math
import operator
import os
from typing import IO, Any, Callable, Mapping, NamedTuple, TypeVar, Union

from . import _bindings as b
from ._errors import ArgumentError
from ._library import functions as lib
from ._library import library
from ._options import OWN

#: A file: its path, what it holds, or itself, open for bytes.
Source = Union[str, "os.PathLike[str]", bytes, bytearray, memoryview, IO[bytes]]

_Struct = TypeVar("_Struct", bound=ctypes.Structure)
_TYPE = b.ewa_option_type


class Option(NamedTuple):
    """One row of a table of options."""

    name: str
    kind: int
    length: int
    low: float
    high: float
    low_open: bool
    high_open: bool
    or_zero: bool
    words: tuple[str, ...]
    allowed: str
    default: str
    unit: str
    help: str


#: Options of Scene.add() that are looked for where all is drawn.
_OF_THINGS = ("color_by", "colormap", "tint", "to_world", "transfer", "visible")

_tables: dict[str, dict[str, Option]] = {}


def table(struct: str) -> dict[str, Option]:
    """Return the options of a struct by name."""
    found = _tables.get(struct)
    if found is None:
        rows = b.ewa_option_table.in_dll(library, struct + "_table")
        found = {}
        for i in range(rows.option_count):
            row = rows.options[i]
            text = ctypes.create_string_buffer(b.EWA_OPTION_TEXT_BYTES)
            lib.ewa_option_range(ctypes.byref(row), text)
            name, words = row.name.decode(), tuple((row.words or b"").decode().split("|")) if row.words else ()
            found[name] = Option(
                name, row.type, row.count, row.minimum, row.maximum, bool(row.limits & b.EWA_OPTION_ABOVE),
                bool(row.limits & b.EWA_OPTION_BELOW), bool(row.limits & b.EWA_OPTION_OR_ZERO),
                words, text.value.decode(), _default(row, words), (row.unit or b"").decode(), (row.help or b"").decode())
        _tables[struct] = found
    return found


def _default(row: b.ewa_option, words: tuple[str, ...]) -> str:
    """The default of an option as Python has it."""
    if row.type == _TYPE.EWA_OPTION_BOOL:
        return str(bool(row.initial))
    if row.type == _TYPE.EWA_OPTION_CHOICE:
        return f'"{words[int(row.initial)]}"'
    if row.initials:
        return ", ".join(f"{number:.17g}" for number in (ctypes.c_double * row.count).from_address(row.initials))
    return f"{row.initial:.17g}" if float(f"{row.initial:.15g}") != row.initial else f"{row.initial:.15g}"


def _number(option: Option, value: Any, label: str) -> float | int:
    """A number of an option's type and range."""
    if isinstance(value, (bytes, str)) or isinstance(value, bool):
        raise ArgumentError(f"{label}: {value!r} is no number")
    number: float | int
    try:
        whole = option.kind in (_TYPE.EWA_OPTION_U32, _TYPE.EWA_OPTION_U64)
        number = operator.index(value) if whole else float(value)
    except (TypeError, ValueError, OverflowError):
        raise ArgumentError(f"{label}: {value!r} is no {'whole ' if whole else ''}number") from None
    fits = number >= option.low if not option.low_open else number > option.low
    fits = fits and (number <= option.high if not option.high_open else number < option.high)
    fits = (fits and math.isfinite(number)) or (option.or_zero and number == 0)
    if whole:
        fits = fits and 0 <= number < 2 ** (32 if option.kind == _TYPE.EWA_OPTION_U32 else 64)
    elif option.kind == _TYPE.EWA_OPTION_F32:
        fits = fits and abs(number) < 3.4028235677973366e38
    if not (str(number) in option.words if option.words else fits):
        raise ArgumentError(f"{label}: {number} is outside {option.allowed}")
    return number


def _convert(option: Option, value: Any, label: str) -> Any:
    if option.kind == _TYPE.EWA_OPTION_BOOL:
        if type(value).__name__ not in ("bool", "bool_"):
            raise ArgumentError(f"{label}: {value!r} is neither True nor False")
        return bool(value)
    if option.kind == _TYPE.EWA_OPTION_CHOICE:
        if isinstance(value, str):
            if value not in option.words:
                raise ArgumentError(f"{label}: '{value}' is none of {option.allowed}")
            return option.words.index(value)
        try:
            index = operator.index(value)
        except TypeError:
            raise ArgumentError(f"{label}: {value!r} is none of {option.allowed}") from None
        if not 0 <= index < len(option.words):
            raise ArgumentError(f"{label}: {index} is none of {option.allowed}")
        return index
    return _number(option, value, label)


def _flat(value: Any, label: str) -> list[Any]:
    try:
        items = list(value)
    except TypeError:
        raise ArgumentError(f"{label}: {value!r} is no sequence") from None
    flat: list[Any] = []
    for item in items:
        nested = hasattr(item, "__iter__") and not isinstance(item, (str, bytes))
        flat += _flat(item, label) if nested else [item]
        if len(flat) > 4096:
            raise ArgumentError(f"{label}: more than 4096 numbers")
    return flat


def fill(struct: ctypes.Structure, name: str, values: Mapping[str, Any], own: bool = False) -> None:
    """Set members of a struct of options from keyword arguments.

    None stands for the default. Raises ArgumentError, a ValueError, with the member and what it may be; TypeError for one
    that there is not. `own`: also those that the package sets by arguments of its own.
    """
    if not values:
        return
    options = table(name)
    for key, value in values.items():
        option = options.get(key)
        if option is None and key in _OF_THINGS:
            raise TypeError(f"{key} is said of each thing: ewa.Scene().add(thing, {key}=...)")
        if option is None or (not own and key in OWN.get(name, ())):
            known = [option for option in options if option not in OWN.get(name, ())]
            near = difflib.get_close_matches(key, known, 1)
            raise TypeError(f"{key} is no option of {name}{f': {near[0]}?' if near else ''}; those are {', '.join(known)}")
        if value is None:
            continue
        if not option.length:
            setattr(struct, key, _convert(option, value, key))
            continue
        numbers = _flat(value, key)
        if len(numbers) != option.length:
            raise ArgumentError(f"{key}: {len(numbers)} numbers, not {option.length}")
        converted = [_convert(option, number, key) for number in numbers]
        array = getattr(struct, key)
        if hasattr(array[0], "__len__"):  # two dimensions
            width = len(array[0])
            for i, number in enumerate(converted):
                array[i // width][i % width] = number
        else:
            array[:] = converted


def initialised(kind: type[_Struct], init: Callable[..., None]) -> _Struct:
    """A struct of options with its defaults."""
    made = kind()
    init(ctypes.byref(made), ctypes.sizeof(made))
    return made


def text_bytes(value: str, size: int, label: str) -> bytes:
    """A text that has room in `size` bytes, with its end."""
    made = value.encode()
    if len(made) >= size:
        raise ArgumentError(f"{label}: '{value[:20]}...' is longer than {size - 1} bytes")
    return made


def numbers(value: Any, count: int, label: str) -> Any:
    """`count` finite doubles as a C array."""
    flat = _flat(value, label)
    if len(flat) != count:
        raise ArgumentError(f"{label}: {len(flat)} numbers, not {count}")
    try:
        made = (ctypes.c_double * count)(*[float(number) for number in flat])
    except (TypeError, ValueError, OverflowError):
        raise ArgumentError(f"{label}: {value!r} are no {count} numbers") from None
    if not all(math.isfinite(number) for number in made):
        raise ArgumentError(f"{label}: {list(made)} are not all finite")
    return made


def path_bytes(path: Any, label: str = "path") -> bytes:
    """A path as the library takes it."""
    try:
        made = os.fsencode(path)
    except TypeError:
        raise TypeError(f"{label}: a path, not {type(path).__name__}") from None
    if not made or b"\0" in made:
        raise ArgumentError(f"{label}: {path!r} is no path")
    if made == b"-":
        raise ArgumentError(f"{label}: '-' stands for the program's standard input and output; './-' is a file")
    return made


def bytes_of(value: Any) -> bytes | None:
    """What a file holds, of its bytes or of an open file; None of all else."""
    if isinstance(value, (bytes, bytearray, memoryview)):
        return bytes(value)
    read = getattr(value, "read", None)
    if read is None or not hasattr(value, "seek"):
        return None
    place = value.tell()
    value.seek(0)  # the whole, however often it is asked for
    found = read()
    value.seek(place)
    if not isinstance(found, bytes):
        raise TypeError("a file that is open for bytes, not for text")
    return found


def loader(load: Any, load_memory: Any, source: Any, named: bool = False) -> tuple[Any, tuple[Any, ...]]:
    """The function of the library that reads a path, or the bytes of a file, and what it takes for it; `named`: files may
    name others, which those in memory do not."""
    data = bytes_of(source)
    if data is None:
        return load, (path_bytes(source),)
    return load_memory, (data, len(data), b"bytes", *((None,) if named else ()))
