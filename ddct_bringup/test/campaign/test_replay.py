# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The bag of a row has the scores of the row, and another bag is detected."""

import json
from pathlib import Path

import pytest
from by_schema import require_schema
from in_this_process import in_this_process
from printed_commands import printed_commands, run_printed

from ddct_bringup.campaign.columns import COMPARED, differences, read_row
from ddct_bringup.campaign.conduct import RESULTS
from ddct_bringup.campaign_report.folder import PAGE
from ddct_bringup.programs import campaign
from ddct_bringup.verdict import limits

ROW = {
    **dict.fromkeys(COMPARED, 1.5),
    **{'path': 'serial', 'valid': True, 'reason': '', 'state': 'engaged'},
    **{'why': '', 'judder_rpm': None},
}
SPEC = """\
controllers: [ls8]
scenario: thesis_sticking
grid: {wear_gain: [0.8, 1.0]}
random:
  samples: 1
  vary:
    duration_s: {distribution: choice, values: [0.7, 0.8]}
    vehicle.mass_kg: {distribution: uniform, low: 1000, high: 2000}
"""


@pytest.fixture(scope='module')
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a campaign of two runs."""
    place = tmp_path_factory.mktemp('replayed')
    (place / 'spec.yaml').write_text(SPEC, encoding='utf-8')
    out = place / 'campaign'
    with in_this_process():
        assert campaign.main([str(place / 'spec.yaml'), '--out', str(out)]) == 0
    return out


def replay(folder: Path, *arguments: str) -> int:
    out = str(folder.parent / 'again')
    return campaign.main(['replay', str(folder), '--headless', '--out', out, *arguments])


def test_the_printed_commands_make_the_bag_of_a_row(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    place, packaged = tmp_path / "the driver's own", Path(limits.__file__).parent / 'limits.yaml'
    place.mkdir()
    monkeypatch.chdir(place)
    Path('spec.yaml').write_text(SPEC, encoding='utf-8')
    mine = packaged.read_text(encoding='utf-8') + '# mine\n'
    Path('my limits.yaml').write_text(mine, encoding='utf-8')
    with in_this_process():
        given = ['spec.yaml', '--out', 'my campaign', '--limits', 'my limits.yaml']
        assert campaign.main(given) == 0
    (printed,) = printed_commands(capsys.readouterr().out)
    *of_runs, on_page = printed_commands(Path('my campaign', PAGE).read_text(encoding='utf-8'))
    Path('my limits.yaml').unlink()
    assert run_printed(printed, I='1') == 0
    monkeypatch.chdir('my campaign')
    assert run_printed(on_page, I='1') == 1, 'there is a result'
    assert run_printed(of_runs[0]) == 0
    assert all(list(Path('..', folder).rglob('*.mcap')) for folder in ('replay-I', 'replay-0'))


def test_a_row_is_its_own_replay() -> None:
    assert differences(ROW, dict(ROW)) == []


@pytest.mark.parametrize(
    ('name', 'value'),
    [
        ('peak_jerk_m_s3', 1.5 + 2.3e-16),
        ('judder_rpm', 0.0),
        ('engagement_time_s', None),
        ('state', 'stalled'),
        ('reason', 'other'),
        ('why', 'it slips'),
        ('valid', False),
    ],
)
def test_whatever_differs_is_named(name: str, value: object) -> None:
    (found,) = differences(ROW, {**ROW, name: value})
    assert found == f'{name} is {value!r}, in the row {ROW[name]!r}'


def test_a_vectorised_row_may_differ_in_the_last_digits_of_its_numbers() -> None:
    row = {**ROW, 'path': 'vectorised'}
    assert differences(row, {**row, 'peak_jerk_m_s3': 1.5 * (1 + 0.9e-9)}) == []
    assert differences(row, {**row, 'peak_jerk_m_s3': 1.5 * (1 + 1.1e-9)})
    assert differences(row, {**row, 'state': 'stalled'})


def test_every_row_of_a_campaign_replays_to_the_last_bit(
    folder: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    for index in ('0', '1'):
        assert replay(folder, '--index', index, '--overwrite', '--json', '-') == 0
        told = capfd.readouterr()
        require_schema('replay', json.loads(told.out))
        assert f'run {index}: its {len(COMPARED)} figures and words are those of' in told.err
        how = 'bit for bit' if '"path": "serial"' in told.out else 'to 1e-09'
        assert f'are those of the row, {how}' in told.err
        assert '"differences": []' in told.out
    assert (folder.parent / 'again' / 'ls8' / 'ls8_0.mcap').is_file()


def test_a_replay_that_differs_ends_with_exit_code_1_and_the_differences(
    folder: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr('ddct_bringup.api.shell.campaigns.read_row', _another_row)
    assert replay(folder, '--index', '0', '--overwrite') == 1
    assert 'run 0: state is ' in capfd.readouterr().err


def test_a_folder_for_the_json_that_is_not_there_is_reported_before_the_run(
    folder: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    to, out = str(tmp_path / 'absent' / 'replay.json'), tmp_path / 'out'
    assert replay(folder, '--index', '0', '--out', str(out), '--json', to) == 1
    (line,) = capfd.readouterr().err.splitlines()
    assert line.startswith('ddct campaign') and 'no folder' in line
    assert not out.exists()


def _another_row(results: Path, index: int, runs: int) -> dict[str, object]:

    return {**read_row(results, index, runs), 'state': 'over_revved'}


@pytest.mark.parametrize(
    ('arguments', 'words'),
    [
        (['--index', '2'], f'{RESULTS}: it has no row 2: the rows are 0 to 1'),
        (['--index', '-1'], f'{RESULTS}: it has no row -1: the rows are 0 to 1'),
    ],
)
def test_a_missing_row_is_reported(
    folder: Path, capfd: pytest.CaptureFixture[str], arguments: list[str], words: str
) -> None:
    assert replay(folder, *arguments, '--overwrite') == 1
    assert words in capfd.readouterr().err


def test_a_folder_without_a_campaign_is_reported(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert replay(tmp_path, '--index', '0') == 1
    assert 'no manifest.json in it' in capfd.readouterr().err
