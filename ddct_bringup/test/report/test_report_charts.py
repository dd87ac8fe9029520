# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Each chart of the report draws the signal in its title, with its sign and unit."""

import math
from typing import TYPE_CHECKING

import numpy as np
import pytest
from drawn_charts import drawn_charts, loaded_charts
from made_run import made_facts

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.documents.palette import LineLook, looks
from ddct_bringup.report.chart_marks import ChartRun
from ddct_bringup.report.charts import chart_signals_of, dashed_lines
from ddct_bringup.report.phase_lanes import LANES, OPACITY, phase_spans
from ddct_plant.models.driveline import PhaseEvent
from ddct_plant.signals.topics import SHIFT_TOPICS, all_signals

if TYPE_CHECKING:
    from bokeh.models.renderers import GlyphRenderer

pytestmark = pytest.mark.slow

STEPS = 20
RPM = 30.0 / math.pi
WIDTHS = {
    'joint_position': (4,),
    'joint_speed': (4,),
    'joint_effort': (4,),
    'slip_reference': (3,),
    'slip_reference_rate': (3,),
    'actuator_torque': (11,),
    'clutch_torque': (11,),
}
STICKING = (
    'clutch_phase',
    'friction_work',
    'phase_events',
    'holding_torque',
    'clutch_static_torque',
    'clutch_temperature',
)
OF_SHIFT = {signal.name for topic in SHIFT_TOPICS for signal in topic.signals}
FACTS = made_facts(
    controller='pi', control_start_s=0.06, score_window_s=(0.06, 0.18), duration_s=0.2
)


def random_run() -> Trajectory:
    """Return a run with a different number in every place."""
    random = np.random.default_rng(1)
    arrays = {
        signal.name: random.normal(0.0, 100.0, (STEPS + 1, *WIDTHS.get(signal.name, ())))
        for signal in all_signals()
        if signal.name not in ('status', 'engine_torque_request', *STICKING, *OF_SHIFT)
    }
    return Trajectory({**arrays, 'status': ((),) * (STEPS + 1)})


RUN = random_run()
SHOWN = {
    'w_m': (RUN.joint_speed[:, 0] * RPM, 'rpm'),
    'w_d': (RUN.slip_speed * RPM, 'rpm'),
    'C_f_request': (RUN.torque_request, 'N m'),
    'C_f_actuator': (RUN.actuator_torque[:, 0], 'N m'),
    'C_f_clutch': (RUN.clutch_torque[:, 0], 'N m'),
    'C_m': (RUN.engine_torque, 'N m'),
    'A_x': (RUN.vehicle_accel, 'm/s²'),
    'error': ((RUN.slip_reference[:, 0] - RUN.slip_speed) * RPM, 'rpm'),
    'w_sr': (RUN.joint_speed[:, 3] * RPM, 'rpm'),
    'w_d_sensed': ((RUN.sensed_slip_speed - RUN.slip_speed) * RPM, 'rpm'),
}
"""Values by chart, from the signals of docs/develop/graph.md."""


@pytest.fixture(scope='module')
def charts():
    """Return the charts by name, as the page loads them."""
    (look,) = looks(1)
    run = ChartRun(0, 'pi', look, RUN, FACTS, True, thesis_engagement_time_s=0.088)
    return loaded_charts([run])


def drawn(renderer: 'GlyphRenderer') -> tuple[np.ndarray, np.ndarray]:
    """Return x and y of a line or mark."""
    from bokeh.models import ColumnDataSource

    source, glyph = renderer.data_source, renderer.glyph
    assert isinstance(source, ColumnDataSource)
    # A name as it is drawn, an object with the name once it is loaded.
    names = (getattr(spec, 'field', spec) for spec in (glyph.x, glyph.y))
    x, y = (np.asarray(source.data[name]) for name in names)
    return x, y


def lines(chart) -> 'list[GlyphRenderer]':
    return [line for line in chart.renderers if line.glyph.__class__.__name__ == 'Line']


def test_every_signal_has_its_chart(charts):
    assert list(charts) == list(SHOWN) == [quantity.key for quantity in chart_signals_of(RUN)]


