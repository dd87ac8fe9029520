# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The page of a campaign: the numbers of `summary.json`, every failed run, and text as text."""

import json
import re
from html.parser import HTMLParser
from pathlib import Path

import pytest
from made_campaign import GRID, leave_out_figure, make_campaign
from made_results import made_results
from samples import sampled

from ddct_bringup.api.shell import campaigns
from ddct_bringup.campaign.conduct import RESULTS
from ddct_bringup.campaign.rows import METRIC_COLUMNS
from ddct_bringup.campaign_report.document import PageParts, campaign_document
from ddct_bringup.campaign_report.folder import (
    PAGE,
    SUMMARY,
    write_campaign_page,
)
from ddct_bringup.documents.bokeh_charts import library
from ddct_bringup.documents.page import html_page
from ddct_bringup.evaluation.summarise import summary_of
from ddct_bringup.evaluation.summary import SummaryFile
from ddct_bringup.programs.campaign import main
from ddct_bringup.verdict.state import ENGAGED, INVALID
from ddct_plant.files.json_records import json_text, read_json

pytestmark = pytest.mark.slow

EVIL = '</script></style>--><evil onload="x"> \'"&amp;'
"""Text that closes every open element and opens one that no page has."""


class Elements(HTMLParser):
    """Collects the elements, the numbers of `data`, the text, and the JSON for the scripts."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.names: set[str] = set()
        self.numbers: list[float] = []
        self.text = ''
        self.scripts: list[str] = []
        self._in = ''
        self.feed(html)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self._in = tag
        self.names |= {tag, *(name for name, _ in attrs)}
        if tag == 'data':
            self.numbers.append(float(dict(attrs)['value'] or ''))

    def handle_endtag(self, tag: str) -> None:
        self._in = ''

    def handle_data(self, data: str) -> None:
        if self._in == 'script':
            self.scripts.append(data)
        elif self._in != 'style':
            self.text += data


@pytest.fixture(scope='module')
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a campaign in which a worn clutch fails, and one run is invalid."""

    def state(run):
        worn = run.varied['wear_gain'] == 0.8
        return INVALID if run.index == 11 else 'not_engaged' if worn else ENGAGED

    made = make_campaign(tmp_path_factory.mktemp('campaigns') / 'wear', GRID, state, reason=EVIL)
    write_campaign_page(made)
    return made


@pytest.fixture(scope='module')
def page(folder: Path) -> Elements:
    return Elements((folder / PAGE).read_text(encoding='utf-8'))


def test_every_number_of_the_summary_is_on_the_page(folder: Path, page: Elements) -> None:
    summary = json.loads((folder / SUMMARY).read_text(encoding='utf-8'))
    wanted = []
    for group in summary['groups']:
        wanted.append(group['failed']['count'] / group['failed']['of'])
        for found in group['quantities'].values():
            wanted += [found[name] for name in ('p5', 'p50', 'p95', 'cvar_engaged')]
            wanted.append((found['worst_engaged'] or {}).get('value'))
    assert {value for value in wanted if value is not None} <= set(page.numbers)
    assert len([value for value in wanted if value is not None]) > 20
    for group in summary['groups']:
        for found in group['boundaries']:
            for side in (found['below'], found['above']):
                assert side['first_failure'] is None or f'run {side["index"]}' in page.text
    for pair in summary['pairs']:
        wanted = [found['p50'] for found in pair['differences'].values()]
        assert {*wanted} - {None} <= {*page.numbers}


def test_the_summary_is_read_as_its_record_and_written_as_it_was(folder: Path) -> None:
    file = folder / SUMMARY
    assert json_text(read_json(SummaryFile, file)) == file.read_text(encoding='utf-8')


def test_the_summary_has_the_failed_runs(folder: Path) -> None:
    summary = json.loads((folder / SUMMARY).read_text(encoding='utf-8'))
    pi, ls8 = summary['groups']
    assert (pi['failed']['count'], pi['failed']['of'], pi['invalid']) == (2, 6, 0)
    assert (ls8['failed']['count'], ls8['invalid']) == (2, 1)
    below = pi['boundaries'][0]['below']
    assert (below['first_failure'], below['last_good'], below['index']) == (0.8, 1.0, 1)


def test_invalid_runs_are_announced_and_failed_ones_are_named(page: Elements) -> None:
    assert '1 of 12 runs is invalid' in page.text
    assert f'1 run, such as run 11: {EVIL}' in page.text
    assert not {'evil', 'onload'} & page.names
    assert '2 not engaged' in page.text
    data = json.loads(page.scripts[0])  # that of the maps
    states = [state for panel in data['maps']['maps'][0]['panels'] for state in panel['state']]
    assert (states.count('not_engaged'), states.count(INVALID), len(states)) == (4, 1, 12)
    assert 'ddct campaign replay' in data['replay']


