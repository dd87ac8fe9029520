# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Settings of runs from options: one constructor for a run, a comparison, a sweep, a campaign."""

import argparse

import pytest
from refusals import refused

from ddct_bringup.api.arguments import base_from
from ddct_bringup.programs.options.of_runs import add_settings_options, settings_given
from ddct_bringup.run.run_base import RunBase
from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.chosen import print_adjusted


def options(*arguments: str) -> argparse.Namespace:
    parser = argparse.ArgumentParser()
    add_settings_options(parser)
    return parser.parse_args(arguments)


def base_of(given: argparse.Namespace, labels: list[str]) -> RunBase:
    return base_from(labels, **settings_given(given))


def test_the_last_of_a_repeated_key_counts_also_after_its_group() -> None:
    given = options(
        *(
            '--set',
            'controllers.pi.proportional_gain=1.0',
            '--set',
            'controllers.pi={integral_gain: 5.0}',
        ),
        *('--set', 'controllers.pi.proportional_gain=3.0'),
    )
    of_sweep = base_of(given, ['pi']).at({'wear_gain': 0.9})
    assert of_sweep.scenario.controllers == {
        'pi': {'integral_gain': 5.0, 'proportional_gain': 3.0}
    }
    assert base_of(given, ['pi']).at().scenario == of_sweep.scenario


def test_the_duration_of_the_option_counts_before_that_of_set() -> None:
    given = options('--set', 'duration_s=3.0', '--duration', '2.0')
    assert base_of(given, ['pi']).at().scenario.duration_s == 2.0


def test_adjusted_values_are_printed_for_a_run(capsys: pytest.CaptureFixture[str]) -> None:
    base = base_of(options('--set', 'vehicle.mass_kg=1.5'), ['pi'])
    print_adjusted(base.at().scenario)
    assert 'scenario thesis: ' in capsys.readouterr().err


def test_an_option_of_another_controller_is_refused() -> None:
    with refused(ParameterError, 'controllers.mine'):
        base_of(options('--set', 'controllers.mine.gain=3.0'), ['ls8']).at()


def test_a_scenario_that_no_key_changes_is_built_once() -> None:
    base = base_of(options(), ['pi'])
    worn, new = base.at({'wear_gain': 1.2}), base.at({'wear_gain': 1.0})
    assert worn.scenario is new.scenario
    assert (worn.case.wear_gain, new.case.wear_gain) == (1.2, 1.0)
    heavy = base.at({'wear_gain': 1.2, 'vehicle.mass_kg': 1500.0})
    assert heavy.scenario.vehicle.mass_kg == 1500.0
    assert base.at({'clutch': 'stick_slip'}).stick_slip
