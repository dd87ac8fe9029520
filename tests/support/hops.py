# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every message of the loop on its way to a node."""

from ddct_bringup.run.plan import RunPlan
from ddct_plant.signals.topic import RunKind
from ddct_plant.signals.topics import recorded_topics

INPUTS = {
    'engine': ['driveline/joint_states'],
    'load': ['vehicle/twist'],
    'clutch': ['actuator/torque'],
    'actuator': ['clutch/torque_request'],
    'reference': ['clutch/slip'],
    'controller': [
        'driveline/joint_states',
        'vehicle/twist',
        'engine/torque',
        'clutch/slip_reference',
    ],
    'driveline': ['engine/torque', 'load/torque', 'clutch/torque', 'recorder/ack'],
    'recorder': [
        topic.name
        for topic in recorded_topics(RunKind())
        if topic.every_tick and topic.name != 'recorder/ack'
    ],
}
"""Topics that each node of a run without a shift reads."""


def inputs_of(run: RunPlan) -> dict[str, list[str]]:
    """Return the topics that each node of a run reads, by its full name within the graph."""
    if not run.settings.shift:
        return INPUTS
    share = 'clutch/handover_share'
    sticking = ['clutch/slip', 'clutch/phase']
    return {
        'load': INPUTS['load'],
        'actuator': INPUTS['actuator'],
        'engine': [*INPUTS['engine'], 'engine/torque_cut'],
        'clutch': [*INPUTS['clutch'], *sticking],
        'reference': [*INPUTS['reference'], share],
        'controller': [*INPUTS['controller'], share],
        'handover': [
            *('driveline/joint_states', 'clutch/slip', 'off_going/clutch/slip', 'vehicle/twist'),
            'engine/torque_demand',
        ],
        'off_going/actuator': ['off_going/clutch/torque_request'],
        'off_going/clutch': [f'off_going/{topic}' for topic in ('actuator/torque', *sticking)],
        'driveline': [*INPUTS['driveline'], 'load/holding_torque', 'off_going/clutch/torque'],
        'recorder': [
            topic.name
            for topic in recorded_topics(run.settings.kind())
            if topic.every_tick and topic.name != 'recorder/ack'
        ],
    }
