# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of every program fit 80 columns, 120 in a file, and each of their dashes has a reason."""

import io
import re
import sys
from collections.abc import Callable, Sequence
from functools import cache

import pytest
from made_results import made_results
from shown_tables import require_reasons, require_whole_lines

from ddct_bringup.campaign_report.document import campaign_document
from ddct_bringup.documents.terminal import print_document
from ddct_bringup.evaluation.summarise import summary_of
from ddct_bringup.identification import identify
from ddct_bringup.programs import benchmark, limit, sweep, thesis
from ddct_controllers.check import program as check_controller
from ddct_controllers.workflows import design_program

SHORT = ('--set', 'duration_s=1.2', '--set', 'score_window_s=[0.6, 1.1]')


def _campaign() -> None:
    states = ['engaged', 'not_engaged'] * 4
    results = made_results(
        states,
        {'wear_gain': [0.8, 0.8, 1.0, 1.0] * 2, 'vehicle.mass_kg': [1400.0] * 4 + [1800.0] * 4},
        {'peak_jerk_m_s3': [float(number) for number in range(8)]},
        controllers=['pi', 'ls8'] * 4,
    )
    print_document(campaign_document(summary_of(results), 'again INDEX'))


def _sweep() -> None:
    over = ('--over', 'wear_gain=0.5,1', '--over', 'load.slope_rad=0,0.1')
    metrics = 'engagement_time_s,slip_final_rpm,torque_late_s,peak_jerk_m_s3,friction_work_j'
    sweep.main([*over, '--controllers', 'pi', '--metrics', metrics])


PROGRAMS: dict[str, Callable[[], object]] = {
    'benchmark --packaged': lambda: benchmark.main(['--packaged']),
    'campaign': _campaign,
    'check': lambda: check_controller.main(['pi']),
    'design loop-shaping': lambda: design_program.main(['loop-shaping']),
    'design margins': lambda: design_program.main(['margins', '--controllers', 'ls8']),
    'design plant': lambda: design_program.main(['plant']),
    'identify': lambda: identify.main([]),
    'identify --as-printed': lambda: identify.main(['--as-printed']),
    'limit': lambda: limit.main(
        ['--scenario', 'launch', '--lock-times', '1.0']
        + ['--metrics', 'friction_energy', '--controllers', 'pi']
    ),
    'thesis numbers': lambda: thesis.main(['numbers']),
    'thesis studies': lambda: thesis.main(['studies', '--study', 'torsion_weight']),
    'sweep': _sweep,
    'sweep --list': lambda: sweep.main(['--list']),
}

LONG = ('benchmark --packaged', 'thesis numbers')
"""
Programs that take a second: nightly here.

What they print into a file is checked by tests that have computed it: test_release_rows.py and
test_thesis_gate.py.
"""
EACH = [pytest.param(name, marks=[pytest.mark.nightly] * (name in LONG)) for name in PROGRAMS]


@cache
def _shown(name: str, *, is_terminal: bool) -> Sequence[str]:
    """Return the lines that a program prints on a terminal or into a file."""
    stream = io.StringIO()
    stream.isatty = lambda: is_terminal  # type: ignore[method-assign]
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv('COLUMNS', '80')
        patch.setattr(sys, 'stdout', stream)
        PROGRAMS[name]()
    return re.sub(r'\x1b\[[0-9;]*m', '', stream.getvalue()).splitlines()


@pytest.mark.process
@pytest.mark.parametrize(('is_terminal', 'width'), [(False, 120), (True, 80)])
@pytest.mark.parametrize('name', EACH)
def test_no_line_is_too_wide_and_no_cell_is_cut(name: str, width: int, is_terminal: bool) -> None:
    require_whole_lines(_shown(name, is_terminal=is_terminal), width)


def test_a_campaign_names_the_option_that_has_all_columns() -> None:
    lines = ' '.join(' '.join(_shown('campaign', is_terminal=True)).split())
    assert '; all with campaign show --json FILE' in lines


@pytest.mark.process
@pytest.mark.parametrize('name', EACH)
def test_each_dash_has_a_reason_below_its_table(name: str) -> None:
    require_reasons(_shown(name, is_terminal=False))
