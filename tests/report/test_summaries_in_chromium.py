# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The pages of a campaign and of a benchmark in one real browser, narrow, wide and on paper."""

from pathlib import Path

import pytest
from made_campaign import GRID, make_campaign
from report.headless_chromium import PRINT, Visitor, chromium

from ddct_bringup.benchmark.cases import Cases, packaged_folder
from ddct_bringup.benchmark.conduct import JudgedRows
from ddct_bringup.benchmark.judged import Judged
from ddct_bringup.benchmark.plan import BenchmarkPlan, RecordedBenchmark
from ddct_bringup.benchmark.release import release_rows
from ddct_bringup.benchmark.report.document import benchmark_document
from ddct_bringup.benchmark.result import result_of
from ddct_bringup.benchmark.update_times import UpdateTime, UpdateTimesFile
from ddct_bringup.campaign_report.folder import PAGE, write_campaign_page
from ddct_bringup.documents.page import html_page
from ddct_bringup.manifest.inputs import InputFiles
from ddct_bringup.manifest.origin import CodeOrigin
from ddct_bringup.verdict.state import ENGAGED, INVALID

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(
        chromium() is None, reason='no Chromium on this machine (Debian: apt install chromium)'
    ),
]
WIDER = 'document.documentElement.scrollWidth - innerWidth'
SORT = """(() => {
  const body = document.querySelector('#board tbody');
  const before = body.rows[0].textContent;
  document.querySelectorAll('#board .sort')[2].click();
  return before !== body.rows[0].textContent;
})()"""
TIMES = UpdateTime(1.5, 1.4, 1.6, 6.0, 4.0)
SHAPES = """Bokeh.documents[0].roots().flatMap((chart) => chart.renderers)
  .filter((each) => each.name === 'cells').map((each) => each.data_source)"""
CELLS = f'{SHAPES}.reduce((sum, {{data}}) => sum + data.x.length, 0)'
UNPAINTED = f"""(() => {{
  const ramp = new Set(JSON.parse(document.getElementById('maps-data').textContent).ramp);
  return {SHAPES}.flatMap(({{data}}) => data.colour.filter(
    (colour, place) => !ramp.has(colour) && data.hatch[place] === ' ')).length;
}})()"""
WORDS = """Bokeh.documents[0].roots().flatMap((chart) => chart.renderers)
  .filter((each) => each.name === 'words').flatMap((each) => [...each.data_source.data.word])
  .filter((word) => !/^[0-9]/.test(word))"""
TAP = f"""(() => {{
  {SHAPES}[0].selected.indices = [0];
  return document.querySelector('.detail').textContent;
}})()"""
OTHER_QUANTITY = """(() => {
  const choice = document.getElementById('quantity');
  const before = document.getElementById('high').textContent;
  choice.value = 1;
  choice.dispatchEvent(new Event('change'));
  return [before, document.getElementById('high').textContent];
})()"""


@pytest.fixture(scope='module')
def campaign(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder in which a worn clutch stalls the engine, and one run is invalid."""

    def state(run):
        worn = run.varied['wear_gain'] == 0.8
        return INVALID if run.index == 11 else 'stalled' if worn else ENGAGED

    made = make_campaign(tmp_path_factory.mktemp('campaigns') / 'wear', GRID, state)
    write_campaign_page(made)
    return made


def test_maps_of_a_campaign_name_failed_runs_describe_a_tapped_run_and_can_be_printed(
    campaign: Path, visit: Visitor
) -> None:
    scripts = [WIDER, CELLS, UNPAINTED, WORDS, TAP, OTHER_QUANTITY, PRINT]
    seen = visit(campaign / PAGE, width=390, scheme='dark', scripts=scripts)
    assert seen.errors == []
    assert {request.partition(':')[0] for request in seen.requests} <= {'file', 'data'}
    wider, drawn, unpainted, words, told, (before, after), paper = seen.values
    assert wider <= 0
    assert (drawn, unpainted) == (12, 0)
    assert sorted(words) == ['invalid', *['stalled'] * 4]
    assert 'pi, wear_gain 0.8, vehicle.mass_kg 1300: stalled' in told
    assert 'ddct campaign replay . --index 0 --out ../replay-0' in told
    assert (before, after) == ('30', '10')
    assert paper.startswith(b'%PDF')


@pytest.fixture(scope='module')
def benchmark(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the page of a packaged controller whose held-out cases are those of development."""
    cases = Cases.packaged(quick=True)
    release = release_rows(packaged_folder()).of(cases)
    plan = BenchmarkPlan.of([Judged.of('ls8')], cases, 3, InputFiles())
    rows = release.rows.only(['ls8', 'pi', 'hinf_sampled', 'mpc_wear'])
    judged = {'ls8': JudgedRows(None, rows)}
    out = tmp_path_factory.mktemp('benchmark')
    recorded = RecordedBenchmark(plan, CodeOrigin.here(), out)
    result = result_of(recorded, release, judged, {})
    file = out / 'report.html'
    document = benchmark_document(result, UpdateTimesFile('pi', {'ls8': TIMES}))
    file.write_text(html_page(document), encoding='utf-8')
    return file


@pytest.mark.parametrize(('width', 'scheme'), [(390, 'dark'), (1280, 'light')])
def test_the_page_of_a_benchmark_needs_no_network_sorts_and_is_no_wider_than_the_window(
    benchmark: Path, width: int, scheme: str, visit: Visitor
) -> None:
    found = visit(benchmark, width=width, scheme=scheme, scripts=[WIDER, SORT])
    assert found.errors == []
    assert {request.partition(':')[0] for request in found.requests} <= {'file', 'data'}
    assert found.values[0] <= 0
    assert found.values[1]
