# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The runs of `states_by_eye.yaml`, each made anew from its settings."""

from collections import deque
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import yaml

from ddct_bringup.metrics.engagement import Engagement
from ddct_bringup.run.headless import run_headless
from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verdict.state import LATE, NOT_ENGAGED, state_of
from ddct_controllers.interface import Command, Controller, Measurement
from ddct_controllers.registry import make_controller
from ddct_plant.base.clutch_kinds import STICK_SLIP
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

UNBOUND = ('friction.most_n_m=100000.0',)
"""
Change of the plant alone: a clutch without a limit of its torque, as in the labelled charts.
"""
FILE = Path(__file__).parents[1] / 'verdict' / 'states_by_eye.yaml'


class Spoiled(Controller):
    """A controller whose clutch torque is multiplied and comes later."""

    def __init__(self, controller: Controller, gain: float, delay_steps: int) -> None:
        self._controller, self._gain, self._delay_steps = controller, gain, delay_steps
        self.preview_steps = controller.preview_steps
        self.commands_engine = controller.commands_engine
        self.reset()

    def reset(self) -> None:
        self._controller.reset()
        self._waiting = deque([0.0] * self._delay_steps)

    def hold(self, measurement: Measurement) -> None:
        self._controller.hold(measurement)

    def update(self, measurement: Measurement) -> Command:
        command = self._controller.update(measurement)
        self._waiting.append(self._gain * command.clutch_torque)
        return replace(command, clutch_torque=self._waiting.popleft())


@dataclass(frozen=True)
class LabelledRun:
    """One entry of the file."""

    state: str
    """By eye."""
    second: str | None
    """The other state where the eye hesitates."""
    controller: str
    scenario: str
    wear_gain: float
    gain: float
    delay_steps: int
    set: tuple[str, ...]

    def comes_together(self) -> bool:
        """Run it headless, and return whether the plates turn together at its end by the rules."""
        known = load_scenario(self.scenario, self.set)
        unbound = UNBOUND if known.clutch == STICK_SLIP else ()
        true = load_scenario(self.scenario, [*unbound, *self.set])
        settings = RunSettings(
            KnownSettings(known), CaseSettings(wear_gain=self.wear_gain, scenario=true)
        )
        controller = make_controller(self.controller, settings.known)
        if self.gain != 1.0 or self.delay_steps:
            controller = Spoiled(controller, self.gain, self.delay_steps)
        trajectory = run_headless(settings, controller)
        engagement = Engagement(trajectory, true.control_start_step, (0, true.steps))
        return state_of(engagement, None, packaged_limits().rules).name not in (NOT_ENGAGED, LATE)


@cache
def labelled_runs(part: str) -> list[LabelledRun]:
    """Return the runs of a part of the file."""
    entries = yaml.safe_load(FILE.read_text(encoding='utf-8'))[part]
    return [_run(**entry) for entry in entries]


def _run(**entry) -> LabelledRun:
    return LabelledRun(
        second=entry.pop('or', None),
        gain=entry.pop('gain', 1.0),
        delay_steps=entry.pop('delay_steps', 0),
        set=tuple(entry.pop('set', ())),
        **entry,
    )
