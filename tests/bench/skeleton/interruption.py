# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Interruption: the first signal ends the bench, and no second one disturbs the clean-up."""

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class _Interruption:
    """Whether an interruption is put off, and whether one has come meanwhile."""

    def __init__(self) -> None:
        self.put_off = False
        self.pending = False

    def __call__(self, number: int, frame: FrameType | None) -> None:
        for each in _SIGNALS:
            signal.signal(each, signal.SIG_IGN)
        if not self.put_off:
            raise KeyboardInterrupt
        self.pending = True


_interruption = _Interruption()


def interrupt_once() -> None:
    """Raise KeyboardInterrupt at the first of SIGINT, SIGTERM and SIGHUP, ignore further ones."""
    for number in _SIGNALS:
        signal.signal(number, _interruption)


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Put off an interruption to the end of the block, so that what it starts is known."""
    _interruption.put_off = True
    try:
        yield
    finally:
        _interruption.put_off = False
    if _interruption.pending:
        _interruption.pending = False
        raise KeyboardInterrupt
