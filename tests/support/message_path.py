# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Foxglove's message paths, as far as our layout uses them, with the behaviour of its panels."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

_TOPIC = re.compile(r'[\w/-]+')
_PART = re.compile(
    r'\.(?P<name>\w+)'
    r'|\[(?P<index>\d+)\]'
    r'|(?P<every>\[:\])'
    r'|\{(?P<key>\w+)==(?:"(?P<text>[^"]*)"|(?P<number>\d+))\}'
)


@dataclass(frozen=True)
class MessagePath:
    """A topic and the way to values within its messages."""

    topic: str
    parts: tuple[re.Match[str], ...]

    def values(self, message: Any) -> list[Any]:
        """Return what Foxglove finds in a message; where a step leads nowhere, nothing."""
        found = [message]
        for part in self.parts:
            found = [value for each in found for value in _step(each, part)]
        return found


def parse(text: str) -> MessagePath:
    """Return the path; raise ValueError where Foxglove, or this reader, cannot read it."""
    topic = _TOPIC.match(text)
    at = topic.end() if topic else 0
    parts = []
    while topic and at < len(text) and (part := _PART.match(text, at)):
        parts.append(part)
        at = part.end()
    if not topic or at < len(text):
        raise ValueError(f'not a message path from {text[at:]!r} on')
    return MessagePath(topic.group(), tuple(parts))


def _step(value: Any, part: re.Match[str]) -> Iterator[Any]:
    if part['name']:
        if hasattr(value, '__slots__') and part['name'] in value.__slots__:
            yield getattr(value, part['name'])
    elif part['key']:
        # A filter keeps or drops a structure; of a bare number or text it finds no field.
        wanted = part['text'] if part['text'] is not None else int(part['number'])
        if hasattr(value, '__slots__') and getattr(value, part['key'], None) == wanted:
            yield value
    elif _is_list(value):
        yield from value if part['every'] else value[int(part['index']) :][:1]


def _is_list(value: Any) -> bool:
    return hasattr(value, '__len__') and not isinstance(value, (str, bytes))
