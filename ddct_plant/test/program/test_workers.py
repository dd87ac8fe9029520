# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Work shared among processes has the results of one process; a killed worker is reported."""

import os
import signal

import pytest

from ddct_plant.base.errors import DdctError
from ddct_plant.program.workers import in_processes


def test_results_come_in_order_whatever_the_number_of_workers():
    for workers in (1, 2, 3):
        with in_processes(lambda index: index**2, 40, workers) as results:
            assert list(results) == [index**2 for index in range(40)]


def test_work_is_done_in_other_processes():
    with in_processes(lambda _: os.getpid(), 4, 2) as results:
        assert os.getpid() not in set(results)


def test_a_killed_worker_is_reported_in_a_line():
    with (
        pytest.raises(DdctError, match='killed'),
        in_processes(lambda _: os.kill(os.getpid(), signal.SIGKILL), 2, 2) as results,
    ):
        list(results)
