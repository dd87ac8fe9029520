# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The digest of a campaign is that of all files it names; they do not run before it is right."""

from pathlib import Path
from typing import Any

import pytest
from in_this_process import in_this_process
from refusals import refused
from verified import CONTROLLER, HANDOVER

from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.conduct import SHARDS, carry_out
from ddct_bringup.campaign.plan import RecordedCampaign
from ddct_bringup.campaign.spec import spec_of
from ddct_bringup.campaign.specification.named_files import with_places
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.base.errors import DdctError

PROFILE = {'csv': 'a.csv', 'time': 't', 'value': 'c', 'unit': 'N m'}
SHIFT: dict[str, Any] = {
    'controllers': ['pi'],
    'scenario': 'upshift',
    'grid': {'handover': ['timed', 'own.py'], 'duration_s': [1.0]},
}
FILES = {
    'own.yaml': 'name: own\ncar: {base: car.yaml}\ndrive: drive.yaml\n',
    'car.yaml': 'base: c635_thesis\n',
    'drive.yaml': 'base: thesis\nengine: {csv: a.csv, time: t, value: c, unit: N m}\n',
    'a.csv': 't,c\n0,97\n',
    'b.csv': 't,c\n0,98\n',
    'tuned.yaml': 'name: tuned\nwith_options: {controller: line.yaml, options: {}}\n',
    'line.yaml': 'name: line\nunits: {input: rpm, output: N m}\n'
    'polynomial: {num: [-0.1, -1.0], den: [1, 0]}\n',
    'mine.py': CONTROLLER,
    'own.py': HANDOVER,
    'outer.yaml': 'name: outer\nwith_options: {controller: mine.py, options: {}}\n',
}


def campaign(folder: Path, **changes: Any) -> Campaign:
    """Return a campaign of the files, which are written into a folder."""
    for name, text in FILES.items():
        (folder / name).write_text(text, encoding='utf-8')
    content = {
        'controllers': ['pi', 'tuned.yaml'],
        'grid': {
            'scenario': ['thesis', 'own.yaml'],
            'brake.csv': ['b.csv'],
            'engine': [PROFILE],
        },
    }
    return Campaign(spec_of({**content, **changes}, folder))


def test_the_digest_is_that_of_earlier_campaigns(tmp_path: Path) -> None:
    expected = 'e1693366159757d6dbd6fdca3c36b143704bb22c7bd336b48824c20cf0ba1af3'
    assert campaign(tmp_path).digest() == expected


@pytest.mark.parametrize(
    'file', ['own.yaml', 'car.yaml', 'drive.yaml', 'a.csv', 'b.csv', 'tuned.yaml', 'line.yaml']
)
def test_any_changed_file_changes_it(tmp_path: Path, file: str) -> None:
    made = campaign(tmp_path)
    before = made.digest()
    (tmp_path / file).write_text(f'{FILES[file]}\n', encoding='utf-8')
    assert made.digest() != before


@pytest.mark.parametrize('changed', ['controllers', 'grid'])
def test_a_changed_module_beside_a_python_file_changes_it(tmp_path: Path, changed: str) -> None:
    own = {**SHIFT, 'controllers': ['mine.py']} if changed == 'controllers' else SHIFT
    made = campaign(tmp_path, **own)
    file = tmp_path / ('mine.py' if changed == 'controllers' else 'own.py')
    file.write_text(f'import helper\n{file.read_text(encoding="utf-8")}', encoding='utf-8')
    digests = set()
    for text in ('X = 1\n', 'X = 2\n', 'X = 2\n'):
        (tmp_path / 'helper.py').write_text(text, encoding='utf-8')
        digests.add(made.digest())
    assert len(digests) == 2


def test_a_handover_file_is_relative_to_the_specification(tmp_path: Path) -> None:
    made = campaign(tmp_path, **SHIFT)
    named = [made.run(case).settings.known.handover for case in range(2)]
    assert named == ['timed', str(tmp_path / 'own.py')]
    assert [made.run(case).varied['handover'] for case in range(2)] == ['timed', 'own.py']
    drawn = {'handover': {'distribution': 'choice', 'values': ['own.py']}}
    grid, random = {'duration_s': [1.0]}, {'samples': 1, 'vary': drawn}
    made = campaign(tmp_path, **{**SHIFT, 'grid': grid, 'random': random})
    assert made.run(0).settings.known.handover == named[1]


