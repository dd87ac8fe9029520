# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The report's page in a real browser: no error, no request, and every switch works."""

import json
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest
from report.headless_chromium import PRINT, Visitor, chromium
from support.runs import plan, record

from ddct_bringup.bag.trajectory_bag import write_trajectory
from ddct_bringup.documents.palette import looks
from ddct_bringup.programs.report import main
from ddct_bringup.run.description import custom_data
from ddct_bringup.run.headless import run_headless

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(
        chromium() is None, reason='no Chromium on this machine (Debian: apt install chromium)'
    ),
]
TIME_CHARTS = 9
CHARTS = 11
"""Number of all charts: the front and two figures against each other besides."""
CONTROLLERS = ('pi', 'ls8', 'hinf1')
COUNT_PAINTED = """[...document.querySelectorAll('.chart')].map((place) => {
  const view = [...Bokeh.index].find((each) => each.el.parentElement === place);
  const {canvas: whole, ctx} = view.export('png', false);
  const pixels = ctx.getImageData(0, 0, whole.width, whole.height).data;
  const colours = new Set();
  for (let i = 0; i < pixels.length; i += 4) colours.add(pixels.slice(i, i + 4).join());
  return colours.size;
})"""
SHOWN_LINES = """Bokeh.documents[0].roots().flatMap((chart) => chart.renderers)
  .filter((line) => line.name && line.visible).length"""


OVERFLOW = 'document.documentElement.scrollWidth - innerWidth'
LINE_COLOUR = 'Bokeh.documents[0].roots()[0].renderers[0].glyph.line_color.value'
BODY_COLOUR = 'getComputedStyle(document.body).backgroundColor'
SWITCH_COLOURS = "document.getElementById('theme').click()"
PHONE_PX = 390
LONG_NAMES = ('my_first_predictive_controller', 'a_controller_whose_name_has_fifty_letters_or_so')
MOST_PAGES = 4
OUTSIDE = """[...document.querySelectorAll('body *')].filter((each) => {
  const box = each.getBoundingClientRect();
  return box.width && (box.right > 390.5 || box.left < -0.5) && !each.closest('.scroll');
}).map((each) => each.className || each.tagName)"""


POINT = """((name, share) => {
  const chart = Bokeh.documents[0].roots().find((each) => each.name === name);
  const {el, frame} = [...Bokeh.index].find((each) => each.model === chart);
  const line = chart.renderers.find((each) => each.name === 'ls8');
  const {t, [name]: values} = line.data_source.data;
  const sample = Math.round(share * t.length);
  el.scrollIntoView({block: 'center'});
  return new Promise((done) => setTimeout(() => {
    const {left, top} = el.getBoundingClientRect();
    const [clientX, clientY] = [left + frame.x_scale.compute(t[sample]),
      top + frame.y_scale.compute(values[sample]) - OFF];
    el.dispatchEvent(new PointerEvent('pointermove', {clientX, clientY, bubbles: true}));
    const tip = document.getElementById('tip');
    done([tip.hidden, tip.innerText, t[sample], values[sample]]);
  }, 100));
})('w_sr', 0.25)"""
POINTED = (
    POINT.replace('OFF', '0'),
    "dispatchEvent(new Event('scroll'))",
    "document.getElementById('tip').hidden",
    POINT.replace('OFF', '-150'),
)
HEIGHTS = """new Promise((done) => {
  const look = () => {
    const ends = Bokeh.documents[0].roots().map((chart) => chart.y_range.end);
    if (ends.every(Number.isFinite)) done(ends); else setTimeout(look, 10);
  };
  look();
})"""
SWITCHED = (
    *(HEIGHTS, SHOWN_LINES, "document.querySelector('.chip').click()", SHOWN_LINES),
    "document.getElementById('count').textContent",
    *("document.querySelector('[data-show=none]').click()", SHOWN_LINES),
    *("document.querySelector('[data-show=all]').click()", SHOWN_LINES, HEIGHTS),
)
ORDER = """[...document.querySelectorAll('.summary tbody th .run')].map((run) =>
  run.textContent.trim())"""
