# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Topics about a run itself: its nodes, the clock, the acknowledgement, wall-clock figures."""

from ddct_plant.signals.message_kind import MessageKind
from ddct_plant.signals.tables.rows import status_topic
from ddct_plant.signals.topic import Topic

RUN_INFO = status_topic('run_info', 'every node', every_tick=False, latched=True)
RUN_SETTINGS = status_topic('run_settings', 'recorder', every_tick=False, latched=True)
"""
Settings of the run, which nodes that are started by hand compare with their own.

It is in no recording, which has the settings once in its metadata, and so not in the table.
"""
CLOCK = Topic('/clock', MessageKind('rosgraph_msgs/msg/Clock'), 'driveline')
RECORDER_ACK = Topic('recorder/ack', MessageKind('std_msgs/msg/Header'), 'recorder')
CONTROLLER_TIMING = status_topic(
    'controller/timing',
    'controller',
    status_name='controller',
    every_tick=False,
    wall_clock=True,
)
DIAGNOSTICS = status_topic(
    '/diagnostics', 'driveline, engine, actuator', every_tick=False, wall_clock=True
)
