# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller that searches finds no value of the case, whatever program makes it and runs it."""

from pathlib import Path
from typing import Any

import pytest
import small_benchmark
from received import UNKNOWN, found_in, keeper_file, settings_with, spy_file, true_values
from small_tuning import leave_out_pictures, tuning

from ddct_bringup.api import run
from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.conduct import carry_out
from ddct_bringup.campaign.spec import spec_of
from ddct_bringup.programs.sweep import main as sweep
from ddct_bringup.run.headless import run_headless
from ddct_bringup.tuning.conduct import carry_out_tuning
from ddct_bringup.tuning.report.folder import write_tuning
from ddct_bringup.verdict.limits import packaged_limits
from ddct_controllers.check.checks import check_controller
from ddct_controllers.check.program import main as check

pytestmark = pytest.mark.slow

CASE: dict[str, Any] = {key: UNKNOWN[key] for key in UNKNOWN if key != 'seed'}
GRID = {
    'scenario': ['launch'],
    'duration_s': [0.9],
    'sensors': [{'engine_speed': {'noise_rad_s': 0.1}}],
}
RANDOM = {
    'samples': 1,
    'vary': {key: {'distribution': 'choice', 'values': [value]} for key, value in CASE.items()},
}
SPEC: dict[str, Any] = {'seed': 4, 'grid': GRID, 'random': RANDOM}


def values_of(controller: str = 'pi') -> list[float]:
    """Return the values of the case of `SPEC`, its seed too."""
    (row,) = Campaign(spec_of({**SPEC, 'controllers': [controller]}, Path())).planned(0, 1)
    values = true_values(row.settings)  # type: ignore[union-attr]
    assert len(values) == len(CASE) + 2  # the inertia and the seed too
    return values


def notes_in(found: Path) -> set[str]:
    """Return what a searching controller has noted, and start anew."""
    notes = set(found.read_text(encoding='utf-8').splitlines())
    found.unlink()
    return notes


NOTHING = {'made []', 'held []', 'updated []'}


def test_the_search_finds_what_is_there() -> None:
    settings = settings_with(UNKNOWN)
    values = true_values(settings)

    def closure() -> object:
        return settings

    for root in (settings, {'a': [settings]}, closure, settings.kind):
        assert sorted(found_in(root, values)) == sorted(values)
    assert not found_in([settings.known, settings.known.kind], values)


def test_a_controller_of_a_run_finds_nothing(tmp_path: Path) -> None:
    settings = settings_with(UNKNOWN)
    file, found = spy_file(tmp_path, true_values(settings))
    run_headless(settings, file)
    assert notes_in(found) == NOTHING
    run(file, scenario='launch', case=UNKNOWN, duration=0.9, floors=True)
    assert notes_in(found) == NOTHING


def test_a_controller_of_a_campaign_and_of_a_sweep_finds_nothing(tmp_path: Path) -> None:
    file, found = spy_file(tmp_path, values_of())
    campaign = Campaign(spec_of({**SPEC, 'controllers': [file]}, Path()))
    carry_out(campaign, packaged_limits(), tmp_path / 'out', workers=2)
    assert notes_in(found) == NOTHING
    given = [f'--case={key}={value}' for key, value in CASE.items()]
    over = ['--over', 'load.slope_rad=0.01:0.02:2', '--scenario', 'launch', '--duration', '0.9']
    # The values stand in its own command line, so only what the controller is given is searched.
    keeper, kept = keeper_file(tmp_path)
    assert sweep(['--controllers', keeper, *over, *given]) == 0
    assert not found_in(kept, values_of())


@pytest.mark.nightly
def test_a_controller_of_a_tuning_finds_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    leave_out_pictures(monkeypatch)
    file, found = spy_file(tmp_path, values_of())
    made = tuning(
        file,
        parameters={'gain': {'low': 0.05, 'high': 0.2}},
        objectives={'engaged': {}},
        constraints={},
        campaign={key: SPEC[key] for key in ('grid', 'random')},
        trials=2,
        seed=4,
    )
    write_tuning(tmp_path / 'out', carry_out_tuning(made, tmp_path / 'out', workers=2), workers=2)
    assert notes_in(found) == NOTHING


@pytest.mark.nightly
def test_a_controller_of_a_benchmark_finds_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    content = {**SPEC, 'controllers': ['pi']}
    content['grid'] = {**GRID, 'scenario': ['launch', 'launch_hill']}
    monkeypatch.setattr(small_benchmark, 'SPEC', str(content))
    monkeypatch.setattr(small_benchmark, 'PACKAGED', ('pi',))
    small_benchmark.use_small_release(tmp_path, monkeypatch)
    file, found = spy_file(tmp_path, values_of())
    assert small_benchmark.judge(tmp_path / 'out', file, '--workers', '2') == 0
    assert notes_in(found) == NOTHING


def test_a_controller_that_is_checked_has_no_case(tmp_path: Path) -> None:
    settings = settings_with(UNKNOWN, 'thesis')
    file, found = spy_file(tmp_path, true_values(settings))
    check_controller(file, settings.known)
    assert notes_in(found) == NOTHING
    with pytest.raises(SystemExit):
        check([file, '--case', 'wear_gain=0.8'])
