# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Shifts for tests: the packaged ones, and a loop with a handover by ramps and PI of the slip."""

from collections.abc import Callable
from typing import Any, NamedTuple

from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.gearbox import Gearbox
from ddct_plant.models.static_torque import StaticTorque
from ddct_plant.plant import Plant
from ddct_plant.scenario.choices.scenarios import Choice
from ddct_plant.scenario.file import ScenarioFile, load_scenario
from ddct_plant.scenario.initial_state import initial_request, locked_request
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings
from ddct_plant.shift.roles import OFF_GOING

HANDOVER_S, SLOPE = 0.2, 290.0
"""Length of the ramps in s, and slope of the slip reference in rad/s^2."""
_RPM = 9.549296585513721


def content(gears: tuple[int, int], kmh: float, torque: float, **other: Any) -> dict[str, Any]:
    """Return a scenario that drives at a speed in km/h, with an engine torque in N m."""
    wheel_speed = kmh / 3.6 / 0.3211345
    engine, shaft = (Gearbox().gear(gear).shaft_speed(wheel_speed) for gear in gears)
    return {
        'name': 'shift',
        'duration_s': 2.0,
        'control_start_s': 0.3,
        'score_window_s': [0.3, 2.0],
        'gear': gears[1],
        'equilibrium': 'full',
        'clutch': 'stick_slip',
        'initial': {'engine_speed_rad_s': engine, 'shaft_speed_rad_s': shaft},
        'engine': {'time_s': [0.0], 'torque_n_m': [torque]},
        'engine_limits': {},
        'closing': {},
        **other,
    }


SHIFTS = ('upshift', 'upshift_light', 'upshift_full', 'upshift_2_3', 'upshift_hot')
"""Names of the packaged shifts."""


def shift_settings(
    name: str, off_going_wear_gain: float = 1.0, handover: str = 'model', **keys: Any
) -> RunSettings:
    """Return the settings of a packaged shift; `keys` are those of its section."""
    changes = {f'shift.{key}': value for key, value in keys.items()}
    scenario = load_scenario(name, changes)
    return RunSettings(
        KnownSettings(scenario, handover=handover),
        CaseSettings(off_going_wear_gain=off_going_wear_gain),
    )


def settings_of(
    scenario: dict[str, Any],
    shift: dict[str, Any],
    off_going_wear_gain: float = 1.0,
) -> RunSettings:
    """Return the settings of a shift for the content of a scenario and of its section."""
    made = ScenarioFile(Choice('shift'), {**scenario, 'shift': shift}).scenario()
    return RunSettings(KnownSettings(made), CaseSettings(off_going_wear_gain=off_going_wear_gain))


class Sample(NamedTuple):
    """What the loop's law reads at a tick."""

    slip_speed: float
    engine_speed: float
    shaft_speed: float
    engine_torque: float
    load_torque: float


class Law:
    """Requests of both clutches from samples: ramps, then C_fOL and PI control of the slip."""

    def __init__(self, settings: RunSettings, first_request: float) -> None:
        scenario = self._scenario = settings.scenario
        self._first = first_request
        self._static = StaticTorque(scenario.driveline, 'full')
        self._start = scenario.control_start_step
        self._handover = round(HANDOVER_S / PERIOD_S)
        self._reference: float | None = None
        self._integral = 0.0
        self._near = 0

    def requests(self, step: int, sample: Sample) -> tuple[float, float]:
        """Return the requests of the on-coming and the off-going clutch in N m."""
        share = min(max(step - self._start, 0) / self._handover, 1.0)
        open_loop = self._static.torque(
            sample.engine_torque, sample.load_torque, sample.engine_speed, sample.shaft_speed
        )
        feedback = 0.0
        if share == 1.0:
            before = sample.slip_speed if self._reference is None else self._reference
            self._reference = max(before - SLOPE * PERIOD_S, 0.0)
            error = (self._reference - sample.slip_speed) * _RPM
            self._integral += error * PERIOD_S
            feedback = -0.103 * error - 0.0223 * self._integral
            self._near = self._near + 1 if abs(sample.slip_speed) < 1.0 else 0
        if self._near > 10:
            return locked_request(self._scenario, open_loop), 0.0
        return share * open_loop + feedback, (1.0 - share) * self._first


def run(settings: RunSettings, tick: Callable[[int, Plant, Any, Any], None]) -> Plant:
    """Run a shift and call `tick` with the step, the plant, its outputs and its reply."""
    plant = Plant(settings)
    law = Law(settings, initial_request(settings.known, OFF_GOING))
    reply = None
    for step in range(settings.scenario.steps + 1):
        observation = plant.observe(plant.tick(step), torque_cut=0.0)
        true = observation.tick.true
        load = true.joint_effort.wheel
        sample = Sample(
            true.slip_speed,
            true.engine_speed,
            true.shaft_speed,
            observation.engine_torque,
            load,
        )
        on_coming, off_going = law.requests(step, sample)
        reply = plant.reply(observation, on_coming, off_going_request=off_going)
        tick(step, plant, true, reply)
        if plant.over:
            break
        plant.advance(reply)
    return plant
