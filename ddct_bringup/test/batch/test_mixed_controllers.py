# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Controllers of several kinds are in one stack, and none depends on the others."""

from collections.abc import Sequence

import pytest
from samples import sampled

from ddct_bringup.batch import run_batch as module
from ddct_bringup.batch.batchable import kind_of, why_not_batchable
from ddct_bringup.batch.run_batch import run_batch
from ddct_bringup.verdict.limits import packaged_limits
from ddct_controllers.interface import Controller
from ddct_controllers.registry import make_controller
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

LIMITS = packaged_limits()
NAMES = ('pi', 'ls8', 'mpc3', 'pi', 'mpc_preview', 'least_jerk', 'ls3', 'mpc3')


@pytest.mark.parametrize('scenario', sampled(['thesis', 'launch'], every=2))
def test_a_result_does_not_depend_on_the_controllers_of_other_runs(
    scenario: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    short = {'duration_s': 1.2, 'control_start_s': 0.2, 'score_window_s': [0.2, 1.1]}
    known = KnownSettings(load_scenario(scenario, short))
    runs = [
        (
            RunSettings(known, CaseSettings(wear_gain=0.8 + 0.05 * place)),
            make_controller(name, known),
        )
        for place, name in enumerate(NAMES)
    ]
    assert {why_not_batchable(*run) for run in runs} == {''}
    assert len({kind_of(controller) for _, controller in runs}) == 3
    assert len({controller.preview_steps for _, controller in runs}) > 1
    sizes: list[int] = []
    simulate = module.simulate_batch

    def counted(
        runs: Sequence[RunSettings], controllers: Sequence[Controller], factor: float = 1.0
    ) -> module.Stack:
        sizes.append(len(runs))
        return simulate(runs, controllers, factor)

    monkeypatch.setattr(module, 'simulate_batch', counted)
    together = run_batch(runs, LIMITS)
    assert sizes[0] == len(runs), 'they are not in one stack'
    assert run_batch(runs[::-1], LIMITS)[::-1] == together
    assert [run_batch([run], LIMITS)[0] for run in runs] == together
    assert None not in together
