# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""All keys of a scenario and of its run by dotted name, and hints for an unknown key."""

import difflib
import re
from collections.abc import Collection, Iterable, Iterator
from dataclasses import fields
from functools import cache

from ddct_plant.base.errors import did_you_mean
from ddct_plant.base.options import Option, OptionGroup, Options, group_of, options_of
from ddct_plant.scenario.choices.settings import SETTINGS
from ddct_plant.scenario.scenario import Scenario

MOST_MEANT = 3
"""Largest number of keys in a hint."""
_ALIKE = 0.8
"""Least similarity of two keys; a common section alone gives about half."""
_GONE = {
    'driveline.total_ratio': 'a gear gives its ratio: give gear, or the measured ratio of that '
    'gear by gearbox.measured_gears and gearbox.measured_ratios',
}
"""What to give in place of a key that is no longer there."""
_PAGE = 'docs/use/cases.md'


@cache
def scenario_options() -> Options:
    """Return every option of a scenario by dotted key, without those of controllers."""
    return dict(_options(Scenario))


def key_hint(key: str, known: Options) -> str:
    """Return a hint for an unknown key: similar known keys, or the page that lists all keys."""
    if key in _GONE:
        return _GONE[key]
    meant = _meant(key, known)
    if not meant:
        return f'{_PAGE} lists the keys'
    *others, last = meant
    return f'did you mean {", ".join(others)} or {last}?' if others else f'did you mean {last}?'


def scenario_key_hint(name: str, section: Collection[str], prefix: str) -> str:
    """Return a hint for an unknown key: a key of its section, an option of the run, or any key."""
    if f'{prefix}{name}' in _GONE:
        return _GONE[f'{prefix}{name}']
    if meant := did_you_mean(name, section, prefix):
        return meant
    known = {**scenario_options(), **SETTINGS}
    for meant in _meant(f'{prefix}{name}', known):
        if meant in SETTINGS:
            option = f'--{meant.replace("_", "-")}'
            return f'{meant} stands beside the scenario: give it to the program, as {option}'
    if prefix and not any(each.startswith(prefix) for each in _meant(f'{prefix}{name}', known)):
        return f'known: {", ".join(section)}'
    return key_hint(f'{prefix}{name}', known)


def _meant(key: str, known: Options) -> list[str]:
    """
    Return the known keys that match `key`, by the first rule that finds any.

    The rules: the symbol at the start of the description, such as K_usura; a similar name; words
    of the name; a symbol anywhere in the description.
    """
    name = key.rpartition('.')[2]
    if not name:
        return []
    symbol = re.compile(rf'(?<!\w){re.escape(name)}(?!\w)')
    words = name.lower().split('_')
    rules: Iterable[Iterable[str]] = (
        (each for each, option in known.items() if symbol.match(option.description)),
        difflib.get_close_matches(key, known, n=1, cutoff=_ALIKE),
        (each for each in known if _has_words(each, words)),
        (each for each, option in known.items() if symbol.search(option.description)),
    )
    return next(filter(None, map(list, rules)), [])[:MOST_MEANT]


def _has_words(key: str, words: list[str]) -> bool:
    """Return whether the words are consecutive parts of the key."""
    parts = re.split('[._]', key)
    return any(parts[at : at + len(words)] == words for at in range(len(parts)))


def _options(group: type[OptionGroup]) -> Iterator[tuple[str, Option]]:
    yield from ((f'{group.prefix}{name}', each) for name, each in options_of(group).items())
    for field in fields(group):
        if nested := group_of(field):
            yield from _options(nested)
