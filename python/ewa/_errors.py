# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""What can go wrong, as exceptions."""
from __future__ import annotations

from . import _bindings as b


class Error(Exception):
    """A call that failed.

    Attributes
    ----------
    status : str
        Name of the library's status, such as ``"EWA_ERROR_FORMAT"``; ``"EWA_CLOSED"`` for what was closed.
    """

    status: str

    def __init__(self, message: str, status: str = "EWA_ERROR_ARGUMENT") -> None:
        super().__init__(message)
        self.status = status


class ArgumentError(Error, ValueError):
    """Something was passed that the function's contract excludes: a shape, a type, a number out of range."""


class NumericError(Error, ValueError):
    """A singular map, no finite value, no solution."""


class FormatError(Error, ValueError):
    """The bytes of a file contradict its format, or it is of none that is read."""


class FileError(Error, OSError):
    """The operating system refused: open, read, write, rename."""


class OutOfMemory(Error, MemoryError):
    """There is no memory, or a limit of the context would be exceeded."""


class Cancelled(Error):
    """A progress function returned false."""


class ClosedError(Error, RuntimeError):
    """A context, or something made from it, was used after it was closed."""

    def __init__(self, message: str) -> None:
        super().__init__(message, "EWA_CLOSED")


class EwaWarning(UserWarning):
    """What the library warns of."""


_KINDS: dict[int, type[Error]] = {
    b.ewa_status.EWA_ERROR_ARGUMENT: ArgumentError,
    b.ewa_status.EWA_ERROR_MEMORY: OutOfMemory,
    b.ewa_status.EWA_ERROR_IO: FileError,
    b.ewa_status.EWA_ERROR_FORMAT: FormatError,
    b.ewa_status.EWA_ERROR_UNSUPPORTED: FormatError,
    b.ewa_status.EWA_ERROR_LIMIT: OutOfMemory,
    b.ewa_status.EWA_ERROR_NUMERIC: NumericError,
    b.ewa_status.EWA_CANCELLED: Cancelled,
}


def make(status: int, message: str) -> Error:
    """Return the exception for a status."""
    try:
        name = b.ewa_status(status).name
    except ValueError:
        name = str(status)
    return _KINDS.get(status, Error)(message or name, name)