@pytest.mark.parametrize('key', SHOWN)
def test_a_chart_draws_its_signal_over_time(charts, key):
    values, unit = SHOWN[key]
    time, shown = drawn(lines(charts[key])[0])
    np.testing.assert_allclose(time, np.arange(STEPS + 1) / 100.0, rtol=1e-6)
    np.testing.assert_allclose(shown, values, rtol=1e-6)
    assert charts[key].yaxis[0].axis_label == unit
    (quantity,) = [each for each in chart_signals_of(RUN) if each.key == key]
    assert (quantity.unit, charts[key].xaxis[0].axis_label) == (unit, 'time, s')


def test_the_chart_of_speeds_has_that_of_the_primary_shaft_as_a_thin_line(charts):
    _, thin = lines(charts['w_m'])
    expected = (RUN.joint_speed[:, 0] - RUN.slip_speed) * RPM
    np.testing.assert_allclose(drawn(thin)[1], expected, rtol=1e-6)
    assert thin.name is None


def test_the_slip_chart_has_the_present_reference_and_the_thesis_s_zero(charts):
    _, reference = lines(charts['w_d'])
    np.testing.assert_allclose(drawn(reference)[1], RUN.slip_reference[:, 0] * RPM, rtol=1e-6)
    (mark,) = [each for each in charts['w_d'].renderers if each not in lines(charts['w_d'])]
    assert [list(each) for each in drawn(mark)] == [[pytest.approx(0.148)], [0.0]]


def test_the_engine_torque_has_the_demand_and_what_it_lacks_of_it_from_control_start_on(charts):
    _, demand = lines(charts['C_m'])
    np.testing.assert_allclose(drawn(demand)[1], RUN.torque_demand, rtol=1e-6)
    (area,) = [each for each in charts['C_m'].renderers if each not in lines(charts['C_m'])]
    bottom, top = (
        np.asarray(area.data_source.data[spec.field]) for spec in (area.glyph.y1, area.glyph.y2)
    )
    np.testing.assert_allclose(bottom, RUN.engine_torque, rtol=1e-6)
    start = round(100 * FACTS.control_start_s)
    withheld = np.maximum(RUN.torque_demand - RUN.engine_torque, 0.0)
    np.testing.assert_allclose(top - bottom, [0.0] * start + [*withheld[start:]], atol=1e-4)
    assert withheld[:start].any()
    assert withheld[start:].any()
    assert (area.name, area.tags[0]['area']) == (None, True)


def test_runs_of_one_demand_share_its_line_and_a_run_without_one_has_none():
    unknown = Trajectory({**RUN.signals, 'torque_demand': np.full(STEPS + 1, np.nan)})
    runs = [
        ChartRun(index, name, looks(3)[index], run, FACTS, True)
        for index, (name, run) in enumerate({'pi': RUN, 'ls8': RUN, 'log': unknown}.items())
    ]
    chart = drawn_charts(runs)['C_m']
    shared = [line for line in lines(chart) if line.name is None]
    assert [line.tags[0] for line in shared] == [{'runs': [0, 1]}]
    assert dashed_lines(runs) == ['reference', 'demand']
    assert dashed_lines(runs[2:]) == ['reference']


def test_marks_of_a_line_lie_on_it_and_follow_its_colour():
    look = LineLook('#009e73', (2, 2), 'star')
    chart = drawn_charts([ChartRun(1, 'mine', look, RUN, FACTS, shown=False)])['w_sr']
    (marks,) = [each for each in chart.renderers if each not in lines(chart)]
    np.testing.assert_allclose(drawn(marks)[1], RUN.joint_speed[:, 3] * RPM, rtol=1e-6)
    assert len(marks.view.filter.indices) > 5
    assert (marks.glyph.marker, marks.glyph.fill_color) == ('star', look.colour)
    assert (marks.visible, marks.tags) == (False, [{'runs': [1]}])


