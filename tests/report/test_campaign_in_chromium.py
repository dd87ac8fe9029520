# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The maps of a campaign's page in a real browser, on a narrow screen and on paper."""

from pathlib import Path

import pytest
from made_campaign import GRID, make_campaign
from report.headless_chromium import PRINT, Visitor, chromium

from ddct_bringup.campaign_report.folder import PAGE, write_campaign_page
from ddct_bringup.verdict.state import ENGAGED, INVALID

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(
        chromium() is None, reason='no Chromium on this machine (Debian: apt install chromium)'
    ),
]
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


def test_maps_name_failed_runs_describe_a_tapped_run_and_can_be_printed(
    campaign: Path, visit: Visitor
) -> None:
    overflow = 'document.documentElement.scrollWidth - innerWidth'
    scripts = [overflow, CELLS, UNPAINTED, WORDS, TAP, OTHER_QUANTITY, PRINT]
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
