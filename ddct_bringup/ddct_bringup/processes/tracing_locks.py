"""
Forks with LTTng's tracing library loaded, as ROS 2 loads it.

The library starts two threads when it is loaded, which wait for somebody who traces. Its fork
handlers bring them to a place where they keep no lock, and start them anew in the fork, which can
then be traced too. The library calls them itself only where `liblttng-ust-fork.so` is preloaded.
"""

import ctypes
import os
import warnings
from pathlib import Path

_HANDLERS = ('before_fork', 'after_fork_parent', 'after_fork_child')
_PREFIXES = ('lttng_ust_', 'ust_')
"""Of their names: of LTTng 2.13, and of versions before."""
_SIGNALS_BYTES = 128
"""Of a sigset_t (Linux)."""


class TracingLocks:
    """The fork handlers of the tracing library, where a process has loaded it."""

    def __init__(self) -> None:
        """Look for them."""
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
        """Fork this process; return 0 in the new one, and here its id."""
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
