# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Finds and opens the shared library."""
from __future__ import annotations

import ctypes
import ctypes.util
import os
from pathlib import Path

from . import _bindings as b


def _candidates() -> list[str]:
    """Where the library may be, the likeliest first; EWA_LIBRARY alone where it is set."""
    asked = os.environ.get("EWA_LIBRARY")
    if asked:
        return [asked]
    package = Path(__file__).resolve().parent
    found = [str(path) for folder in (package, package.parents[1] / "build" / "release")
             for name in ("libewa.so", "libewa.dylib", "libewa.dll") for path in [folder / name] if path.exists()]
    installed = ctypes.util.find_library("ewa")
    return found + ([installed] if installed else []) + ["libewa.so.0"]


def _open() -> tuple[ctypes.CDLL, b.Functions]:
    problems = []
    for path in _candidates():
        try:
            library = ctypes.CDLL(path)
        except OSError as error:
            problems.append(str(error))
            continue
        try:
            functions = b.Functions(library)
        except AttributeError as error:
            raise ImportError(f"{path} is another version of libewa than this package: {error}") from None
        version = (functions.ewa_version() or b"").decode()
        wanted = (b.EWA_VERSION_MAJOR, b.EWA_VERSION_MINOR)
        if tuple(int(part) for part in version.split(".")[:2]) != wanted:
            raise ImportError(f"{path} is libewa {version}, this package is for {wanted[0]}.{wanted[1]}")
        return library, functions
    raise ImportError("libewa is not found; EWA_LIBRARY may name its file: " + "; ".join(problems))


#: The library, for its exported data, and its functions.
library, functions = _open()


def version() -> str:
    """Return the version of the library that runs, "major.minor.patch"."""
    return (functions.ewa_version() or b"").decode()
