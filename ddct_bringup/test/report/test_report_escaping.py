# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Text from a bag is escaped on the page."""

import json
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import pytest
from made_run import made_facts

from ddct_bringup.bag.realtime_facts import RealtimeFacts
from ddct_bringup.bag.recording import Recording
from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.documents.page_parts import symbols
from ddct_bringup.report.page import report_page
from ddct_bringup.run.headless import run_headless
from ddct_bringup.scores.scored_recording import ScoredRecording, score_recording
from ddct_bringup.scores.scoring import unreadable_run
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.base.errors import DdctError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SETTINGS = RunSettings(
    KnownSettings(load_scenario('thesis', ['duration_s=0.7', 'score_window_s=[0.1,0.6]']))
)
EVIL = '</script></textarea></style>--><evil onload="x"> \'"&amp; w_<evil>'
"""Text that closes every open element and opens one that no page has."""


class Elements(HTMLParser):
    """Collects the names of all elements and attributes, the text, and the scripts."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.names: set[str] = set()
        self.text = ''
        self.scripts: list[str] = []
        self._script = False
        self.feed(html)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.names |= {tag, *(name for name, _ in attrs)}
        self._script = tag == 'script'

    def handle_endtag(self, tag: str) -> None:
        self._script = False

    def handle_data(self, data: str) -> None:
        if self._script:
            self.scripts.append(data)
        else:
            self.text += data


def recording(text: str) -> Recording:
    """Return a run whose bag has `text` in every place for text."""
    scenario = SETTINGS.scenario
    facts = made_facts(
        controller='pi',
        control_start_s=scenario.control_start_s,
        score_window_s=scenario.score_window_s,
        duration_s=scenario.duration_s,
    )
    trajectory = run_headless(SETTINGS, 'pi')
    status = tuple((*pairs, (text, text)) for pairs in trajectory.status)
    return Recording(
        path=Path('/nowhere') / text.replace('/', '_') / 'pi_0.mcap',
        trajectory=Trajectory({**trajectory.signals, 'status': status}),
        facts=facts,
        custom_data={'commit': text, 'version': text},
        run_info={text: {text: text}},
        missed={},
        realtime=RealtimeFacts(),
    )


@pytest.fixture(scope='module')
def html() -> str:
    whole = recording(EVIL)
    runs = [
        # Two of one controller, so that the labels of the charts name the bags.
        *(
            ScoredRecording(score_recording(whole, bag, packaged_limits()).scores, whole)
            for bag in (f'{EVIL}/a', f'{EVIL}/b')
        ),
        ScoredRecording(unreadable_run(Path(EVIL), DdctError(f'damaged {EVIL}'))),
    ]
    limits = replace(packaged_limits(), origin={**packaged_limits().origin, 'name': EVIL})
    return report_page(runs, [], limits)


def test_no_text_of_a_bag_becomes_an_element_or_an_attribute(html):
    page = Elements(html)
    assert not {'evil', 'onload'} & page.names
    assert 'script' in page.names


def test_the_text_is_shown_as_it_is(html):
    page = Elements(html)
    assert f'damaged {EVIL}' in page.text
    assert page.text.count(EVIL) >= 7, 'limits, commit, version, scenario, node, key and value'


def test_the_data_of_the_charts_come_back_whole(html):
    (data,) = re.findall(r'<script type="application/json"[^>]*>(.*?)</script>', html, re.DOTALL)
    assert f'{EVIL}/a' in json.dumps(json.loads(data), ensure_ascii=False).replace('\\"', '"')


@pytest.mark.parametrize(
    ('text', 'shown'),
    [
        ('w_sr in rpm', 'w<sub>sr</sub> in rpm'),
        ('<evil>', '&lt;evil&gt;'),
        ('w_sr<evil>"\'&', 'w<sub>sr</sub>&lt;evil&gt;&#34;&#39;&amp;'),
    ],
)
def test_symbols_get_their_index_and_everything_else_is_escaped(text, shown):
    assert str(symbols(text)) == shown