@pytest.mark.process
def test_a_changed_handover_is_refused_before_it_runs(tmp_path: Path) -> None:
    out = tmp_path / 'out'
    with in_this_process():
        carry_out(campaign(tmp_path, **SHIFT), packaged_limits(), out)
    assert RecordedCampaign.read(out).campaign().runs == 2
    (out / 'inputs' / 'own.py').write_text(f'{HANDOVER}\n', encoding='utf-8')
    with refused(DdctError) as caught:
        RecordedCampaign.read(out).campaign()
    assert 'has changed since' in str(caught.value)


def test_a_campaign_is_not_resumed_with_a_changed_handover(tmp_path: Path) -> None:
    made = campaign(tmp_path, **SHIFT)
    out = tmp_path / 'out'
    with in_this_process():
        carry_out(made, packaged_limits(), out)
        (tmp_path / 'own.py').write_text(f'{HANDOVER}\n', encoding='utf-8')
        with refused(DdctError, key='inputs/own.py'):
            carry_out(Campaign(made.spec), packaged_limits(), out, resume=True)


def test_a_handover_that_changes_meanwhile_ends_the_campaign(tmp_path: Path) -> None:
    campaign(tmp_path)
    changes_itself = f'{HANDOVER}\nopen(__file__, "a").write("#")\n'
    (tmp_path / 'own.py').write_text(changes_itself, encoding='utf-8')
    out = tmp_path / 'out'
    with in_this_process(), refused(DdctError) as caught:
        carry_out(Campaign(spec_of(SHIFT, tmp_path)), packaged_limits(), out)
    assert 'has changed since the campaign began' in str(caught.value)
    assert not (out / SHARDS / '00000001.parquet').exists()


@pytest.mark.process
@pytest.mark.parametrize('controller', ['mine.py', 'outer.yaml'])
def test_a_changed_python_file_is_refused_before_it_runs(tmp_path: Path, controller: str) -> None:
    made = campaign(tmp_path, controllers=[controller], grid={'duration_s': [0.7]})
    out = tmp_path / 'out'
    with in_this_process():
        carry_out(made, packaged_limits(), out)
    ran = tmp_path / 'ran'
    other = f'{CONTROLLER}\nopen({str(ran)!r}, "w").close()\n'
    (out / 'inputs' / 'mine.py').write_text(other, encoding='utf-8')
    with refused(DdctError) as caught:
        RecordedCampaign.read(out).campaign()
    assert 'has changed since' in str(caught.value)
    assert not ran.exists(), 'code of another file has run'


def test_a_moved_specification_names_the_same_files() -> None:
    content = {
        'controllers': ['mine.py'],
        'scenario': 'own.yaml',
        'grid': {'handover': ['timed', 'own.py'], 'engine': [PROFILE], 'wear_gain': [1.0]},
        'random': {
            'samples': 1,
            'vary': {
                'brake.csv': {'distribution': 'choice', 'values': ['b.csv']},
                'vehicle.mass_kg': {'distribution': 'uniform', 'low': 1000, 'high': 2000},
            },
        },
    }
    moved = with_places(content, lambda _, name: f'../{name}')
    assert moved['controllers'] == ['mine.py']
    assert moved['scenario'] == '../own.yaml'
    engine = {**PROFILE, 'csv': '../a.csv'}
    assert moved['grid'] == {
        'handover': ['timed', '../own.py'],
        'engine': [engine],
        'wear_gain': [1.0],
    }
    assert moved['random']['vary']['brake.csv']['values'] == ['../b.csv']
    assert with_places(content, lambda _, name: name) == content
    varied = {'grid': {'scenario': ['thesis', 'own.yaml']}}
    assert with_places(varied, lambda _, name: f'../{name}') == {
        'grid': {'scenario': ['thesis', '../own.yaml']}
    }
