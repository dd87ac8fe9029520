# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Definitions of the terms, symbols, signs and dashes of the page."""

from collections.abc import Sequence
from dataclasses import dataclass

from ddct_bringup.documents.page_parts import unit_text
from ddct_bringup.metrics.catalogue import FIGURES
from ddct_bringup.metrics.metric import Metric
from ddct_bringup.report.chart_signals import ChartSignal
from ddct_bringup.scores.scored_run import YARDSTICK
from ddct_controllers.design.analysis.loop_quantities import LOOP_QUANTITIES
from ddct_plant.program.table import Quantity


@dataclass(frozen=True)
class Definition:
    """One definition; a reader finds it by the text of the table or chart."""

    term: str
    meaning: str
    unit: str = ''
    """Unit as printed, empty for a term or a pure number."""


_READING = (
    Definition(
        '–',
        'no value, because it is not defined for this run. The entries below say when that is so.',
    ),
    Definition(
        '+ and −',
        'a speed, torque or error has a sign, given with its symbol below. Of a percentage beside '
        'the thesis: + is larger than printed.',
    ),
    Definition(
        'σ',
        'standard deviation over the score window, in the unit of its quantity. Less is smoother.',
    ),
    Definition(
        'w_d below zero',
        'The linear clutch never locks. It transmits what the actuator gives, so w_d may pass '
        'zero at t_a and end below it: the engine is then slower than the shaft. A clutch that '
        'sticks locks at zero and stays there.',
    ),
    Definition('score window', 'the span of time that σ is taken over.', 's'),
    Definition(
        'control start',
        'when feedback is switched on. Before it the open loop acts. Figures count from there to '
        'the end of the run.',
    ),
    Definition('C_dem', 'torque that the driver demands of the engine.', 'N m'),
    Definition('*', f'{YARDSTICK}. The least is of a run of the clutch alone that locks once.'),
    Definition('▲', 'the value is beyond its limit.'),
)
_THESIS = (
    Definition(
        'calibrated, predicted',
        'whether the scenario was fitted to this row of Table 5.1 of the thesis, or the row took '
        'no part in the fit.',
    ),
)
_STATES = (
    Definition(
        'engaged',
        'the only success: plates that stick are locked at the end, or the slip of a linear '
        'clutch stays near zero, and none of the others holds.',
    ),
    Definition('late', 'the plates are locked at the end, but not for long enough.'),
    Definition(
        'withheld, added',
        "a controller that commands the engine takes too much of the driver's torque away, or "
        'adds too much.',
    ),
    Definition('not engaged', 'the plates slip at the end.'),
    Definition('stalled, over revved', 'the engine reached this limit, which ended the run.'),
    Definition(
        'tied up, flared',
        'a gear shift whose clutches worked against each other, or whose engine ran up.',
    ),
    Definition('invalid', 'the run does not count. Its reason stands at the top of the page.'),
)
_LIMIT = Definition(
    'limit', 'a largest magnitude, published or a convention. It does not change the state.'
)

_SHIFT = (
    Definition('on-coming, off-going', 'clutch of the gear after the shift, and of that before.'),
    Definition(
        'control start',
        'in a gear shift its start. Feedback starts at the share 1; t_a counts from there.',
    ),
)

_LOOPS = (
    Definition('wear', 'K_usura, the factor of wear on the clutch torque. 1 is as designed.'),
    Definition('stable', 'whether the sampled closed loop is stable at the wear of the run.'),
    Definition('stable wear', 'the wear gains between which the loop is stable.'),
    Definition(
        'corner M_s',
        'highest M_s with the driveline parameters at ±20 % and wear from 0.7 to 1.3. A dash: '
        'one of those loops is unstable.',
    ),
    Definition('unstable corners', 'how many of those corners have an unstable loop.'),
)
_TIMES = (
    Definition('median, 99 %, longest', 'wall time of the updates of the controller.', 'µs'),
    Definition('over 10 ms', 'updates that took longer than the period.'),
    Definition('missed', 'steps in real time that went on without a reply and held the torque.'),
    Definition('latest', 'how much too late a step was taken at most. Lock-step has none.', 'µs'),
    Definition('resends, late', 'ticks that were sent again; replies to a tick that was over.'),
    Definition('run', 'wall time from the first tick to the last.', 's'),
)
_ORIGIN = (
    Definition('lockstep, realtime', 'each step waits for all replies; or it follows the clock.'),
    Definition('measured', 'a log of a car, of which no scenario is known.'),
)


@dataclass(frozen=True)
class ShownParts:
    """What a page shows, so that it defines no more."""

    signals: Sequence[ChartSignal]
    metrics: Sequence[Metric]
    """Metrics of the tables."""
    states: frozenset[str]
    """States of the runs, as written on the page."""
    modes: frozenset[str]
    """Modes of the runs, as written on the page."""
    thesis: bool = False
    """Whether runs are compared with Table 5.1."""
    shift: bool = False
    """Whether they are gear shifts."""
    limits: bool = False
    """Whether a limit is shown."""
    beyond: bool = False
    """Whether a value is beyond its limit."""
    yardstick: bool = False
    """Whether a ratio has a star."""
    loops: bool = False
    """Whether margins are shown."""
    times: bool = False
    """Whether update times are shown."""


def definitions(shown: ShownParts) -> dict[str, tuple[Definition, ...]]:
    """Return the definitions of what a page shows, by subject; a subject has at least one."""
    figures = [each for each in shown.metrics if each in FIGURES and not each.of_shift]
    others = [each for each in shown.metrics if each not in FIGURES and not each.of_shift]
    of_shift = [each for each in shown.metrics if each.of_shift]
    groups = {
        'Reading the tables': _reading(shown),
        'Signals': [
            Definition(each.symbol, f'{each.title}: {each.meaning}', each.unit)
            for each in shown.signals
        ],
        'Figures': [_defined(each) for each in figures],
        'Metrics': [_defined(each) for each in others],
        'Gear shift': [*_SHIFT, *map(_defined, of_shift)] if shown.shift else [],
        'States and limits': _states(shown),
        'Margins': [*_LOOPS, *map(_defined, LOOP_QUANTITIES)] if shown.loops else [],
        'Update times': _TIMES if shown.times else [],
        'Origin': [each for each in _ORIGIN if shown.modes & _names(each)],
    }
    return {subject: tuple(entries) for subject, entries in groups.items() if entries}


def _names(entry: Definition) -> set[str]:
    """Return the names that one entry defines."""
    return set(entry.term.split(', '))


def _reading(shown: ShownParts) -> list[Definition]:
    symbols = {each.symbol for each in shown.metrics} | {each.symbol for each in shown.signals}
    terms = {
        'σ': any(symbol.startswith('std ') for symbol in symbols),
        'w_d below zero': 't_a' in symbols,
        'C_dem': 'C_m' in symbols,
        '*': shown.yardstick,
        '▲': shown.beyond,
    }
    entries = [each for each in _READING if terms.get(each.term, True)]
    return [*entries, *(_THESIS if shown.thesis else ())]


def _states(shown: ShownParts) -> list[Definition]:
    """Return the states that occur, and what a limit is where one is shown."""
    entries = [each for each in _STATES if shown.states & _names(each)]
    return [*entries, _LIMIT] if shown.limits else entries


def _defined(quantity: Quantity) -> Definition:
    meaning = quantity.meaning.removeprefix(f'{quantity.symbol}, ')
    missing = f' No value: {quantity.undefined}.' if quantity.undefined else ''
    return Definition(quantity.symbol, f'{meaning}.{missing}', unit_text(quantity.unit))
