# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Fork with LTTng's tracing library loaded, as ROS 2 loads it.

The library starts two threads when it is loaded, which wait for a tracer. Its fork handlers bring
them to a place where they keep no lock, and start them again in the fork, which can then be traced
too. The library calls the handlers itself only where `liblttng-ust-fork.so` is preloaded.
"""

import ctypes
import os
import warnings
from pathlib import Path

_HANDLERS = ('before_fork', 'after_fork_parent', 'after_fork_child')
_PREFIXES = ('lttng_ust_', 'ust_')
"""Prefixes of the handlers' names: of LTTng 2.13, and of earlier versions."""
_SIGNALS_BYTES = 128
"""Size of a sigset_t in bytes (Linux)."""


class TracingLocks:
    """Fork handlers of the tracing library, where a process has loaded it."""

    def __init__(self) -> None:
        """Find the handlers in the loaded libraries."""
        maps = Path('/proc/self/maps').read_text(encoding='utf-8', errors='replace')
        words = {word for line in maps.splitlines() for word in line.split()[5:6]}
        self._handlers: list[ctypes._NamedFuncPointer] = []
        for path in sorted(word for word in words if Path(word).name.startswith('liblttng-ust')):
            library = ctypes.CDLL(path)
            for prefix in _PREFIXES:
                if all(hasattr(library, prefix + name) for name in _HANDLERS):
                    self._handlers = [getattr(library, prefix + name) for name in _HANDLERS]
                    return

    def fork(self) -> int:
        """Fork this process; return 0 in the child, and the child's process id in the parent."""
        signals = ctypes.create_string_buffer(_SIGNALS_BYTES)
        if self._handlers:
            before, in_parent, in_child = self._handlers
            before(signals)
        pid = _fork()
        if self._handlers:
            (in_parent if pid else in_child)(signals)
        return pid


def _fork() -> int:
    with warnings.catch_warnings():
        # The threads that Python 3.12 warns of are those of the tracing library.
        warnings.simplefilter('ignore', DeprecationWarning)
        return os.fork()