ENTER = """document.querySelectorAll('.summary .sort')[1].dispatchEvent(
  new KeyboardEvent('keydown', {key: 'Enter', bubbles: true, cancelable: true}))"""
SORTED = (
    *(ORDER, "document.querySelectorAll('.summary .sort')[1].click()", ORDER, ENTER, ORDER),
    "document.querySelectorAll('thead button').length",
)
POINTS = """(() => {
  const {below, left, renderers: [{data_source: {data}}]} =
    Bokeh.documents[0].roots().find((chart) => chart.name === 'pareto');
  return [['x', 'y', 'ring'].map((name) => [...data[name]]),
    [below[0].axis_label, left[0].axis_label]];
})()"""
CHOOSE = """['peak_jerk_m_s3', 'friction_work_j'].forEach((name, index) => {
  const select = document.querySelectorAll('.pareto-choice select')[index];
  select.value = name;
  select.dispatchEvent(new Event('change'));
})"""
COLOURS = (LINE_COLOUR, BODY_COLOUR)
Values = Mapping[str, list[Any]]
"""Values of scripts by what they are about."""


def values_by_subject(
    scripts: Mapping[str, Sequence[str]], visit: Visitor, page: Path, **screen: Any
) -> Values:
    """Return what scripts on several subjects give, in one visit without error or request."""
    every = [script for each in scripts.values() for script in each]
    visited = visit(page, **screen, scripts=every)
    assert visited.errors == []
    assert {request.partition(':')[0] for request in visited.requests} <= {'file', 'data', 'blob'}
    values = iter(visited.values)
    return {subject: [next(values) for _ in each] for subject, each in scripts.items()}


@pytest.fixture(scope='module')
def dark(page: Path, visit: Visitor) -> Values:
    """Return what one visit with a dark phone gives, for several tests."""
    scripts = {'painted': (COUNT_PAINTED, OVERFLOW), 'colours': COLOURS, 'pointed': POINTED}
    return values_by_subject(scripts, visit, page, width=PHONE_PX, scheme='dark')


@pytest.fixture(scope='module')
def light(page: Path, visit: Visitor) -> Values:
    """Return what one visit with a light screen gives; the colours are switched last."""
    scripts = {'switched': SWITCHED, 'sorted': SORTED, 'chosen': (POINTS, CHOOSE, POINTS)}
    scripts |= {'colours': (*COLOURS, SWITCH_COLOURS, SWITCH_COLOURS, *COLOURS)}
    return values_by_subject(scripts, visit, page)


