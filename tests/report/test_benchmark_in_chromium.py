# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The page of a benchmark in a real browser, on a narrow screen and on a wide one."""

from pathlib import Path

import pytest
from report.headless_chromium import Visitor, chromium

from ddct_bringup.benchmark.cases import Cases, packaged_folder
from ddct_bringup.benchmark.conduct import JudgedRows
from ddct_bringup.benchmark.judged import Judged
from ddct_bringup.benchmark.plan import BenchmarkPlan, RecordedBenchmark
from ddct_bringup.benchmark.release import release_rows
from ddct_bringup.benchmark.report.document import benchmark_document
from ddct_bringup.benchmark.result import result_of
from ddct_bringup.benchmark.update_times import UpdateTime, UpdateTimesFile
from ddct_bringup.documents.page import html_page
from ddct_bringup.manifest.inputs import InputFiles
from ddct_bringup.manifest.origin import CodeOrigin

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


@pytest.fixture(scope='module')
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
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
def test_the_page_needs_no_network_sorts_and_is_no_wider_than_the_window(
    page: Path, width: int, scheme: str, visit: Visitor
) -> None:
    found = visit(page, width=width, scheme=scheme, scripts=[WIDER, SORT])
    assert found.errors == []
    assert {request.partition(':')[0] for request in found.requests} <= {'file', 'data'}
    assert found.values[0] <= 0
    assert found.values[1]
