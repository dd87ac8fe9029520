# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The study of changes of the thesis scenario, here with few of them."""

import pytest

from ddct_bringup.reproduction.studies import scenario_changes as module
from ddct_bringup.reproduction.studies.scenario_changes import CHANGES, scenario_changes
from ddct_bringup.reproduction.studies.study import TABLE_5_1, cells, dash_reason
from ddct_bringup.reproduction.study_run import THESIS_SCENARIO, thesis_run
from ddct_plant.scenario.file import load_scenario


def test_changes_in_per_cent_are_those_of_the_packaged_values():
    def values(name):
        scenario = load_scenario('thesis', CHANGES[name])
        end, (_, rise) = scenario.engine.time_s[1], scenario.engine.torque_n_m
        return {
            'rise of C_m': rise,
            'end of the rise': end,
            'slope of the reference': scenario.reference.slope_rad_s2,
        }

    assert load_scenario('thesis', CHANGES['none']) == THESIS_SCENARIO
    packaged = values('none')
    for quantity, value in packaged.items():
        for share in (-5, 5):
            found = values(f'{quantity} {share:+d} %')
            assert found == packaged | {
                quantity: pytest.approx(value * (1.0 + share / 100.0), abs=5e-4)
            }


@pytest.mark.slow
def test_a_row_has_the_figures_of_the_predicted_rows_in_the_changed_scenario(monkeypatch):
    longest = 'score window to 3.0 s'
    monkeypatch.setattr(module, 'CHANGES', {name: CHANGES[name] for name in ('none', longest)})
    study = scenario_changes()
    frozen, longer = study.rows
    figures = [
        cell
        for name in ('mpc3', 'mpc4')
        for cell in cells(TABLE_5_1, thesis_run(name, 'detailed', 1.0))
    ]
    assert frozen[2:8] == tuple(figures)
    assert float(frozen[1]) < 1.0 < float(longer[1])
    assert frozen[-1] == '5 of 16'
    assert float(longer[3]) < float(frozen[3])
    assert dash_reason(study.headers[5], frozen) == dash_reason('t_a s', frozen)
    assert study.remarks[1:] == (
        'MPC3: 0 of the 2 scenarios hit all three figures at once; t_a in 2, std w_sr in 0, '
        'std A_x in 0 of them.',
        'MPC4: 0 of the 2 scenarios hit all three figures at once; t_a in 0, std w_sr in 1, '
        'std A_x in 0 of them.',
    )
