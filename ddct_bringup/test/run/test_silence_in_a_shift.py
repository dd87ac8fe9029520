# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A shift in real time whose messages stop: each row of the table of what opens."""

from collections.abc import Collection
from typing import NamedTuple

import pytest

from ddct_bringup.run.headless import run_headless
from ddct_controllers.architecture import make_architecture
from ddct_controllers.handover.interface import HandoverCommand, HandoverMeasurement
from ddct_controllers.handover.laws import make_handover
from ddct_controllers.interface import Measurement
from ddct_controllers.registry import make_controller
from ddct_plant.base.timebase import stamp_of_step, time_of_step
from ddct_plant.fail_safe.guarded import GuardedActuator, GuardedEngine
from ddct_plant.fail_safe.request_watch import REQUEST_TIMEOUT_S, FailSafeSettings
from ddct_plant.models.driveline import OPEN, PHASES, DrivelineOutputs
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.initial_state import initial_request, initial_state
from ddct_plant.scenario.plant import (
    friction_clutch,
    holding_torque,
    make_actuator,
    make_driveline,
    make_engine,
    make_load,
)
from ddct_plant.scenario.settings import KnownSettings, RunSettings
from ddct_plant.shift.roles import OFF_GOING, ON_COMING
from ddct_plant.signals.topic import Topic
from ddct_plant.signals.topics import (
    CLUTCH_TORQUE,
    ENGINE_TORQUE,
    HANDOVER_SHARE,
    HOLDING_TORQUE,
    LOAD_TORQUE,
    OFF_GOING_CLUTCH_TORQUE,
    OFF_GOING_TORQUE_REQUEST,
    TORQUE_CUT,
    TORQUE_DEMAND,
    TORQUE_REQUEST,
)
from ddct_plant.ticks.realtime_owner import RealtimeOwner
from ddct_plant.ticks.tick_owner import Reply, TickPlan
from ddct_reference.factory import make_reference

SILENT_FROM = 60
"""First step without the messages, in the handover, which lasts from step 30 to 130."""
OPEN_BY = SILENT_FROM + 45 + 10
"""Step by which the table promises an open clutch: 0.45 s, and the lag of the actuator."""
HANDOVER = (HANDOVER_SHARE, OFF_GOING_TORQUE_REQUEST, TORQUE_CUT)
SETTINGS = RunSettings(
    KnownSettings(load_scenario('upshift', {'shift.handover_s': 1.0}), handover='timed')
)
STEPS = SETTINGS.scenario.steps
TORQUES = (ENGINE_TORQUE, LOAD_TORQUE, HOLDING_TORQUE, CLUTCH_TORQUE, OFF_GOING_CLUTCH_TORQUE)


class Side:
    """Actuator with its fail-safe, and clutch, of one side."""

    def __init__(self, role: str) -> None:
        first = initial_request(SETTINGS.known, role)
        actuator = make_actuator(SETTINGS, first)
        self.actuator = GuardedActuator(actuator, first, FailSafeSettings())
        self._clutch = friction_clutch(SETTINGS, role)

    def capacities(
        self, step: int, request: float | None, slip: float, work: float
    ) -> list[list[float]] | None:
        """Return the capacities of a period, None where the actuator is silent."""
        torques = self.actuator.tick(step)
        if torques is None and request is not None:
            torques = self.actuator.request(step, request)
        return None if torques is None else list(self._clutch.reply(step, torques, slip, work)[:2])


