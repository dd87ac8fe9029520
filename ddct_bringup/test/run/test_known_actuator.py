# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Our laws and designs are made for the known actuator; the true one reaches the plant alone."""

from dataclasses import replace
from typing import Any

import pytest
from other_actuators import SLOW, keys_of
from received import numbers_in, settings_with

from ddct_bringup.campaign.rows import scored_headless
from ddct_bringup.run.headless import run_headless
from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verdict.state import ENGAGED
from ddct_controllers.architecture import make_architecture
from ddct_controllers.handover.laws import HANDOVERS, make_handover
from ddct_controllers.interface import Measurement
from ddct_controllers.linear import PiController
from ddct_controllers.printed import PRINTED_CONTROLLERS
from ddct_controllers.registry import make_controller, own_controller_names
from ddct_plant.scenario.settings import RunSettings
from ddct_reference.factory import make_reference

pytestmark = pytest.mark.slow

OF_THE_THESIS = {
    *('pi', *PRINTED_CONTROLLERS),
    *('hinf_thesis', 'hinf_fitted'),
    *('mpc1', 'mpc2', 'mpc3'),
}
"""Controllers that keep the printed actuator."""


def known_and_unknown(scenario: str, **settings: Any) -> tuple[RunSettings, ...]:
    """Return a run with the printed actuator, one with another, and one where none knows it."""
    usual = settings_with({}, scenario, **settings)
    unknown = settings_with(keys_of(SLOW), scenario, **settings)
    known = RunSettings(
        replace(usual.known, scenario=replace(usual.scenario, actuator=SLOW)), usual.case
    )
    assert unknown.scenario.actuator == known.known.scenario.actuator == SLOW
    assert unknown.known == usual.known
    return usual, known, unknown


@pytest.mark.parametrize('name', own_controller_names())
def test_a_controller_changes_with_the_known_actuator_alone_unless_it_is_the_thesiss(name: str):
    runs = known_and_unknown('upshift')
    usual, known, unknown = (numbers_in(make_controller(name, run.known)) for run in runs)
    assert unknown == usual
    assert (known == usual) == (name in OF_THE_THESIS)


@pytest.mark.parametrize('name', HANDOVERS)
def test_a_handover_changes_with_the_known_actuator_alone(name: str) -> None:
    runs = known_and_unknown('upshift', handover=name)
    usual, known, unknown = (numbers_in(make_handover(run.known)) for run in runs)
    assert unknown == usual != known


def first_references(run: RunSettings) -> list[float]:
    """Return the references in rad/s before control starts."""
    reference = make_reference(run.known)
    return [reference.update(step, 0.0)[0][0] for step in range(50)]


def first_requests(run: RunSettings) -> list[float]:
    """Return the requests in N m for an engine torque that rises."""
    architecture = make_architecture(run.known, PiController(0.0, 0.0))
    return [
        architecture.update(
            Measurement(step, 200.0, 200.0, 20.0, 6.0, 10.0 * step, [0.0], [0.0], 0.0, 0.0)
        ).torque
        for step in range(10)
    ]


@pytest.mark.parametrize('architecture', ['feedforward', 'feedforward_tanh'])
def test_feedforward_and_stored_reference_change_with_the_known_actuator_alone(
    architecture: str,
) -> None:
    runs = known_and_unknown('thesis', architecture=architecture)
    for found in (first_references, first_requests):
        usual, known, unknown = (found(run) for run in runs)
        assert unknown == usual != known


def test_an_actuator_that_only_the_plant_has_changes_the_run() -> None:
    usual, known, unknown = (run_headless(run, 'lqi') for run in known_and_unknown('upshift'))
    assert len({usual.sha256(), known.sha256(), unknown.sha256()}) == 3


@pytest.mark.parametrize('name', ['ls8', 'mpc_wear', 'least_jerk'])
def test_a_shift_engages_with_a_slow_actuator_that_is_known_and_ties_up_with_an_unknown_one(
    name: str,
) -> None:
    """`tests/nightly/run/test_other_actuators.py` has every controller and a fast actuator."""
    _, known, unknown = known_and_unknown('upshift', duration_s=2.5)
    limits = packaged_limits()
    assert scored_headless(known, name, limits).state == ENGAGED
    assert scored_headless(unknown, name, limits).state == 'tied_up'