@pytest.fixture(scope='module')
def five(demo: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a page with five runs, two of them of users' controllers with long names."""
    folder = tmp_path_factory.mktemp('five')
    run = plan('pi', 'headless', duration_s=3.0)
    trajectory = run_headless(run.settings, 'pi')
    for name in LONG_NAMES:
        custom = custom_data(run.settings, name, run.steps)
        write_trajectory(trajectory, folder / name, name, custom, {})
    out = folder / 'report.html'
    assert main([str(demo), str(folder), '--out', str(out)]) == 0
    return out


@pytest.fixture(scope='module')
def launch(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a page with a run that commands the engine, and one of the clutch alone."""
    folder = tmp_path_factory.mktemp('launch')
    for name in ('torque_estimator', 'ls8'):
        run = plan(name, 'headless', scenario='launch', duration_s=2.5)
        record(run, folder / name)
    out = folder / 'report.html'
    assert main([str(folder), '--out', str(out)]) == 0
    return out


@pytest.mark.nightly
@pytest.mark.parametrize(('width', 'scheme'), [(1920, 'dark'), (1280, 'light')])
def test_the_page_draws_every_chart_on_a_screen(
    page: Path, width: int, scheme: str, visit: Visitor
) -> None:
    scripts = {'painted': (COUNT_PAINTED, OVERFLOW)}
    found = values_by_subject(scripts, visit, page, width=width, scheme=scheme)
    require_drawn(*found['painted'])


def test_the_page_draws_every_chart_on_a_phone(dark: Values) -> None:
    require_drawn(*dark['painted'])


def require_drawn(painted: Sequence[int], wider: int) -> None:
    """Require all charts, by the numbers of their colours, and no page wider than the window."""
    assert len(painted) == CHARTS
    assert min(painted) > 20
    assert wider <= 0


def test_on_a_phone_only_tables_scroll_sideways(five: Path, visit: Visitor) -> None:
    page_px = 'document.scrollingElement.scrollWidth'
    open_all = "document.querySelectorAll('details').forEach((each) => { each.open = true; })"
    chips = """[...document.querySelectorAll('.chip')].map((chip) => {
      const {left, right} = chip.getBoundingClientRect();
      return left >= 0 && right <= 390 && chip.scrollWidth <= chip.clientWidth;
    })"""
    visited = visit(five, width=PHONE_PX, scripts=[page_px, OUTSIDE, chips, open_all, page_px])
    assert visited.values[0] <= PHONE_PX
    assert visited.values[1] == []
    assert visited.values[2] == [True] * 5
    assert visited.values[4] <= PHONE_PX
    assert visited.errors == []


AREAS = """Bokeh.documents[0].roots().find((chart) => chart.name === 'C_m').renderers
  .filter((item) => item.tags[0]?.area)"""


@pytest.mark.nightly
def test_a_yardstick_has_its_star_and_hollow_point_and_the_withheld_torque_its_shade(
    launch: Path, visit: Visitor
) -> None:
    stars = """[...document.querySelectorAll('.figures tbody tr')].map((row) => [
      row.querySelector('.run').textContent.trim(), row.querySelector('.star') !== null])"""
    hollow = """[...document.querySelectorAll('#floor-front .legend span')].slice(2).map((key) => [
      key.textContent, key.querySelector('path').getAttribute('fill') === 'none'])"""
    painted = f'{AREAS}.map((area) => area.glyph.fill_color.value)'
    withheld = f"""{AREAS}.map(({{data_source: {{data}}}}) =>
      Math.max(...data.with_withheld.map((top, tick) => top - data.C_m[tick])))"""
    page_px = 'document.scrollingElement.scrollWidth'
    scripts = [stars, hollow, painted, withheld, page_px, OUTSIDE]
    visited = visit(launch, width=PHONE_PX, scheme='dark', scripts=scripts)
    assert visited.errors == []
    expected = [['ls8', False], ['torque_estimator', True]]
    assert sorted(visited.values[0]) == sorted(visited.values[1]) == expected
    order = [name for name, _ in visited.values[0]]
    assert visited.values[2] == [look.colour for look in looks(2)]
    assert [most > 10.0 for most in visited.values[3]] == [n != 'ls8' for n in order]
    assert visited.values[4] <= PHONE_PX
    assert visited.values[5] == []


def test_a_print_of_five_runs_has_four_pages_at_most_with_the_definitions(
    five: Path, visit: Visitor
) -> None:
    listen = """addEventListener('beforeprint', () => {
      const shown = (each) => getComputedStyle(each).display !== 'none';
      window.onPaper = [document.querySelector('.paper-too').open,
        ...document.querySelectorAll('#definitions, #definitions dd')].map((each) =>
          each === true || (each !== false && shown(each)));
    })"""
    closed = "document.querySelector('.paper-too').open"
    visited = visit(five, scripts=[listen, PRINT, 'window.onPaper', closed])
    pages = re.findall(rb'/Type\s*/Page\b', visited.values[1])
    assert 2 <= len(pages) <= MOST_PAGES
    assert (
        b'595' in re.findall(rb'/MediaBox \[([^\]]*)', visited.values[1])[0]
        or b'594' in visited.values[1]
    )
    assert len(visited.values[2]) > 50
    assert all(visited.values[2])
    assert visited.values[3] is False


@pytest.mark.nightly
def test_the_pointer_shows_the_nearest_curve_on_a_screen(page: Path, visit: Visitor) -> None:
    require_pointed(*values_by_subject({'pointed': POINTED}, visit, page)['pointed'])


def test_the_pointer_shows_the_nearest_curve_with_value_and_unit(dark: Values) -> None:
    require_pointed(*dark['pointed'])


def require_pointed(near: list[Any], _: object, hidden: bool, far: list[Any]) -> None:
    """Require the tip at a curve, none once the page has scrolled, and none far from a curve."""
    away, text, time, value = near
    assert not away
    name, shown, when = text.split('\n')
    assert (name, when) == ('ls8', f'at {time:.2f} s')
    assert shown.startswith('w_sr = ')
    assert shown.endswith(' rpm')
    number = float(shown.split()[2].replace('−', '-'))
    assert number == pytest.approx(value, rel=1e-3)
    assert hidden is True
    assert far[0] is True


def test_a_run_is_switched_off_in_all_charts(light: Values) -> None:
    heights, every, _, fewer, count, _, none, _, again, heights_again = light['switched']
    assert (every, fewer, none, again) == (3 * TIME_CHARTS, 2 * TIME_CHARTS, 0, 3 * TIME_CHARTS)
    assert count == '2 of 3 runs shown'
    assert heights_again == heights


@pytest.mark.nightly
def test_the_time_axis_is_one_for_all_charts(page: Path, visit: Visitor) -> None:
    window = "document.querySelectorAll('[data-range]')[1].click()"
    whole = "document.querySelectorAll('[data-range]')[0].click()"
    ranges = f"""Bokeh.documents[0].roots().slice(0, {TIME_CHARTS}).map((chart) =>
      [chart.x_range.start, chart.x_range.end])"""
    visited = visit(page, scripts=[ranges, window, ranges, whole, ranges])
    assert visited.values[0] == visited.values[4] == [[0.0, 3.0]] * TIME_CHARTS
    assert visited.values[2] == [[0.6, 1.7]] * TIME_CHARTS


def test_the_switch_and_the_system_choose_the_colours(dark: Values, light: Values) -> None:
    assert dark['colours'] != light['colours'][:2]
    assert light['colours'][4:] == dark['colours']


def test_a_table_sorts_by_a_pressed_heading(light: Values) -> None:
    first, _, pressed, _, entered, lost_on_paper = light['sorted']
    assert first == ['pi', 'ls8', 'hinf1']
    assert pressed == ['ls8', 'hinf1', 'pi']
    assert entered == ['pi', 'hinf1', 'ls8']
    assert lost_on_paper == 0


def test_the_two_figures_of_the_pareto_view_are_chosen(light: Values) -> None:
    ((across, up, rings), titles), _, (after, titles_after) = light['chosen']
    assert titles_after == titles[::-1]
    assert len(across) == 3
    assert any(rings)
    assert after == [up, across, rings]


@pytest.mark.nightly
def test_paper_gets_light_charts_even_from_a_dark_page(page: Path, visit: Visitor) -> None:
    listen = """addEventListener('beforeprint', () => {
      const lines = window.light.map((colour) => parseInt(colour.slice(1), 16));
      window.onPaper = [...document.querySelectorAll('.paper canvas')].map((canvas) => {
        const all = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
        const inked = all.filter((value, index) => index % 4 === 3 && value > 128).length;
        const found = new Set();
        for (let i = 0; i < all.length; i += 4) {
          found.add(all[i] * 65536 + all[i + 1] * 256 + all[i + 2]);
        }
        return [inked, lines.every((colour) => found.has(colour))];
      });
    })"""
    lines = [look.colour for look in looks(len(CONTROLLERS))]
    light = f'window.light = {json.dumps(lines)}'
    after = """[document.querySelectorAll('.paper canvas').length,
      document.documentElement.dataset.theme ?? 'auto']"""
    visited = visit(page, scheme='dark', scripts=[light, listen, PRINT, 'window.onPaper', after])
    printed, charts, after_print = visited.values[2:]
    assert printed.startswith(b'%PDF')
    assert len(charts) == CHARTS
    assert min(inked for inked, _ in charts) > 1000
    assert [light for _, light in charts][:4] == [True] * 4
    assert after_print == [0, 'auto']
    assert visited.errors == []
