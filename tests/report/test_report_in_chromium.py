"""The report's page in a real browser: no error, no request, and every switch does its work."""

import json
from pathlib import Path

import pytest
from headless_chromium import PRINT, chromium, visit

from ddct_controllers.design.drawing.line_looks import controller_look

pytestmark = pytest.mark.browser

pytestmark = pytest.mark.skipif(
    chromium() is None, reason='no Chromium on this machine (Debian: apt install chromium)'
)
CHARTS = 8
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


@pytest.mark.parametrize(('width', 'scheme'), [(390, 'dark'), (1280, 'light'), (1920, 'dark')])
def test_the_page_draws_every_chart_without_error_or_request(
    page: Path, width: int, scheme: str
) -> None:
    overflow = 'document.documentElement.scrollWidth - innerWidth'
    seen = visit(page, width=width, scheme=scheme, scripts=[COUNT_PAINTED, overflow])
    assert seen.errors == []
    assert {request.partition(':')[0] for request in seen.requests} <= {'file', 'data', 'blob'}
    painted, wider = seen.values
    assert len(painted) == CHARTS
    assert min(painted) > 20
    assert wider <= 0


def test_a_run_is_switched_off_in_all_charts(page: Path) -> None:
    click = "document.querySelector('.chip').click()"
    count = "document.getElementById('count').textContent"
    heights = """new Promise((done) => {
      const look = () => {
        const ends = Bokeh.documents[0].roots().map((chart) => chart.y_range.end);
        if (ends.every(Number.isFinite)) done(ends); else setTimeout(look, 10);
      };
      look();
    })"""
    none = "document.querySelector('[data-show=none]').click()"
    everything = "document.querySelector('[data-show=all]').click()"
    scripts = [heights, SHOWN_LINES, click, SHOWN_LINES, count, none, SHOWN_LINES]
    scripts += [everything, SHOWN_LINES, heights]
    seen = visit(page, scripts=scripts)
    assert (seen.values[1], seen.values[3], seen.values[6]) == (3 * CHARTS, 2 * CHARTS, 0)
    assert seen.values[4] == '2 of 3 runs shown'
    assert seen.values[8] == 3 * CHARTS
    assert seen.values[9] == seen.values[0]
    assert seen.errors == []


def test_the_time_axis_is_one_for_all_charts(page: Path) -> None:
    window = "document.querySelectorAll('[data-range]')[1].click()"
    whole = "document.querySelectorAll('[data-range]')[0].click()"
    ranges = """Bokeh.documents[0].roots().map((chart) =>
      [chart.x_range.start, chart.x_range.end])"""
    seen = visit(page, scripts=[ranges, window, ranges, whole, ranges])
    assert seen.values[0] == seen.values[4] == [[0.0, 3.0]] * CHARTS
    assert seen.values[2] == [[0.6, 1.7]] * CHARTS


def test_the_switch_and_the_system_choose_the_colours(page: Path) -> None:
    line = 'Bokeh.documents[0].roots()[0].renderers[0].glyph.line_color.value'
    body = 'getComputedStyle(document.body).backgroundColor'
    click = "document.getElementById('theme').click()"
    dark = visit(page, scheme='dark', scripts=[line, body])
    light = visit(page, scheme='light', scripts=[line, body, click, click, line, body])
    assert dark.values != light.values[:2]
    assert light.values[4:] == dark.values
    assert light.errors == []


def test_a_table_sorts_by_a_pressed_heading(page: Path) -> None:
    press = "document.querySelectorAll('.summary .sort')[1].click()"
    order = """[...document.querySelectorAll('.summary tbody th .run')].map((run) =>
      run.textContent.trim())"""
    seen = visit(page, scripts=[order, press, order, press, order])
    assert seen.values[0] == ['pi', 'ls8', 'hinf1']
    assert seen.values[2] == ['ls8', 'hinf1', 'pi']
    assert seen.values[4] == ['pi', 'hinf1', 'ls8']


def test_the_two_criteria_of_the_pareto_view_are_chosen(page: Path) -> None:
    points = """[...document.querySelectorAll('.pareto .point')].map((point) => [
      point.style.left, point.style.bottom, point.classList.contains('best'), point.title])"""
    titles = "[...document.querySelectorAll('.pareto .title')].map((each) => each.textContent)"
    choose = """['peak_jerk', 'friction_energy'].forEach((name, index) => {
      const select = document.querySelectorAll('.pareto-choice select')[index];
      select.value = name;
      select.dispatchEvent(new Event('change'));
    })"""
    seen = visit(page, scripts=[points, titles, choose, points, titles])
    before, titles_before, _, after, titles_after = seen.values
    assert titles_after == titles_before[::-1]
    assert len(before) == 3
    assert any(best for *_, best, _ in before)
    for (left, bottom, best, title), turned in zip(before, after, strict=True):
        assert [round(float(each[:-1]), 2) for each in turned[:2]] == [
            float(bottom[:-1]),
            float(left[:-1]),
        ]
        assert turned[2:] == [best, ', '.join(reversed(title.split(', ')))]
    assert seen.errors == []


def test_labels_of_the_pareto_view_cover_neither_each_other_nor_a_dot(page: Path) -> None:
    crowd = """const {style} = document.querySelector('.field');
      Object.assign(style, {width: '1rem', height: '1rem'});
      document.querySelector('.pareto-choice select').dispatchEvent(new Event('change'))"""
    plain = """document.querySelectorAll('.point b').forEach((label) => {
      label.style.translate = ''; })"""
    covered = """(() => {
      const box = (each) => each.getBoundingClientRect();
      const labels = [...document.querySelectorAll('.point b')].map(box);
      const all = [...labels, ...[...document.querySelectorAll('.point .dot')].map(box)];
      return labels.flatMap((one, index) => all.filter((other, at) => at !== index
        && one.left < other.right && one.right > other.left
        && one.top < other.bottom - 0.1 && one.bottom > other.top + 0.1)).length;
    })()"""
    seen = visit(page, scripts=[covered, crowd, covered, plain, covered])
    assert [seen.values[0], seen.values[2]] == [0, 0]
    assert seen.values[4] > 0
    assert seen.errors == []


def test_paper_gets_light_charts_even_from_a_dark_page(page: Path) -> None:
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
    lines = [controller_look(name).light for name in CONTROLLERS]
    light = f'window.light = {json.dumps(lines)}'
    after = """[document.querySelectorAll('.paper canvas').length,
      document.documentElement.dataset.theme ?? 'auto']"""
    seen = visit(page, scheme='dark', scripts=[light, listen, PRINT, 'window.onPaper', after])
    printed, charts, after_print = seen.values[2:]
    assert printed.startswith(b'%PDF')
    assert len(charts) == CHARTS
    assert min(inked for inked, _ in charts) > 1000
    assert [light for _, light in charts][:4] == [True] * 4
    assert after_print == [0, 'auto']
    assert seen.errors == []
