# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
All topics, in the order in which a tick is written, and the signals of a run; independent of ROS.

Nodes, recorder, reader, trajectory, the tables of signals and the live view use their names,
types, values and units. A new topic is an entry in the table of its subject in `tables/`, its
place in `TOPICS`, and the node that publishes it.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from operator import itemgetter

from ddct_plant.signals.sensed import SensedQuantity
from ddct_plant.signals.signal import RunKind, Signal
from ddct_plant.signals.tables.clutch import ACTUATOR_TORQUE, CLUTCH_TEMPERATURE, CLUTCH_TORQUE
from ddct_plant.signals.tables.control import (
    CONTROLLER_STATUS,
    ENGINE_REQUEST,
    SLIP_REFERENCE,
    TORQUE_PARTS,
    TORQUE_REQUEST,
)
from ddct_plant.signals.tables.driveline import (
    CLUTCH_PHASE,
    JOINT_STATES,
    SLIP,
    VEHICLE_ACCEL,
    VEHICLE_SPEED,
)
from ddct_plant.signals.tables.engine_and_load import (
    ENGINE_TORQUE,
    HOLDING_TORQUE,
    LOAD_TORQUE,
    TORQUE_DEMAND,
)
from ddct_plant.signals.tables.off_going import (
    HANDOVER_SHARE,
    OFF_GOING_ACTUATOR_TORQUE,
    OFF_GOING_CLUTCH_TEMPERATURE,
    OFF_GOING_CLUTCH_TORQUE,
    OFF_GOING_JOINT_STATES,
    OFF_GOING_PHASE,
    OFF_GOING_RUN_INFO,
    OFF_GOING_SLIP,
    OFF_GOING_TORQUE_REQUEST,
    TORQUE_CUT,
)
from ddct_plant.signals.tables.rows import if_sensed, if_shift
from ddct_plant.signals.tables.run import (
    CLOCK,
    CONTROLLER_TIMING,
    DIAGNOSTICS,
    RECORDER_ACK,
    RUN_INFO,
)
from ddct_plant.signals.tables.sensors import (
    DRIVELINE_SENSORS,
    ENGINE_SENSORS,
    SENSED_ENGINE_TORQUE,
    SENSED_JOINT_STATES,
    SENSED_SLIP,
    SENSED_VEHICLE_SPEED,
)
from ddct_plant.signals.topic import Topic


@dataclass(frozen=True)
class MeasurementTopics:
    """Topics from which controller and reference read the plant: of the sensors, or true."""

    joint_states: Topic
    """Topic of w_m, w_p and w_r."""
    slip: Topic
    """Topic of w_d."""
    vehicle_speed: Topic
    """Topic of V_x."""
    engine_torque: Topic
    """Topic of C_m."""


def measurement_topics(*, sensed: bool) -> MeasurementTopics:
    """Return the topics of the sensors for a run that has them, else those of the true signals."""
    if sensed:
        return MeasurementTopics(
            SENSED_JOINT_STATES, SENSED_SLIP, SENSED_VEHICLE_SPEED, SENSED_ENGINE_TORQUE
        )
    return MeasurementTopics(JOINT_STATES, SLIP, VEHICLE_SPEED, ENGINE_TORQUE)


TOPICS = (
    RUN_INFO,
    OFF_GOING_RUN_INFO,
    CLOCK,
    JOINT_STATES,
    OFF_GOING_JOINT_STATES,
    SLIP,
    OFF_GOING_SLIP,
    CLUTCH_PHASE,
    OFF_GOING_PHASE,
    VEHICLE_SPEED,
    VEHICLE_ACCEL,
    *DRIVELINE_SENSORS,
    TORQUE_DEMAND,
    HANDOVER_SHARE,
    OFF_GOING_TORQUE_REQUEST,
    TORQUE_CUT,
    ENGINE_TORQUE,
    *ENGINE_SENSORS,
    LOAD_TORQUE,
    HOLDING_TORQUE,
    SLIP_REFERENCE,
    CONTROLLER_STATUS,
    TORQUE_REQUEST,
    TORQUE_PARTS,
    ENGINE_REQUEST,
    ACTUATOR_TORQUE,
    OFF_GOING_ACTUATOR_TORQUE,
    CLUTCH_TORQUE,
    OFF_GOING_CLUTCH_TORQUE,
    CLUTCH_TEMPERATURE,
    OFF_GOING_CLUTCH_TEMPERATURE,
    RECORDER_ACK,
    CONTROLLER_TIMING,
    DIAGNOSTICS,
)
"""All topics: `run_info`, then the topics of each tick with `recorder/ack` last, then those of the
wall clock."""


SENSED_TOPICS = tuple(topic for topic in TOPICS if topic.when is if_sensed)
"""Topics of the sensors."""
SHIFT_TOPICS = tuple(topic for topic in TOPICS if topic.when is if_shift)
"""Topics of the off-going clutch and of the handover."""


def sensed_quantities(publisher: str = '') -> tuple[SensedQuantity, ...]:
    """Return the quantities that sensors measure, all or those that one node publishes."""
    topics = (each for each in TOPICS if publisher in ('', each.publisher))
    return tuple(each for topic in topics if topic.sensed for each in topic.sensed.quantities)


def sensed_signals(publisher: str) -> tuple[Signal, ...]:
    """Return the signals of sensors that a node publishes, measurements and flags."""
    topics = (each for each in SENSED_TOPICS if each.publisher == publisher)
    return tuple(signal for topic in topics for signal in topic.signals)


def all_topics() -> tuple[Topic, ...]:
    """Return all topics, in the order of the table."""
    return TOPICS


def recorded_topics(run: RunKind) -> tuple[Topic, ...]:
    """Return the topics that the recording of a run has, in writing order."""
    return tuple(
        topic for topic in TOPICS if topic.in_run(run) and not (run.lockstep and topic.wall_clock)
    )


def signals_of(run: RunKind) -> tuple[Signal, ...]:
    """Return the signals that a run has."""
    return tuple(each for topic in recorded_topics(run) for each in topic.signals_in(run))


def tick_names() -> frozenset[str]:
    """Return the names of the topics that the owner of time publishes with every tick."""
    return frozenset(topic.name for topic in TOPICS if topic.is_tick)


def all_signals() -> tuple[Signal, ...]:
    """Return every signal: numbers, then text, and last the signals of some runs only."""
    ranked = [
        ((bool(topic.when or signal.when), not signal.unit), signal)
        for topic in TOPICS
        for signal in topic.signals
    ]
    return tuple(signal for _, signal in sorted(ranked, key=itemgetter(0)))


def quantities() -> Mapping[str, tuple[Signal, int | None]]:
    """
    Return by name of each quantity its signal, and the index of its value at the tick in a row.

    The index is None for a signal with one value.
    """
    return _quantities(TOPICS)


@cache
def _quantities(topics: tuple[Topic, ...]) -> Mapping[str, tuple[Signal, int | None]]:
    return {
        name: (signal, None if signal.size == 1 else index)
        for topic in topics
        for signal in topic.signals
        for index, name in enumerate(signal.quantities)
    }
