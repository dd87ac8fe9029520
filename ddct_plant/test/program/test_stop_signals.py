# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Signals are caught for as long as work lasts, and not a moment longer."""

import os
import signal

import pytest

from ddct_plant.program.supervision import stop_signals


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