class RealTimeShift:
    """The parts of a shift connected as the nodes are; some messages stop on the way."""

    def __init__(self, missing: Collection[Topic]) -> None:
        """`missing` are the topics without a message from `SILENT_FROM` on."""
        self._missing = missing
        self._now = 0.0
        self.outputs: list[DrivelineOutputs] = []
        self.sides = {role: Side(role) for role in (ON_COMING, OFF_GOING)}
        self.engine = GuardedEngine(make_engine(SETTINGS), REQUEST_TIMEOUT_S)
        self._demand = make_engine(SETTINGS).demand
        self._load, self._holding = make_load(SETTINGS), holding_torque(SETTINGS)
        self._handover = make_handover(SETTINGS.known)
        controller = make_controller('pi', SETTINGS.known)
        self._reference = make_reference(SETTINGS.known, controller.preview_steps)
        self._architecture = make_architecture(SETTINGS.known, controller)
        self._driveline = make_driveline(SETTINGS, initial_state(SETTINGS))
        clutches = CLUTCH_TORQUE.name, OFF_GOING_CLUTCH_TORQUE.name
        self.owner = RealtimeOwner(
            self._driveline.step,
            TickPlan(tuple(topic.name for topic in TORQUES), clutches, '', STEPS, 1.0),
            self._answer,
            lambda error: None,
            clock=lambda: self._now,
        )
        self.owner.start()

    def go_to(self, last: int) -> None:
        """Step until t_last is out."""
        for step in range(self.owner.step + 1, last + 1):
            self._now = time_of_step(step) + 1e-4
            self.owner.tick()

    def _comes(self, topic: Topic, step: int) -> bool:
        return step < SILENT_FROM or topic not in self._missing

    def _answer(self, step: int) -> None:
        """Answer a tick as the nodes do, each with what has come."""
        outputs = self._driveline.outputs()
        self.outputs.append(outputs)
        other = outputs.off_going
        assert other is not None
        command = self._command(step, outputs)
        torque = self._engine_torque(step, outputs, command)
        request = self._request(step, outputs, command, torque)
        comes = self._comes(OFF_GOING_TORQUE_REQUEST, step)
        assert outputs.friction_work is not None
        replies: dict[Topic, Reply] = {
            ENGINE_TORQUE: torque,
            LOAD_TORQUE: self._load.torque(outputs.vehicle_speed, time_of_step(step)),
            CLUTCH_TORQUE: self.sides[ON_COMING].capacities(
                step, request, outputs.slip_speed, outputs.friction_work
            ),
            HOLDING_TORQUE: self._holding.capacity(time_of_step(step)),
            OFF_GOING_CLUTCH_TORQUE: self.sides[OFF_GOING].capacities(
                step,
                command.off_going_request if command and comes else None,
                other.slip_speed,
                other.friction_work,
            ),
        }
        for topic, reply in replies.items():
            if reply is not None and self._comes(topic, step):
                self.owner.offer(topic.name, stamp_of_step(step), reply)

    def _command(self, step: int, outputs: DrivelineOutputs) -> HandoverCommand | None:
        """Return what the handover answers, None while it waits for the demand."""
        if not self._comes(TORQUE_DEMAND, step):
            return None
        assert outputs.off_going is not None
        return self._handover.update(
            HandoverMeasurement(
                step,
                self._demand(step),
                outputs.engine_speed,
                outputs.slip_speed,
                outputs.off_going.slip_speed,
                outputs.vehicle_speed,
            )
        )

    def _engine_torque(
        self, step: int, outputs: DrivelineOutputs, command: HandoverCommand | None
    ) -> float | None:
        if not self._comes(ENGINE_TORQUE, step):
            return None
        self.engine.speed = outputs.engine_speed
        torque = self.engine.tick(step)
        if torque is None and command and self._comes(TORQUE_CUT, step):
            torque = self.engine.request(step, self._demand(step) - command.torque_cut)
        return torque

    def _request(
        self,
        step: int,
        outputs: DrivelineOutputs,
        command: HandoverCommand | None,
        torque: float | None,
    ) -> float | None:
        if command is None or torque is None or not self._comes(HANDOVER_SHARE, step):
            return None
        speeds, rates = self._reference.update(
            step, outputs.slip_speed, outputs.shaft_speed, command.share
        )
        measurement = Measurement(
            step=step,
            engine_speed=outputs.engine_speed,
            shaft_speed=outputs.shaft_speed,
            wheel_speed=outputs.wheel_speed,
            vehicle_speed=outputs.vehicle_speed,
            engine_torque=torque,
            slip_reference=speeds,
            slip_reference_rate=rates,
        )
        request = self._architecture.update(measurement, command.on_coming).torque
        return request if self._comes(TORQUE_REQUEST, step) else None


def test_with_every_message_it_is_the_run_in_lock_step() -> None:
    run, expected = RealTimeShift(()), run_headless(SETTINGS, 'pi')
    run.go_to(STEPS)
    assert len(run.outputs) == expected.steps + 1
    for step, outputs in enumerate(run.outputs):
        assert outputs.off_going is not None
        assert outputs.slip_speed == expected.slip_speed[step]
        assert outputs.off_going.slip_speed == expected.off_going_slip_speed[step]


class Row(NamedTuple):
    """What is missing, who notices it, and which sides open."""

    missing: tuple[Topic, ...]
    notices: set[str]
    opens: set[str]


ROWS = {
    'controller': Row((TORQUE_REQUEST,), {'actuator'}, {ON_COMING}),
    'off-going request': Row((OFF_GOING_TORQUE_REQUEST,), {'off_going/actuator'}, {OFF_GOING}),
    'share': Row((HANDOVER_SHARE,), {'actuator'}, {ON_COMING}),
    'cut': Row((TORQUE_CUT,), {'actuator', 'engine'}, {ON_COMING}),
    'handover': Row(
        HANDOVER, {'actuator', 'off_going/actuator', 'engine'}, {ON_COMING, OFF_GOING}
    ),
    'engine': Row(
        (TORQUE_DEMAND, ENGINE_TORQUE), {'actuator', 'off_going/actuator'}, {ON_COMING, OFF_GOING}
    ),
    'load': Row((LOAD_TORQUE, HOLDING_TORQUE), set(), set()),
    'clutch torque': Row((CLUTCH_TORQUE,), {'driveline'}, {ON_COMING}),
    'off-going clutch torque': Row((OFF_GOING_CLUTCH_TORQUE,), {'driveline'}, {OFF_GOING}),
    'both, as with two publishers': Row(
        (CLUTCH_TORQUE, OFF_GOING_CLUTCH_TORQUE), {'driveline'}, {ON_COMING, OFF_GOING}
    ),
}


@pytest.mark.parametrize('row', ROWS.values(), ids=ROWS)
def test_the_clutch_that_follows_what_is_missing_opens_in_time_and_stays_open(row: Row) -> None:
    run = RealTimeShift(row.missing)
    run.go_to(125)
    noticed = {
        'actuator': run.sides[ON_COMING].actuator.watch.stopped,
        'off_going/actuator': run.sides[OFF_GOING].actuator.watch.stopped,
        'engine': run.engine.watch.stopped,
        'driveline': bool(run.owner.safe_clutches),
    }
    assert {who for who, does in noticed.items() if does} == row.notices
    assert carrying(run.outputs[SILENT_FROM]) == {ON_COMING, OFF_GOING}
    for outputs in run.outputs[OPEN_BY:]:
        assert carrying(outputs) == {ON_COMING, OFF_GOING} - row.opens


def carrying(outputs: DrivelineOutputs) -> set[str]:
    """Return the sides whose clutch is not open."""
    assert outputs.off_going is not None
    phases = {
        ON_COMING: outputs.clutch_phase,
        OFF_GOING: outputs.off_going.clutch_phase,
    }
    return {side for side, phase in phases.items() if PHASES[int(phase or 0.0)] != OPEN}
