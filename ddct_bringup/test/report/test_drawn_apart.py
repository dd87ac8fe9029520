# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A page that is drawn in a process of its own, and what happens where that process ends."""

import os
from typing import Any

import pytest

from ddct_bringup.api import shell
from ddct_bringup.api.shell import pages


def _page(*content: Any) -> str:
    return f'{content} in {os.getpid()}'


def _end() -> None:
    os._exit(1)


@pytest.fixture(autouse=True)
def short_pages(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shell, 'report_page', _page)


@pytest.mark.process
def test_another_process_draws_the_page() -> None:
    with pages.drawn_apart() as draw:
        text, _, process = draw('runs', 'evidence', 'limits').rpartition(' in ')
    assert text == "('runs', 'evidence', 'limits')"
    assert int(process) != os.getpid()


@pytest.mark.process
def test_a_page_is_drawn_here_where_that_process_has_ended(monkeypatch) -> None:
    monkeypatch.setattr(pages, '_get_ready', _end)
    with pages.drawn_apart() as draw:
        assert draw('runs', 'evidence', 'limits').endswith(f' in {os.getpid()}')
