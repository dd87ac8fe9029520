# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The rows of a specification are the same from memory, from a folder, and with any workers."""

from pathlib import Path
from typing import Any

import pytest
from refusals import refused

from ddct_bringup.campaign import scored
from ddct_bringup.campaign.run_specification import run_specification
from ddct_bringup.campaign.spec import CampaignSpec, spec_of
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.base.errors import ParameterError

VARY = {'vehicle.mass_kg': {'distribution': 'uniform', 'low': 1000, 'high': 2000}}
CONTENT: dict[str, Any] = {
    'controllers': ['pi', 'mpc3'],
    'grid': {'wear_gain': [0.7, 1.0], 'duration_s': [0.7]},
    'random': {'samples': 3, 'vary': VARY},
}


def spec(**changes: Any) -> CampaignSpec:
    return spec_of({**CONTENT, **changes}, Path())


@pytest.mark.process
def test_rows_are_the_same_from_memory_and_from_a_folder_with_any_workers(tmp_path: Path) -> None:
    limits = packaged_limits()
    rows = [[*run_specification(spec(), limits, workers=count)] for count in (1, 2, 3)]
    stored = [*run_specification(spec(), limits, workers=1, out=tmp_path / 'out')]
    assert [row['index'] for row in rows[0]] == list(range(12))
    assert rows[0] == rows[1] == rows[2]
    assert [{name: row[name] for name in stored[0]} for row in rows[0]] == stored
    assert {row['path'] for row in stored} == {'serial', 'vectorised'}


def test_the_first_row_comes_before_the_last_run_is_computed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    computed: list[int] = []
    planned = scored.RunSet.planned

    def counted(self: scored.RunSet, first: int, last: int) -> Any:
        computed.extend(range(first, last))
        return planned(self, first, last)

    monkeypatch.setattr(scored, '_LARGEST_PART_AT_ONCE', 2)
    monkeypatch.setattr(scored, '_LARGEST_PART_STEP_BY_STEP', 2)
    rows = run_specification(spec(), packaged_limits(), workers=1)
    monkeypatch.setattr(scored.RunSet, 'require_sound', lambda self: None)
    monkeypatch.setattr(scored.RunSet, 'planned', counted)
    assert next(rows)['index'] == 0
    rows.close()
    assert max(computed) < 2


def test_it_can_be_stopped_and_refuses_what_cannot_run() -> None:
    with pytest.raises(KeyboardInterrupt):
        [*run_specification(spec(), packaged_limits(), workers=1, stopped=lambda: True)]
    bad = spec(grid={'control_start_s': [2.4], 'duration_s': [1.0]})
    with refused(ParameterError, 'score_window_s') as caught:
        [*run_specification(bad, packaged_limits(), workers=1)]
    assert caught.value.place.startswith('run 0 (control_start_s 2.4')
