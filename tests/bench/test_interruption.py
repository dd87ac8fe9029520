# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The first signal ends the bench; within a block that puts it off it comes at the end."""

import os
import signal
from collections.abc import Iterator

import pytest
from bench.skeleton.interruption import interrupt_once, uninterrupted

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


@pytest.fixture(autouse=True)
def handlers() -> Iterator[None]:
    """Handle the signals as the bench does; restore the handlers at the end."""
    before = {number: signal.getsignal(number) for number in SIGNALS}
    interrupt_once()
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.mark.parametrize('number', SIGNALS)
def test_a_signal_interrupts_and_further_ones_do_not(number: signal.Signals) -> None:
    with pytest.raises(KeyboardInterrupt):
        os.kill(os.getpid(), number)
    for further in SIGNALS:
        os.kill(os.getpid(), further)


def test_an_interruption_is_put_off_to_the_end_of_the_block() -> None:
    done = []
    with pytest.raises(KeyboardInterrupt), uninterrupted():
        os.kill(os.getpid(), signal.SIGTERM)
        done.append('started')
    assert done == ['started']
    with uninterrupted():
        pass