def test_the_figure_of_the_distributions_is_on_the_page(folder: Path) -> None:
    html = (folder / PAGE).read_text(encoding='utf-8')
    data = json.loads(re.findall(r'id="data">(.*?)</script>', html)[0])
    assert {*data['roots']} > {'map-0', 'map-1', 'chart-0'}


def test_the_keys_that_drive_failure_are_on_the_page_of_random_samples(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    leave_out_figure(monkeypatch)
    vary = {
        'wear_gain': {'distribution': 'uniform', 'low': 0.6, 'high': 1.4},
        'vehicle.mass_kg': {'distribution': 'uniform', 'low': 1200, 'high': 1800},
    }
    content = {'controllers': ['pi'], 'random': {'samples': 60, 'vary': vary}}

    def state(run):
        return 'not_engaged' if run.varied['wear_gain'] < 0.8 else ENGAGED

    made = make_campaign(tmp_path / 'random', content, state)
    (group,) = write_campaign_page(made).groups
    page = Elements((made / PAGE).read_text(encoding='utf-8'))
    assert group.causes is not None
    assert [each.drives for each in group.causes.keys] == [True, False]
    assert {each.explained for each in group.causes.keys} <= set(page.numbers)
    assert 'Which keys drive failure' in page.text
    assert 'Where failure begins' not in page.text


def test_the_page_needs_nothing_else(folder: Path) -> None:
    html = (folder / PAGE).read_text(encoding='utf-8').replace(library(), '')
    assert not re.search(r'(?:src|href)="(?!#|data:)', html)
    assert '://' not in html.replace('http://www.w3.org/2000/svg', '')


def test_text_from_a_campaign_is_escaped_on_the_page() -> None:
    results = made_results(
        [ENGAGED, EVIL],
        {'clutch': [EVIL, 'linear'], EVIL: [0.8, 1.0]},
        {'peak_jerk_m_s3': [1.0, 2.0]},
        controllers=[EVIL, EVIL],
    )
    facts = dict.fromkeys(('scenario', 'specification', EVIL), EVIL)
    document = campaign_document(summary_of(results), EVIL, PageParts(results, facts))
    page = Elements(html_page(document))
    assert not {'evil', 'onload'} & page.names
    assert EVIL in page.text
    data = json.loads(page.scripts[0])  # that of the maps
    assert data['maps']['groups'] == [f'{EVIL}, {EVIL}', f'{EVIL}, linear']


@pytest.mark.parametrize('state', sampled([INVALID, 'withheld', ENGAGED], every=3))
def test_one_run_is_enough_for_a_page(tmp_path: Path, state: str) -> None:
    content = {'controllers': ['pi'], 'grid': {'wear_gain': [1.0]}}
    made = make_campaign(tmp_path / 'one', content, lambda run: state)
    summary = write_campaign_page(made)
    assert summary.groups[0].runs == 1
    assert 'No number was varied' in (made / PAGE).read_text(encoding='utf-8')


@pytest.fixture(scope='module')
def broken(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a campaign in which every run is invalid."""
    cells = dict.fromkeys(METRIC_COLUMNS) | {'reason': 'it broke'}
    folder = tmp_path_factory.mktemp('campaigns') / 'broken'
    return make_campaign(folder, GRID, lambda run: INVALID, **cells)


def test_the_page_of_invalid_runs_alone_says_that_there_is_nothing_to_draw(broken: Path) -> None:
    write_campaign_page(broken)
    page = Elements((broken / PAGE).read_text(encoding='utf-8'))
    assert '12 of 12 runs are invalid' in page.text
    assert 'Nothing to draw: no run is valid.' in page.text
    assert 'No run has a value, so there is no map.' in page.text
    assert not any('maps' in script for script in page.scripts)


@pytest.mark.parametrize('name', ['wear.png', 'wear.html'])
def test_a_figure_of_invalid_runs_alone_is_refused_in_one_line(
    broken: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str
) -> None:
    assert main(['show', str(broken), '--figure', str(tmp_path / name)]) == 1
    assert capsys.readouterr().err == 'ddct campaign: no run is valid: nothing to draw\n'
    assert not (tmp_path / name).exists()


def test_a_campaign_of_invalid_runs_alone_ends_with_exit_code_1_and_its_results(
    broken: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(campaigns, 'carry_out', lambda *given, **options: broken / RESULTS)
    (tmp_path / 'spec.yaml').write_text(json.dumps(GRID), encoding='utf-8')
    assert main([str(tmp_path / 'spec.yaml'), '--out', str(broken)]) == 1
    printed = capsys.readouterr()
    assert printed.out.splitlines()[-1] == str(broken / PAGE)
    assert printed.err == 'ddct campaign: every run is invalid, such as run 0: it broke\n'
