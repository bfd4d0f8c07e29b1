# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Contexts, and the one way in which the library is called: locked, watched, and with exceptions.

One thread at a time may call into one context, so every call takes its lock and gives up the interpreter's. What is
no longer needed is destroyed under that lock too, at the next occasion, because the collector runs anywhere.
"""
from __future__ import annotations

import ctypes
import logging
import os
import signal
import sys
import threading
import warnings
import weakref
from collections import deque
from contextvars import ContextVar, copy_context
from types import TracebackType
from typing import TYPE_CHECKING, Any, Callable, Union

from . import _bindings as b
from ._errors import ClosedError, Error, EwaWarning, make
from ._keywords import keywords
from ._library import functions as lib
from ._options import ContextOptions, LimitsOptions
from ._struct import fill, initialised, table

if TYPE_CHECKING:
    from typing_extensions import Unpack


class ContextArguments(ContextOptions, LimitsOptions, total=False):
    """What a context is made with."""


#: Receives a stage and the share of it that is done, in [0, 1]; returning False stops the call.
ProgressFunction = Callable[[str, float], Union[bool, None]]

_main = threading.main_thread().ident
_log = logging.getLogger("ewa")
_watcher: ContextVar[ProgressFunction | None] = ContextVar("ewa_progress", default=None)


class Handle:
    """An object of the library, destroyed when nothing refers to it.

    `keep` are what it needs: arrays whose memory it borrows, other handles. `exports` counts the arrays that show its
    memory. An object is counted by `core.live` from the call on that made it, while the context was locked, so that the
    context is never destroyed before it.
    """

    __slots__ = ("core", "address", "destroy", "keep", "exports", "what", "__weakref__")

    def __init__(self, core: Core, address: int | None, destroy: Callable[..., None], what: str,
                 keep: tuple[Any, ...] = ()) -> None:
        self.core = core
        self.address = address
        self.destroy = destroy
        self.keep = keep
        self.exports = 0
        self.what = what
        core.handles.add(self)

    def __reduce__(self) -> Any:
        raise TypeError(f"{self.what}: no pickle is made of what the library holds; clouds, meshes, volumes, Gaussians, transfer "
                        "functions, cameras and images have one")

    def __del__(self) -> None:
        address, self.address = self.address, None
        if address and not sys.is_finalizing():
            self.core.discard(self.destroy, address, self.keep)


class Pin:
    """An array whose memory is borrowed, with where it was, so that memory that moved is noticed."""

    __slots__ = ("places", "what")

    def __init__(self, array: Any, what: str) -> None:
        self.what = what
        self.places: list[tuple[Any, int, int]] = []
        while hasattr(array, "__array_interface__") and hasattr(array, "nbytes"):
            self.places.append((array, array.__array_interface__["data"][0], array.nbytes))
            array = array.base

    def check(self) -> None:
        for array, address, size in self.places:
            if array.nbytes != size or array.__array_interface__["data"][0] != address:
                raise ClosedError(f"{self.what}: the memory of the array was freed or moved (ndarray.resize)")


def check_pins(handle: Handle) -> None:
    for kept in handle.keep:
        if type(kept) is Pin:
            kept.check()
        elif type(kept) is Handle and kept.keep:
            check_pins(kept)


class _State:
    """What callbacks leave behind; apart from Core, so that the two form no circle."""

    __slots__ = ("messages", "watcher", "error", "interrupted")

    def __init__(self) -> None:
        self.messages: list[tuple[int, str]] = []
        self.watcher: ProgressFunction | None = None
        self.error: BaseException | None = None
        self.interrupted = False

    def interrupt(self, number: int, frame: Any) -> None:
        """Takes Ctrl-C's place during a call, because an exception must not leave a callback."""
        self.interrupted = True


def _callbacks(state: _State) -> tuple[Any, Any]:
    def on_message(user: int | None, severity: int, text: bytes | None) -> None:
        state.messages.append((severity, (text or b"").decode("utf-8", "replace")))

    def on_progress(user: int | None, stage: bytes | None, fraction: float) -> bool:
        try:
            watcher = state.watcher
            if watcher is not None and watcher((stage or b"").decode(), fraction) is False:
                return False
            return state.error is None and not state.interrupted
        except BaseException as error:  # noqa: B902 - handed on by Core.call()
            state.error = error
            return False

    return b.ewa_message_callback(on_message), b.ewa_progress_callback(on_progress)


