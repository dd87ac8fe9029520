# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The ROS parameters of the owner of time, as a `TickPlan`."""

from collections.abc import Sequence

from ddct_plant.base.options import Option
from ddct_plant.base.timebase import LONGEST_S, steps_in
from ddct_plant.fail_safe.request_watch import CLUTCH_TIMEOUT_S
from ddct_plant.graph.node import GraphNode
from ddct_plant.graph.settings import declare, declare_fail_safe
from ddct_plant.signals.topic import Topic
from ddct_plant.signals.topics import RECORDER_ACK
from ddct_plant.ticks.tick_owner import TickPlan


def declare_tick_plan(
    node: GraphNode, torques: Sequence[Topic], clutches: Sequence[Topic]
) -> TickPlan:
    """
    Declare length, recorder and timeouts of a run on its owner of time; return them as a plan.

    `torques` are the topics that it integrates, in that order, `clutches` those of them with the
    torques of a clutch. Raise ParameterError for a value out of range.
    """
    duration_s = declare(
        node,
        'duration',
        Option(
            0.0,
            "length of the run; 0 is the scenario's",
            's',
            at_least=0.0,
            at_most=LONGEST_S,
            whole_periods=True,
        ),
    )
    recorder = declare(
        node, 'require_recorder', Option(False, 'whether each tick waits for recorder/ack')
    )
    return TickPlan(
        tuple(topic.name for topic in torques),
        tuple(topic.name for topic in clutches),
        RECORDER_ACK.name if recorder else '',
        steps=steps_in('duration', duration_s) or node.settings.scenario.steps,
        answer_timeout_s=declare(
            node,
            'answer_timeout_s',
            Option(60.0, 'wall time to wait for a reply', 's', at_least=0.1, at_most=LONGEST_S),
        ),
        fail_safe=declare_fail_safe(
            node,
            'clutch_timeout_s',
            CLUTCH_TIMEOUT_S,
            'Real time: when the torque of a clutch stays away for longer, that clutch opens; '
            'give more than request_timeout_s of actuator',
        ),
    )
