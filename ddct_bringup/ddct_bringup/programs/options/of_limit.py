# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Options of `limit`, and the values of those that are lists: caps and lock times."""

import argparse
from collections.abc import Sequence

from ddct_bringup.floor.metric_units import METRICS
from ddct_bringup.programs.options.of_runs import add_settings_options, add_workers_option
from ddct_plant.base.errors import DdctError, ParameterError, require_number
from ddct_plant.program.command_line import ProgramParser

_HOW_TIMES = 'write START:STOP:COUNT, such as 0.4:1.4:11, or A,B,C, in s'
_MOST_TIMES = 1000
_EPILOG = """examples:
  ddct limit --scenario launch --metrics peak_jerk --controllers ls8,hinf1
  ddct limit --scenario launch --lock-times 0.6:1.4:9 --figure front.png
  ddct limit --scenario upshift --handover model --metrics peak_jerk
  ddct limit --cap peak_jerk=6 --metrics peak_jerk --scenario launch --json -

For each lock time: the least value of a metric that any torque request can lead to, with the
proof checked, and the value that a run of the simulated plant attains. docs/use/limit.md says
what a floor is. A lock time that no request leads to is on standard error, with its proof.
Floors are kept in the folder DDCT_CACHE, by default ~/.cache/ddct; DDCT_CACHE= keeps none.
"""


def limit_parser(program: str) -> argparse.ArgumentParser:
    """Return the parser of the program with this name."""
    parser = ProgramParser(
        prog=program,
        description='Compute the least that any controller of the clutch could do.',
        epilog=_EPILOG,
    )
    parser.add_argument(
        '--controllers',
        default='',
        metavar='A,B,...|all',
        help='also compare these with the least at their own lock time; default: none',
    )
    parser.add_argument(
        '--metrics',
        default='',
        metavar='A,B,...',
        help=f'metrics, named as in verdicts and scores; default: all, {", ".join(METRICS)}',
    )
    parser.add_argument(
        '--lock-times',
        metavar='START:STOP:COUNT',
        help='times of the lock in s after control start, in a gear shift after the start of the '
        'inertia phase, also A,B,C; default: 15 up to the end of the score window',
    )
    parser.add_argument(
        '--cap',
        action='append',
        default=[],
        metavar='METRIC=VALUE',
        help='also find the least lock time at which a metric is at most this; may be repeated',
    )
    parser.add_argument('--json', metavar='FILE', help="also write it as JSON; '-' is stdout")
    parser.add_argument(
        '--figure', metavar='FILE', help='also draw it: a .png, .svg or .html file'
    )
    add_workers_option(parser)
    add_settings_options(parser)
    return parser


def cap_of(text: str, metrics: Sequence[str]) -> tuple[str, float]:
    """Return metric and value of a cap METRIC=VALUE; raise ParameterError for another text."""
    metric, _, value = text.partition('=')
    if metric not in metrics:
        raise ParameterError(f'--cap {text}: write METRIC=VALUE with a metric of --metrics')
    return metric, _number('--cap', value, 'write METRIC=VALUE')


def lock_times_of(text: str) -> list[float]:
    """
    Return the lock times of START:STOP:COUNT or A,B,C in s.

    Raise ParameterError for another text, and unless the times rise.
    """
    parts = text.split(':')
    if len(parts) == 1:
        times = [_number('--lock-times', part, _HOW_TIMES) for part in text.split(',')]
    elif len(parts) == 3 and parts[2].isdigit() and 2 <= int(parts[2]) <= _MOST_TIMES:
        first, last = (_number('--lock-times', part, _HOW_TIMES) for part in parts[:2])
        count = int(parts[2])
        times = [round(first + (last - first) * i / (count - 1), 6) for i in range(count)]
    else:
        raise ParameterError(f'--lock-times {text}: {_HOW_TIMES}')
    if sorted(set(times)) != times:
        raise ParameterError(f'--lock-times {text}: give rising times')
    return times


def _number(option: str, text: str, how: str) -> float:
    try:
        return require_number(option, float(text), at_least=0.0)
    except (ValueError, DdctError) as error:
        raise ParameterError(f'{option} {text}: {how}') from error
