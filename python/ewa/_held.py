# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Objects whose struct is the caller's: the library fills it, and frees what it points to."""
from __future__ import annotations

import ctypes
from typing import Any

from ._context import Core, Handle
from ._errors import ClosedError


class Held:
    """A struct of the library with the memory that belongs to it."""

    _what = "the object"
    _handle: Handle | None
    _struct: Any

    def _fill(self, core: Core, struct: Any, first: str, function: Any, free: Any, *arguments: Any) -> None:
        """Make the handle of a struct that a function fills; its member `first` says that it did."""

        def create(*given: Any) -> int:
            status: int = function(*given[:-1])
            if getattr(struct, first):
                given[-1]._obj.value = ctypes.addressof(struct)
            return status

        def destroy(_: Any) -> None:
            free(ctypes.byref(struct))

        self._struct = struct
        self._handle = core.make(create, *arguments, destroy=destroy, what=self._what)

    @property
    def _h(self) -> Handle:
        if self._handle is None or self._handle.core.closed:
            raise ClosedError(f"{self._what} was closed")
        return self._handle

    def _call(self, function: Any, *arguments: Any) -> None:
        self._h.core.call(self._bound(function), *arguments)

    def _bound(self, function: Any) -> Any:
        """A function with the struct as its first argument, for a call in which it cannot go away."""
        handle = self._h

        def checked(*given: Any) -> int:
            if handle.address is None and not handle.keep:
                raise ClosedError(f"{self._what} was closed")
            for pin in handle.keep:
                pin.check()
            status: int = function(ctypes.byref(self._struct), *given)
            return status

        return checked

    def close(self) -> None:
        """Free it; later use raises ClosedError."""
        self._handle = None
