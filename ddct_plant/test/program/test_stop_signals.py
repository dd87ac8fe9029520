# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Signals are caught for as long as work lasts, and not a moment longer; so are lost parents."""

import os
import signal

import pytest

from ddct_plant.program.signals import (
    deferred_signals,
    interrupted_by,
    interruptible,
    obey_parent,
    stop_signals,
)


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_a_signal_is_noted_and_its_handler_comes_back(number):
    calls = []
    before = signal.signal(number, lambda *_: calls.append('before'))
    try:
        with stop_signals() as stops:
            os.kill(os.getpid(), number)
        assert (stops, calls) == ([number], [])
        os.kill(os.getpid(), number)
        assert (stops, calls) == ([number], ['before'])
    finally:
        signal.signal(number, before)


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_a_deferred_signal_interrupts_at_the_end(number):
    reached = []

    def work():
        with deferred_signals():
            os.kill(os.getpid(), number)
            reached.append('end')

    before = signal.signal(number, lambda *_: reached.append('before'))
    try:
        with interruptible() as called, pytest.raises(KeyboardInterrupt):
            called(work)
    finally:
        signal.signal(number, before)
    assert reached == ['end']
    assert interrupted_by() == number


def test_a_signal_that_was_ignored_stays_ignored():
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with interruptible() as called:
            called(lambda: os.kill(os.getpid(), signal.SIGINT))
    finally:
        signal.signal(signal.SIGINT, before)


@pytest.mark.process
def test_a_process_whose_parent_has_ended_before_ends_too():
    """The kernel sends no death signal for an end before the process has asked for one."""
    reader, writer = os.pipe()
    if not (parent := os.fork()):
        ours = os.getpid()
        if not os.fork():
            while os.getppid() == ours:
                pass
            obey_parent(ours)
            os.write(writer, b'alive')
        os._exit(0)
    os.close(writer)
    os.waitpid(parent, 0)
    with os.fdopen(reader, 'rb') as pipe:
        assert pipe.read() == b'', 'it has gone on as an orphan'
