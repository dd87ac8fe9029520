# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Fixtures of a running `live`; they skip a test where it cannot run."""

from collections.abc import Callable

import pytest
from support.processes import Program, Programs
from viewer import address_in
from waiting import wait_until


@pytest.fixture
def extras() -> None:
    """Skip where the optional packages are absent."""
    pytest.importorskip('foxglove.websocket', reason='foxglove-sdk, an optional extra, is absent')
    pytest.importorskip('websockets', reason='the viewer of these tests needs websockets')


@pytest.fixture
def live(extras: None, programs: Programs) -> Callable[..., tuple[Program, str]]:
    """Return a function that starts `live` and returns it with its address."""

    def start(*arguments: str) -> tuple[Program, str]:
        program = programs.start_module('ddct_bringup.programs.live', '--port', '0', *arguments)
        wait_until(
            lambda: 'ws://' in program.output() or program.process.poll() is not None,
            'the address of live',
        )
        return program, address_in(program.output())

    return start
