# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A tuning from Python: tables of the front and of the trials."""

from pathlib import Path

import pytest
from small_tuning import CONTENT, leave_out_pictures

from ddct_bringup.api import document, run, tune

pytestmark = pytest.mark.slow


def test_the_front_and_the_trials_are_tables(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    leave_out_pictures(monkeypatch)
    found = tune('pi', {**CONTENT, 'trials': 4}, tmp_path / 'out', workers=1)
    assert list(found.trials.index) == list(range(4))
    assert found.front.index.isin(found.trials.index).all()
    best = found.front.loc[found.result.best]
    name = next(iter(CONTENT['objectives']))
    assert best[f'development.{name}'] == found.trials.loc[best.name, name]
    assert run(str(found.best), duration=0.7).valid
    (first, *_) = document(tmp_path / 'out').table('The best trial, and before').rows
    assert first
    again = tune('pi', {**CONTENT, 'trials': 4}, tmp_path / 'out', workers=1, resume=True)
    assert again.front.equals(found.front)