class Core:
    """The library's context with its lock; Context is what users hold."""

    def __reduce__(self) -> Any:
        raise TypeError("no pickle is made of a context: each process has its own")

    def __init__(self, options: b.ewa_context_options, progress: ProgressFunction | None) -> None:
        self.address: int | None = None
        self.closed = False
        self.lock = threading.Lock()
        self.owner: int | None = None
        self.process = os.getpid()
        self.state = _State()
        self.progress = progress
        self.trash: deque[tuple[Callable[..., None], int, Any]] = deque()
        self.handles: weakref.WeakSet[Handle] = weakref.WeakSet()
        self.renderers: dict[str, Handle] = {}
        self.live = 0  # objects that are to be destroyed before the context
        self.callbacks = _callbacks(self.state)
        options.message, options.progress = self.callbacks
        address = ctypes.c_void_p()
        status = lib.ewa_context_create(ctypes.byref(options), ctypes.byref(address))
        if status:
            raise make(status, "; ".join(text for _, text in self.state.messages))
        self.address = address.value

    def call(self, function: Callable[..., int], *arguments: Any) -> None:
        """Call a function that returns a status; handles among its arguments become their addresses."""
        self.run(function, arguments, True)

    def call_apart(self, function: Callable[..., int], *arguments: Any, keep: Any = ()) -> None:
        """Call what the library cannot stop, on another thread, so that Ctrl-C ends the wait at once; the call ends by itself, and
        until then `keep` stays."""
        if threading.get_ident() != _main:
            self.call(function, *arguments)
            return
        failed: list[BaseException] = []

        def work(kept: Any = keep) -> None:
            try:
                self.call(function, *arguments)
            except BaseException as error:  # noqa: B902 - raised by the thread that waits
                failed.append(error)

        thread = threading.Thread(target=copy_context().run, args=(work,))
        thread.start()
        thread.join()
        if failed:
            raise failed[0]

    def make(self, function: Callable[..., int], *arguments: Any, destroy: Callable[..., None], what: str,
             keep: tuple[Any, ...] = ()) -> Handle:
        """Call a function whose last argument receives a new object."""
        made = ctypes.c_void_p()

        def create(*given: Any) -> int:
            status = function(*given, ctypes.byref(made))
            self.live += 1 if made.value else 0
            return status

        try:
            self.call(create, *arguments)
        finally:
            handle = Handle(self, made.value, destroy, what, keep)
        return handle

    def value(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """Call a function that cannot fail, and return what it returns."""
        return self.run(function, arguments, False)

    def run(self, function: Callable[..., Any], arguments: tuple[Any, ...], checked: bool) -> Any:
        if self.owner == threading.get_ident():
            raise Error("a context was called from a callback or signal handler during its own call")
        if self.process != os.getpid():
            raise ClosedError("the context was made before os.fork(): its threads are in the other process")
        state = self.state
        handler: Any = None
        with self.lock:
            self.owner = threading.get_ident()
            try:
                if self.owner == _main:
                    handler = signal.getsignal(signal.SIGINT)
                    if handler is signal.default_int_handler:
                        signal.signal(signal.SIGINT, state.interrupt)
                if self.address is None or self.closed:
                    raise ClosedError("the context is closed")
                addresses = [self.resolve(a) if type(a) is Handle else a for a in arguments]
                if state.messages:
                    state.messages = []  # of a call that ended by an exception of ctypes
                state.watcher = _watcher.get() or self.progress
                result = function(*addresses)
                messages, error = state.messages, state.error
                state.messages, state.error = [], None
            finally:
                if handler is signal.default_int_handler:
                    signal.signal(signal.SIGINT, handler)
                self.owner = None
        if self.trash:
            self.sweep()
        if state.interrupted:
            state.interrupted = False
            raise KeyboardInterrupt
        if error is not None:
            raise error
        status = result if checked else 0
        if status or messages:
            _report(status, messages)
        return result

    def resolve(self, handle: Handle) -> int:
        if handle.core is not self:
            raise Error(f"{handle.what} is of another context")
        if handle.address is None:
            raise ClosedError(f"{handle.what} is closed")
        if handle.keep:
            check_pins(handle)
        return handle.address

    def discard(self, destroy: Callable[..., None], address: int, keep: Any) -> None:
        """Destroy an object now, or after the call that holds the lock."""
        self.trash.append((destroy, address, keep))
        self.sweep()

    def sweep(self) -> None:
        if self.process != os.getpid() or not self.lock.acquire(blocking=False):
            return
        try:
            self.empty()
        finally:
            self.lock.release()

    def empty(self) -> None:
        """Destroy what is not needed; the lock is held."""
        while self.trash:
            destroy, address, keep = self.trash.popleft()
            destroy(ctypes.byref(ctypes.c_void_p(address)))
            self.live -= 1
            del keep
        if self.closed and self.address and self.live == 0:
            address, self.address = self.address, None
            lib.ewa_context_destroy(ctypes.byref(ctypes.c_void_p(address)))

    def close(self) -> None:
        if self.process != os.getpid():
            self.closed, self.address = True, None
            return
        if self.owner == threading.get_ident():
            raise Error("a context cannot be closed during its own call")
        with self.lock:
            self.closed = True
            handles = list(self.handles)
            needed: set[int] = set()  # what arrays still show
            pending = [handle for handle in handles if handle.exports]
            while pending:
                handle = pending.pop()
                if id(handle) not in needed:
                    needed.add(id(handle))
                    pending += [other for other in handle.keep if isinstance(other, Handle)]
            for handle in handles:
                address = handle.address
                if address and id(handle) not in needed:
                    handle.address = None
                    self.trash.append((handle.destroy, address, None))
            self.empty()

    def __del__(self) -> None:
        if self.address and not sys.is_finalizing() and self.process == os.getpid():
            self.closed = True
            self.sweep()


def _report(status: int, messages: list[tuple[int, str]]) -> None:
    errors = [text for severity, text in messages if severity == b.ewa_severity.EWA_SEVERITY_ERROR]
    for severity, text in messages:
        if severity == b.ewa_severity.EWA_SEVERITY_WARNING:
            warnings.warn(text, EwaWarning, stacklevel=call_depth())
        elif severity > b.ewa_severity.EWA_SEVERITY_WARNING:
            _log.log(logging.INFO if severity <= b.ewa_severity.EWA_SEVERITY_INFO else logging.DEBUG, "%s", text)
    if status:
        raise make(status, "; ".join(errors))


def call_depth() -> int:
    """How far up the user's code is."""
    depth, frame = 1, sys._getframe(1)
    folder = os.path.dirname(__file__)
    while frame.f_back is not None and frame.f_code.co_filename.startswith(folder):
        depth, frame = depth + 1, frame.f_back
    return depth


@keywords("ewa_context_options", "ewa_limits")
class Context:
    """What all other objects are made from: worker threads, limits, messages.

    Calls into one context follow each other; contexts are independent, so that two Python threads with one each work
    at the same time. Functions that take no context use :func:`default_context`.

    Parameters
    ----------
    thread_count : int, optional
        Worker threads, 0 to 256; 0 (default): one per processor. Results do not depend on it.
    progress : callable, optional
        ``progress(stage, fraction)`` of every call; returning False stops it with :class:`Cancelled`.
    named_files : {"below", "anywhere", "none"}, optional
        Which files are opened that a file or folder names: regular ones below its own folder (default), anywhere, none.
    untrusted : bool, optional
        For inputs from anyone: small limits where none are given, and no file that another one names.
    **options

    Raises
    ------
    ArgumentError, OutOfMemory
    """

    def __init__(self, *, progress: ProgressFunction | None = None, **options: Unpack[ContextArguments]) -> None:
        made = initialised(b.ewa_context_options, lib.ewa_context_options_init)
        limits = table("ewa_limits")
        fill(made.limits, "ewa_limits", {key: value for key, value in options.items() if key in limits})
        fill(made, "ewa_context_options", {key: value for key, value in options.items() if key not in limits})
        self._core = Core(made, progress)

    @property
    def worker_count(self) -> int:
        """Number of worker threads."""
        return int(self._core.value(lib.ewa_context_worker_count, self._core.address))

    @property
    def closed(self) -> bool:
        """Whether :meth:`close` was called."""
        return self._core.closed

    def close(self) -> None:
        """End the threads and free everything that was made from the context, but what arrays still show.

        Whatever uses the context afterwards raises :class:`ClosedError`.
        """
        self._core.close()

    def __enter__(self) -> Context:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 trace: TracebackType | None) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<ewa.Context, {'closed' if self.closed else f'{self.worker_count} threads'}>"


