# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every mistake that Foxglove would pass over in silence is found in the layout."""

from collections.abc import Callable
from typing import Any

from support.foxglove_layout import Messages, problems, read_layout
from support.runs import plan

from ddct_bringup.run.plan import RunPlan

Layout = dict[str, Any]


def _series(layout: Layout, panel: str, number: int = 0) -> dict[str, Any]:
    return layout['configById'][panel]['paths'][number]


def _set_path(panel: str, value: str) -> Callable[[Layout], None]:
    def change(layout: Layout) -> None:
        config = layout['configById'][panel]
        if 'paths' in config:
            config['paths'][0]['value'] = value
        else:
            config['topicPath'] = value

    return change


def _drop_series(topic: str) -> Callable[[Layout], None]:
    def change(layout: Layout) -> None:
        for config in layout['configById'].values():
            if 'paths' in config:
                config['paths'] = [p for p in config['paths'] if topic not in p['value']]

    return change


JOINTS = '/driveline/joint_states'
STATUS = '/controller/status.status[0].values[:]'
MUTATIONS: dict[str, tuple[Callable[[Layout], None], str]] = {
    'a misspelt topic': (_set_path('Plot!slip', '/clutch/slipp.twist.angular.x'), 'no such topic'),
    'a wrong field': (_set_path('Plot!slip', '/clutch/slip.twist.angular.w'), 'nothing there'),
    'a bad index': (_set_path('Plot!speeds', f'{JOINTS}.velocity[4]'), 'nothing there'),
    'a name filter on parallel arrays': (
        _set_path('Plot!speeds', f'{JOINTS}.velocity[:]{{name=="engine"}}'),
        'nothing there',
    ),
    'several values': (_set_path('Plot!speeds', f'{JOINTS}.velocity[:]'), 'not one value'),
    'a text in a plot': (
        _set_path('Plot!slip', f'{STATUS}{{key=="feedback"}}.value'),
        'not a number',
    ),
    'a key that no status has': (
        _set_path('StateTransitions!controller', f'{STATUS}{{key=="state"}}.value'),
        'nothing there',
    ),
    'a structure as a state': (
        _set_path('StateTransitions!controller', '/clutch/slip.twist'),
        'not a state',
    ),
    'no path at all': (_set_path('Plot!slip', '/clutch/slip.twist.'), 'not a message path'),
    'a topic without header': (_set_path('Plot!slip', '/clock.clock.nanosec'), 'no header stamp'),
    'one node of several that latch': (
        _set_path('Table!run', '/run_info.status[:]{name=="engine"}.values'),
        'nothing there',
    ),
    'a table of an empty list': (
        _set_path('Table!run', '/clutch/torque.points[0].velocities'),
        'nothing there',
    ),
    'the time of arrival': (
        lambda layout: _series(layout, 'Plot!slip').update(timestampMethod='receiveTime'),
        'not drawn at its stamp',
    ),
    'a series switched off': (
        lambda layout: _series(layout, 'Plot!slip').update(enabled=False),
        'switched off',
    ),
    'a plot on an axis of its own': (
        lambda layout: layout['configById']['Plot!slip'].update(isSynced=False),
        'not on the common time axis',
    ),
    'a plot over the index': (
        lambda layout: layout['configById']['Plot!slip'].update(xAxisVal='index'),
        'not on the common time axis',
    ),
    'a panel without settings': (
        lambda layout: layout['configById'].pop('Plot!slip'),
        'has no settings',
    ),
    'settings without a panel': (
        lambda layout: layout['layout'].update(first='Plot!slip'),
        'is shown nowhere',
    ),
    'an unused topic': (
        _drop_series('/load/torque'),
        '/load/torque is in the bag and in no panel',
    ),
    'a panel of what is not always there': (
        lambda layout: layout['configById']['Plot!engine_torque'].update(
            paths=[_series(layout, 'Plot!engine_torque', 2)]
        ),
        'Plot!engine_torque is empty',
    ),
}


def test_each_mistake_is_found(record: Callable[[RunPlan], Messages]) -> None:
    messages = record(plan('ls8', 'headless'))
    for name, (change, complaint) in MUTATIONS.items():
        layout = read_layout()
        assert problems(layout, messages) == []
        change(layout)
        found = problems(layout, messages)
        assert any(complaint in problem for problem in found), (name, found)
