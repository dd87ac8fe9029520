# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Stacked handovers give the commands of each handover alone, whatever else is in the stack."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from samples import sampled
from shifts import SHIFTS

from ddct_bringup.batch.handovers.choice import make_handovers, why_no_handover
from ddct_controllers.handover.interface import Handover, HandoverCommand, HandoverMeasurement
from ddct_controllers.handover.laws import HANDOVERS
from ddct_controllers.linear import PiController
from ddct_controllers.loop import ClosedLoop
from ddct_plant.base.timebase import time_of_step
from ddct_plant.models.load import RoadLoad
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

STEPS, RUNS = 120, 17


class Recorded(Handover):
    """A handover whose measurements and commands are kept."""

    def __init__(self, handover: Handover, known: KnownSettings) -> None:
        self.handover, self.known = handover, known
        self.measured: list[HandoverMeasurement] = []
        self.commands: list[HandoverCommand] = []

    def update(self, measurement: HandoverMeasurement) -> HandoverCommand:
        command = self.handover.update(measurement)
        self.measured.append(measurement)
        self.commands.append(command)
        return command

    def load(self, step: int) -> float:
        """Return C_load that the handover knows at a step, in N m."""
        scenario = self.known.scenario
        road = RoadLoad(scenario.load, scenario.vehicle, scenario.slope)
        return road.torque(self.measured[step].vehicle_speed, time_of_step(step))


def varied(random: np.random.Generator, handover: str, index: int) -> RunSettings:
    """Return the settings of a shift with other numbers than the packaged one."""
    late = float(random.integers(0, 8)) / 100.0
    changes: dict[str, Any] = {
        'shift.handover_s': float(random.integers(5, 35)) / 100.0,
        'shift.handover_slip_rad_s': float(random.uniform(2.0, 8.0)),
        'shift.torque_cut_n_m': float(random.uniform(0.0, 40.0)),
        'vehicle.mass_kg': float(random.uniform(1200.0, 1800.0)),
        'actuator.delay_s': float(random.integers(0, 35)) / 1000.0,
        'closing.margin': float(random.uniform(1.1, 1.8)),
    }
    if random.random() < 0.5:
        changes['sensors'] = {'engine_speed': {'delay_s': late}, 'vehicle_speed': {'delay_s': 0.3}}
    if random.random() < 0.3:
        changes['engine_limits.full_load_n_m'] = [0, 90, 95, 100, 104, 110, 105, 0]
    return RunSettings(
        KnownSettings(load_scenario(SHIFTS[index % len(SHIFTS)], changes), handover=handover),
        CaseSettings(
            wear_gain=float(random.uniform(0.7, 1.3)),
            off_going_wear_gain=float(random.uniform(0.7, 1.3)),
            seed=index,
        ),
    )


def recorded(settings: RunSettings) -> Recorded:
    """Return the handover of a shift under PI control, after the run."""
    loop: Any = ClosedLoop(settings, PiController(0.1, 0.02))
    found = loop._handover = Recorded(loop._handover, settings.known)
    for _ in loop.replies(STEPS):
        pass
    return found


@pytest.fixture(scope='module', params=HANDOVERS)
def runs(request: pytest.FixtureRequest) -> tuple[str, list[Recorded]]:
    random = np.random.default_rng(53)
    return request.param, [recorded(varied(random, request.param, i)) for i in range(RUNS)]


def commands_of_stack(runs: list[Recorded]) -> np.ndarray:
    """Return the commands of a stack, (R, N+1, 5), from the measurements of each run."""
    law = make_handovers([run.known for run in runs])
    found = np.empty((len(runs), STEPS + 1, 5))
    for step in range(STEPS + 1):
        columns: Any = map(np.array, zip(*(run.measured[step][1:] for run in runs), strict=True))
        loads = np.array([run.load(step) for run in runs])
        command = law.update(HandoverMeasurement(step, *columns), loads)
        found[:, step] = np.transpose(command)
    return found


def test_a_stack_gives_the_commands_of_each_handover(runs: tuple[str, list[Recorded]]) -> None:
    name, each = runs
    found, expected = commands_of_stack(each), np.array([run.commands for run in each])
    peaks = np.abs(expected).max(axis=1, keepdims=True)
    assert np.all(np.abs(found - expected) <= 1e-9 * peaks)
    if name != 'adaptive':
        assert np.array_equal(found, expected)


@pytest.mark.parametrize('size', sampled([1, 2, 3, 1000], every=2))
def test_a_command_does_not_depend_on_the_rest_of_the_stack(
    runs: tuple[str, list[Recorded]], size: int
) -> None:
    _, each = runs
    found = commands_of_stack(each)
    places = np.arange(size) % RUNS
    assert np.array_equal(commands_of_stack([each[at] for at in places]), found[places])


def test_a_handover_of_a_third_party_is_named(tmp_path: Path) -> None:
    file = tmp_path / 'mine.py'
    file.write_text('')
    known = KnownSettings(load_scenario('upshift'), handover=str(file))
    assert why_no_handover(known) == 'the handover is mine, code of a third party'
    for name in HANDOVERS:
        assert why_no_handover(KnownSettings(load_scenario('upshift'), handover=name)) == ''
