# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What is wrong with a Foxglove layout for a bag; Foxglove itself says none of it."""

import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

from ddct_plant.signals.message_kind import stamp_ns
from ddct_plant.signals.topics import TOPICS
from support.message_path import parse

LAYOUT = Path(__file__).parents[2] / 'ddct_bringup' / 'foxglove' / 'ddct_layout.json'

NOT_FOR_PANELS = {
    '/clock': 'only the time, which is the axis',
    '/recorder/ack': 'only the time',
    '/off_going/run_info': 'a table shows the last message alone, and /run_info names the run',
    '/controller/timing': 'lists of numbers as text, which no panel draws; `score` reads them',
}
"""Why a recorded topic need not be in the layout."""

SOMETIMES = {topic.resolved_name for topic in TOPICS if topic.when or topic.wall_clock}
"""Topics that not every bag has."""

Messages = dict[str, list[tuple[int, Any]]]
"""Per topic the (log time in ns, message) of a bag."""


def read_layout() -> dict[str, Any]:
    return json.loads(LAYOUT.read_text(encoding='utf-8'))


def read_messages(bag: Path) -> Messages:
    (file,) = bag.glob('*.mcap')
    messages: Messages = {}
    with file.open('rb') as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        for entry in reader.iter_decoded_messages():
            pair = entry.message.log_time, entry.decoded_message
            messages.setdefault(entry.channel.topic, []).append(pair)
    return messages


def paths_of(panel_id: str, config: dict[str, Any]) -> list[str]:
    """Return the message paths of one panel."""
    if panel_id.startswith(('Plot!', 'StateTransitions!')):
        return [path['value'] for path in config['paths']]
    return [config['topicPath']]


def used_topics(layout: dict[str, Any]) -> set[str]:
    panels = layout['configById'].items()
    return {_topic(path) for panel in panels for path in paths_of(*panel)}


def problems(layout: dict[str, Any], messages: Messages) -> list[str]:
    """Return one line for everything that would stay empty, or not be as it looks."""
    return [*_arrangement(layout), *_unused(layout, messages), *_panels(layout, messages)]


def _arrangement(layout: dict[str, Any]) -> Iterator[str]:
    shown, configured = list(_leaves(layout['layout'])), list(layout['configById'])
    yield from (f'{panel} has no settings' for panel in shown if panel not in configured)
    yield from (f'{panel} is shown nowhere' for panel in configured if panel not in shown)


def _leaves(node: Any) -> Iterator[str]:
    if isinstance(node, str):
        yield node
    else:
        assert node['direction'] in ('row', 'column') and 0 < node['splitPercentage'] < 100
        yield from _leaves(node['first'])
        yield from _leaves(node['second'])


def _unused(layout: dict[str, Any], messages: Messages) -> Iterator[str]:
    used = used_topics(layout)
    for topic in messages:
        if topic not in used and topic not in NOT_FOR_PANELS:
            yield f'{topic} is in the bag and in no panel'


def _panels(layout: dict[str, Any], messages: Messages) -> Iterator[str]:
    for panel, config in layout['configById'].items():
        kind = panel.split('!')[0]
        found = {path: _path_problem(kind, path, messages) for path in paths_of(panel, config)}
        if not any(problem == '' for problem in found.values()):
            yield f'{panel} is empty'
        yield from (f'{panel}: {path}: {text}' for path, text in found.items() if text)
        if kind in ('Plot', 'StateTransitions'):
            yield from (f'{panel}: {text}' for text in _time_axis(kind, config, messages))


def _path_problem(kind: str, text: str, messages: Messages) -> str | None:
    """Return what is wrong with a path, '' if nothing, None if its topic may be absent here."""
    try:
        path = parse(text)
    except ValueError as error:
        return str(error)
    if path.topic not in messages:
        return None if path.topic in SOMETIMES else 'no such topic'
    found = [path.values(message) for _, message in messages[path.topic]]
    if kind in ('Plot', 'StateTransitions'):
        return _series_problem(kind, found)
    # Opening a bag, or moving in time, leaves only the last message before; any may be that one.
    return '' if all(values and _has_content(values[0]) for values in found) else 'nothing there'


def _series_problem(kind: str, found: list[list[Any]]) -> str:
    if not any(found):
        return 'nothing there'
    if any(len(values) != 1 for values in found):
        return 'not one value in each message: Foxglove draws no line'
    if kind == 'Plot' and not all(_is_number(values[0]) for values in found):
        return 'not a number'
    if kind == 'StateTransitions' and not isinstance(found[0][0], (str, int, float, bool)):
        return 'not a state'
    return ''


def _time_axis(kind: str, config: dict[str, Any], messages: Messages) -> Iterator[str]:
    if not config['isSynced'] or (kind == 'Plot' and config['xAxisVal'] != 'timestamp'):
        yield 'not on the common time axis'
    for each in config['paths']:
        if kind == 'Plot' and not each['enabled']:
            yield f'{each["value"]} is switched off'
        if each['timestampMethod'] != 'headerStamp':
            yield f'{each["value"]} is not drawn at its stamp, which the live view needs'
        for log_time, message in messages.get(_topic(each['value']), []):
            if not hasattr(message, 'header') or stamp_ns(message) != log_time:
                yield f'{each["value"]} has no header stamp, or not that of the bag'
                break


def _topic(text: str) -> str:
    try:
        return parse(text).topic
    except ValueError:
        return ''


def _is_number(value: Any) -> bool:
    try:
        return math.isfinite(float(value))
    except (TypeError, ValueError):
        return False


def _has_content(value: Any) -> bool:
    return not hasattr(value, '__len__') or len(value) > 0
