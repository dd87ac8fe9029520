# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The watch of a node, in virtual time."""

import pytest

from ddct_plant.program import supervision
from ddct_plant.program.supervision import Patience, beat, supervise


class SteppedWatch:
    """Watch of the standard library, by a time that the test sets."""

    def __init__(self) -> None:
        self.now_s = self.due_s = 0.0

    def dump_traceback_later(self, timeout: float, *, exit: bool) -> None:
        """End the process after a time from now on, and at no other one."""
        assert exit
        self.due_s = self.now_s + timeout


def test_a_node_that_beats_goes_on_for_longer_than_its_patience(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    watch = SteppedWatch()
    monkeypatch.setattr(supervision, 'faulthandler', watch)
    monkeypatch.setattr(supervision, '_supervised', None)
    beat()
    assert watch.due_s == 0.0, 'no supervisor has started this process'
    supervise(Patience(start_s=3.0, silent_s=2.0), print)
    assert watch.due_s == 3.0
    for now_s in (2.5, 4.0, 5.5, 7.0):
        watch.now_s = now_s
        beat()
        assert watch.due_s == now_s + 2.0
