# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The settings of the layout are those that Foxglove's own description of layouts knows."""

import dataclasses
import re
import typing
from typing import Any

import pytest
from support.foxglove_layout import read_layout

OURS = {'foxglovePanelTitle'}
"""What an exported layout has beside a panel's settings; the SDK calls it `title`."""


@pytest.fixture(scope='module')
def layouts() -> Any:
    return pytest.importorskip('foxglove.layouts', reason='foxglove-sdk describes the layouts')


def _fields(settings: type) -> dict[str, Any]:
    """Return the type of each setting by its name in a layout file."""
    hints = typing.get_type_hints(settings)
    return {
        re.sub('_([a-z])', lambda m: m[1].upper(), field.name): hints[field.name]
        for field in dataclasses.fields(settings)
    }


def _choices(hint: Any) -> set[Any] | None:
    """Return the values of a `Literal | None`, or None for another type."""
    values = {
        value
        for part in typing.get_args(hint)
        if typing.get_origin(part) is typing.Literal
        for value in typing.get_args(part)
    }
    return values or None


def _unknown(config: dict[str, Any], settings: type) -> list[str]:
    known = _fields(settings)
    wrong = [key for key in config if key not in known and key not in OURS]
    for key, value in config.items():
        choices = _choices(known.get(key))
        if choices and value not in choices:
            wrong.append(f'{key}: {value}')
    return wrong


@pytest.mark.parametrize('panel', read_layout()['configById'])
def test_every_setting_is_one_of_foxglove(layouts: Any, panel: str) -> None:
    config = read_layout()['configById'][panel]
    kind = panel.split('!')[0]
    assert _unknown(config, getattr(layouts, f'{kind}Config')) == []
    series = {'Plot': 'PlotSeries', 'StateTransitions': 'StateTransitionsSeries'}
    for path in config.get('paths', []):
        assert _unknown(path, getattr(layouts, series[kind])) == []


def test_an_unknown_setting_and_an_unknown_choice_are_found(layouts: Any) -> None:
    wrong = {'legendDisplay': 'bottom', 'lengendDisplay': 'left', 'isSynced': True}
    assert _unknown(wrong, layouts.PlotConfig) == ['lengendDisplay', 'legendDisplay: bottom']