_default: dict[int, Context] = {}


def default_context() -> Context:
    """Return the context of this process that is used where none is given; it is made at the first call.

    Returns
    -------
    Context
    """
    process = os.getpid()
    context = _default.get(process)
    if context is None or context.closed:
        context = _default[process] = Context()
    return context


def core_of(context: Context | Core | None) -> Core:
    if isinstance(context, Core):
        return context
    if context is None:
        context = default_context()
    elif not isinstance(context, Context):
        raise TypeError(f"context: an ewa.Context, not {type(context).__name__}")
    return context._core


class progress:
    """Show how far calls are, for the time of a ``with`` block.

    Parameters
    ----------
    function : callable, optional
        ``function(stage, fraction)``; returning False stops the call with :class:`Cancelled`. Default: a bar of
        ``tqdm``, which has to be installed.

    Examples
    --------
    >>> with ewa.progress():
    ...     surfels = ewa.read("scan.laz").surfels()
    """

    def __init__(self, function: ProgressFunction | None = None) -> None:
        self._function = function
        self._bar: Any = None
        self._stage = ""
        self._token: Any = None

    def _show(self, stage: str, fraction: float) -> bool | None:
        from tqdm.auto import tqdm

        if self._bar is None or stage != self._stage or fraction < self._bar.n:
            self._end()
            self._stage = stage
            self._bar = tqdm(total=1.0, desc=stage, bar_format="{desc}: {percentage:3.0f}%|{bar}| {elapsed}")
        self._bar.update(fraction - self._bar.n)
        return None

    def _end(self) -> None:
        if self._bar is not None:
            self._bar.close()
        self._bar = None

    def __enter__(self) -> progress:
        if self._function is None:
            import tqdm.auto  # noqa: F401 - says at once that it is missing
        self._token = _watcher.set(self._function or self._show)
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 trace: TracebackType | None) -> None:
        _watcher.reset(self._token)
        self._end()
