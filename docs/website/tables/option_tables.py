# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of options in the pages, made from the declarations in the code."""

import dataclasses
from collections.abc import Sequence

from ddct_bringup.bag.measured_keys import MeasuredKeys
from ddct_controllers.mpc.costs import BASIS
from ddct_controllers.mpc.program.settings import program_options
from ddct_controllers.registry import controller_spec
from ddct_plant.base.option import option_rows
from ddct_plant.base.options import OptionGroup, Options, group_of, options_of
from ddct_plant.program.table import TextTable
from ddct_plant.scenario.choices.settings import SETTINGS
from ddct_plant.scenario.nouns.keys import CAR, DRIVE, SCENARIO, owner_of
from ddct_plant.scenario.scenario import Scenario

_HEADERS = ('key', 'unit', 'default', 'range', 'meaning', 'source')
"""Headers of the rows that `option_rows` returns."""


def _keys(owner: str) -> TextTable:
    """Return the keys of a scenario that belong to the car, the drive or the file itself."""
    rows = [_code(row) for row in _rows(Scenario) if owner_of(row[0]) == owner]
    return TextTable('', _HEADERS, rows)


def _rows(group: type[OptionGroup]) -> list[tuple[str, ...]]:
    """Return the options of a group and of the groups in it, in their order."""
    rows = []
    for field in dataclasses.fields(group):
        if inner := group_of(field):
            rows += _rows(inner)
        elif 'option' in field.metadata:
            rows += option_rows({field.name: field.metadata['option']}, group.prefix)
    return rows


def _controllers(*names: str, without: Sequence[str] = ()) -> TextTable:
    """Return the options of controllers; a default that differs between them is given for each."""
    declared: dict[str, Options] = {name: controller_spec(name).options or {} for name in names}
    rows = []
    for key in dict.fromkeys(key for options in declared.values() for key in options):
        if key in without:
            continue
        takers = {name: options for name, options in declared.items() if key in options}
        (row,) = option_rows({key: next(iter(takers.values()))[key]})
        having: dict[str, list[str]] = {}
        for name, options in takers.items():
            having.setdefault(options[key].default_text, []).append(f'`{name}`')
        if len(having) > 1 or len(takers) < len(names):
            texts = (f'{text} ({", ".join(those)})' for text, those in having.items())
            row = (*row[:2], ', '.join(texts), *row[3:])
        rows.append(_code(row)[:-1])
    return TextTable('', _HEADERS[:-1], rows)


def _without_source(options: Options, prefix: str = '') -> TextTable:
    rows = option_rows(options, prefix)
    return TextTable('', _HEADERS[:-1], [_code(row)[:-1] for row in rows])


def _code(row: Sequence[str]) -> tuple[str, ...]:
    return (f'`{row[0]}`', *row[1:])


_OF_EVERY_MPC = tuple(program_options(BASIS.settings()))
TABLES = {
    **{owner: _keys(owner) for owner in (SCENARIO, CAR, DRIVE)},
    'run': _without_source(SETTINGS),
    'measured_run': _without_source(options_of(MeasuredKeys), MeasuredKeys.prefix),
    'pi': _controllers('pi'),
    'mpc': _controllers('mpc1', 'mpc2', 'mpc3', 'mpc_preview'),
    'mpc4': _controllers('mpc4', 'mpc4_wear', without=_OF_EVERY_MPC[3:]),
    'mpc_offset_free': _controllers('mpc_offset_free', without=_OF_EVERY_MPC),
    'mpc_torsion': _controllers(
        'mpc_torsion', without=tuple(controller_spec('mpc_offset_free').options or ())
    ),
    'mpc_wear': _controllers('mpc_wear', without=_OF_EVERY_MPC),
    'decoupled_pid': _controllers('decoupled_pid'),
    'torque_estimator': _controllers('torque_estimator'),
    'pedal_mpc': _controllers('pedal_mpc'),
    'lqi': _controllers('lqi'),
    'least_jerk': _controllers('least_jerk'),
}
"""Tables by their name in the pages."""