def sticking_run() -> Trajectory:
    """Return `RUN` with a clutch that closes at 0.02 s, locks, and releases."""
    random = np.random.default_rng(2)
    events: list[tuple[PhaseEvent, ...]] = [()] * (STEPS + 1)
    events[1] = (PhaseEvent(0.007, 'reverse'),)
    events[6] = (PhaseEvent(0.053, 'lock'),)
    kinds = {0.081: 'release', 0.084: 'lock', 0.088: 'release'}
    events[9] = tuple(PhaseEvent(time_s, kind) for time_s, kind in kinds.items())
    phase = np.ones(STEPS + 1)
    phase[:2] = 0.0
    phase[6:9] = 2.0
    more = {
        'clutch_phase': phase,
        'friction_work': random.uniform(0.0, 100.0, STEPS + 1),
        'phase_events': tuple(events),
        'holding_torque': np.zeros(STEPS + 1),
        'clutch_static_torque': random.normal(0.0, 100.0, (STEPS + 1, 11)),
        'clutch_temperature': random.uniform(20.0, 90.0, STEPS + 1),
    }
    return Trajectory({**RUN.signals, **more})


STICK_SLIP = sticking_run()


@pytest.fixture(scope='module')
def both():
    """Return the charts of a linear run together with one with a stick-slip clutch."""
    first, second = looks(2)
    runs = [
        ChartRun(0, 'linear', first, RUN, FACTS, True),
        ChartRun(1, 'sticks', second, STICK_SLIP, FACTS, True),
    ]
    return drawn_charts(runs)


def test_a_clutch_that_sticks_adds_its_charts_for_its_own_runs_only(both):
    first = [*SHOWN][:5]
    others = [*SHOWN][5:]
    clutch = ['friction_energy', 'temperature']
    assert [key for key in both if key not in clutch] == [
        *first,
        'C_f_transmitted',
        *others,
        LANES,
    ]
    assert set(clutch) < set(both)
    assert [len(lines(both[key])) for key in ('A_x', 'temperature')] == [2, 1]


def test_transmitted_torque_is_drawn_with_the_capacity_of_the_phase(both):
    transmitted, capacity = lines(both['C_f_transmitted'])
    np.testing.assert_allclose(drawn(transmitted)[1], RUN.joint_effort[:, 1], rtol=1e-6)
    expected = RUN.clutch_torque[:, 0].copy()
    expected[6:9] = STICK_SLIP.clutch_static_torque[6:9, 0]
    np.testing.assert_allclose(drawn(capacity)[1], expected, rtol=1e-6)


def test_friction_energy_adds_up_and_temperature_is_drawn(both):
    (energy,), (temperature,) = (lines(both[key]) for key in ('friction_energy', 'temperature'))
    work = STICK_SLIP.friction_work
    np.testing.assert_allclose(drawn(energy)[1], np.cumsum(work) / 1000.0, rtol=1e-6)
    np.testing.assert_allclose(drawn(temperature)[1], STICK_SLIP.clutch_temperature, rtol=1e-6)


def test_phases_change_at_the_instants_of_their_events():
    assert phase_spans(STICK_SLIP) == [
        (0.0, 0.02, 'open'),
        (0.02, 0.053, 'slipping'),
        (0.053, 0.081, 'locked'),
        (0.081, 0.084, 'slipping'),
        (0.084, 0.088, 'locked'),
        (0.088, 0.2, 'slipping'),
    ]


def test_each_phase_is_clearly_more_opaque_than_the_one_before_it():
    assert np.diff([OPACITY[phase] for phase in ('open', 'slipping', 'locked')]).min() >= 0.3


def test_each_phase_is_shaded_in_its_own_way_with_the_events_on_it(both):
    shade, locks, releases = both[LANES].renderers
    source = shade.data_source.data
    assert list(source['opacity']) == [OPACITY[phase] for phase in source['phase']]
    assert len(set(OPACITY.values())) == 3
    assert (locks.glyph.marker, releases.glyph.marker) == (
        'triangle',
        'inverted_triangle',
    )
    assert [list(drawn(mark)[0]) for mark in (locks, releases)] == [[0.053, 0.084], [0.081, 0.088]]
    marks = [each for each in both['w_d'].renderers if each not in lines(both['w_d'])]
    assert [list(drawn(mark)[0]) for mark in marks] == [[0.053, 0.084], [0.081, 0.088]]
