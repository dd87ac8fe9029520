# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A campaign gives the same bytes on any workers, and an interruption loses nothing."""

import errno
import shutil
from collections.abc import Callable, Iterator
from concurrent.futures.process import BrokenProcessPool
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as parquet
import pytest
from in_this_process import OneByOne, in_this_process
from refusals import refused
from verified import edit_manifest

from ddct_bringup.campaign import conduct, run_set, scored
from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.columns import COMPARED, differences, runs_table, schema_of
from ddct_bringup.campaign.conduct import RESULTS, SHARDS, carry_out
from ddct_bringup.campaign.plan import RecordedCampaign
from ddct_bringup.campaign.rows import METRIC_COLUMNS
from ddct_bringup.campaign.scored import Scorer
from ddct_bringup.campaign.spec import spec_of
from ddct_bringup.campaign_report.reading import read_table
from ddct_bringup.manifest.code import code_digest
from ddct_bringup.manifest.manifest import MANIFEST, read_manifest
from ddct_bringup.many_runs import blocks
from ddct_bringup.run.output_folder import locked_folders
from ddct_bringup.verdict.limits import limits_of_text, packaged_limits
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.files import output_file

pytestmark = pytest.mark.slow

SPEC: dict[str, Any] = {
    'controllers': ['pi', 'ls8'],
    'grid': {'wear_gain': [0.7, 1.0], 'duration_s': [0.7]},
    'random': {
        'samples': 2,
        'vary': {'vehicle.mass_kg': {'distribution': 'uniform', 'low': 1000, 'high': 2000}},
    },
}
RUNS, CASES = 8, 4
"""Each case is a shard, whose name is its number."""
WILD = """\
name: wild
units: {input: rpm, output: N m}
transfer_function: {gain: 1.0, numerator: [], denominator: [-2000]}
"""
"""Source of a controller whose state overflows within some steps."""


@pytest.fixture(scope='module', autouse=True)
def small_shards() -> Iterator[None]:
    """Let each case be a shard."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(blocks, '_TOGETHER_LEAST', 1)
        yield


@pytest.fixture
def use() -> Iterator[Callable[[OneByOne], OneByOne]]:
    """Compute campaigns on these workers until the test ends."""
    with ExitStack() as stack:
        yield lambda workers: stack.enter_context(in_this_process(workers))


@pytest.fixture(scope='module')
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a campaign without interruption."""
    out = tmp_path_factory.mktemp('whole') / 'campaign'
    with in_this_process():
        carry_out(made(), packaged_limits(), out)
    return out


def made(**changes: Any) -> Campaign:
    return Campaign(spec_of({**SPEC, **changes}, Path()))


def carried_out(out: Path, *, resume: bool = False, **changes: Any) -> bytes:
    return carry_out(made(**changes), packaged_limits(), out, resume=resume).read_bytes()


def test_a_row_contains_the_run_its_values_and_its_scores(whole: Path) -> None:
    table = parquet.read_table(whole / RESULTS).to_pandas()
    assert table['index'].tolist() == list(range(RUNS))
    assert table['controller'].tolist() == ['pi'] * 4 + ['ls8'] * 4
    assert table['wear_gain'].tolist() == [0.7, 0.7, 1.0, 1.0] * 2
    varied = ['wear_gain', 'duration_s', 'vehicle.mass_kg']
    assert list(table)[: 4 + len(varied)] == ['index', 'controller', 'path', 'seed', *varied]
    assert ['seed', *list(table)[7:]] == list(COMPARED)
    assert table['valid'].all()
    assert (table['reason'] == '').all()
    assert (table['steps'] == 70.0).all()
    assert not {'update_time_median_us', 'missed_steps'} & set(METRIC_COLUMNS)


def test_the_bytes_are_the_same_each_time(whole: Path, tmp_path: Path, use) -> None:
    workers = use(OneByOne())
    assert carried_out(tmp_path / 'out') == (whole / RESULTS).read_bytes()
    assert workers.computed == list(range(CASES))
    names = sorted(path.name for path in (tmp_path / 'out').iterdir())
    assert names == ['.ddct-output', MANIFEST, RESULTS, SHARDS]


def test_the_manifest_describes_the_campaign(whole: Path) -> None:
    recorded = RecordedCampaign.read(whole)
    plan = recorded.plan
    assert (plan.root_seed, plan.runs, plan.shard_size) == (0, RUNS, 1)
    assert recorded.origin.code == code_digest()
    assert plan.spec == SPEC
    assert recorded.campaign().digest() == plan.spec_digest


@pytest.mark.slow
def test_what_an_interruption_left_is_completed_without_loss_or_duplicates(
    whole: Path, tmp_path: Path, use
) -> None:
    out = tmp_path / 'out'
    looks = iter([False] * 2 + [True] * 99)
    use(OneByOne())
    with pytest.raises(KeyboardInterrupt, match='what is done stays: go on with --resume'):
        carry_out(made(), packaged_limits(), out, stopped=lambda: next(looks))
    done = sorted(path.name for path in (out / SHARDS).iterdir())
    assert 0 < len(done) < CASES
    assert not (out / RESULTS).exists()
    (out / SHARDS / done[0]).write_bytes(b'PAR1 and then nothing')
    again = use(OneByOne())
    assert carried_out(out, resume=True) == (whole / RESULTS).read_bytes()
    missing = CASES - len(done) + 1
    assert len(again.computed) == missing


def test_a_refused_sample_ends_the_campaign_before_anything_is_written(tmp_path: Path) -> None:
    grid = {'duration_s': [1.0, 3.0], 'control_start_s': [0.6, 2.4]}
    with refused(ParameterError, 'score_window_s') as caught:
        carried_out(tmp_path / 'out', grid=grid)
    assert caught.value.place.startswith('run 2 (duration_s 1.0, control_start_s 2.4, vehicle.')
    assert not (tmp_path / 'out').exists()


@pytest.mark.slow
def test_a_sample_refused_after_the_start_is_a_row_with_its_reason(
    tmp_path: Path, use, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(run_set, 'MOST_CHECKED', 2)  # the first case and the last
    grid = {'duration_s': [3.0], 'control_start_s': [0.6, 2.4, 0.7]}
    use(OneByOne())
    carried_out(tmp_path / 'out', grid=grid)
    rows = parquet.read_table(tmp_path / 'out' / RESULTS).to_pylist()
    refused = [row for row in rows if row['control_start_s'] == 2.4]
    assert [row['index'] for row in rows if not row['valid']] == [row['index'] for row in refused]
    assert refused[0]['reason'].startswith('run 2 (duration_s 3.0, control_start_s 2.4, veh')
    assert (refused[0]['state'], refused[0]['path']) == ('invalid', 'serial')
    assert len({row['seed'] for row in refused}) == len(refused) / 2  # one for both controllers


def test_planning_can_be_interrupted(tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt):
        carry_out(made(), packaged_limits(), tmp_path / 'out', stopped=lambda: True)
    assert not (tmp_path / 'out').exists()


@pytest.mark.slow
def test_a_worker_that_dies_costs_only_the_time(whole: Path, tmp_path: Path, use) -> None:
    deaths = {1: 1, 3: 1}

    def breaks(first: int) -> Exception | None:
        deaths[first] = deaths.get(first, 0) - 1
        return BrokenProcessPool('killed') if deaths[first] >= 0 else None

    workers = use(OneByOne(breaks))
    assert carried_out(tmp_path / 'out') == (whole / RESULTS).read_bytes()
    assert sorted(workers.computed) == [0, 1, 1, 2, 3, 3]


@pytest.mark.slow
def test_a_run_whose_process_always_dies_is_a_row_with_the_reason(
    whole: Path, tmp_path: Path, use
) -> None:
    use(OneByOne(lambda first: BrokenProcessPool('killed') if first == 2 else None))
    carried_out(tmp_path / 'out')
    rows = parquet.read_table(tmp_path / 'out' / RESULTS).to_pylist()
    expected = parquet.read_table(whole / RESULTS).to_pylist()
    ended = rows.pop(2)
    assert rows == [row for row in expected if row['index'] != 2]
    assert (ended['index'], ended['state']) == (2, 'invalid')
    assert ended['reason'] == 'its process was killed (SIGKILL)'


def test_workers_that_always_die_end_the_campaign_with_a_line(
    whole: Path, tmp_path: Path, use
) -> None:
    out = tmp_path / 'out'
    use(OneByOne(lambda first: BrokenProcessPool('killed') if first else None))
    with pytest.raises(DdctError, match='workers died 3 times one after the other.*--resume'):
        carried_out(out)
    use(OneByOne())
    assert carried_out(out, resume=True) == (whole / RESULTS).read_bytes()


def test_an_error_of_a_worker_is_reported_with_its_runs(tmp_path: Path, use) -> None:
    use(OneByOne(lambda first: MemoryError('full') if first == 2 else None))
    with pytest.raises(
        DdctError, match=r'run 2 or one of its shard could not be computed \(MemoryError: full\)'
    ):
        carried_out(tmp_path / 'out')


@pytest.mark.slow
@pytest.mark.parametrize('full_at', ['00000002.parquet', RESULTS])
def test_a_full_disk_ends_it_with_a_line_and_it_goes_on_later(
    whole: Path, tmp_path: Path, use, monkeypatch: pytest.MonkeyPatch, full_at: str
) -> None:
    out = tmp_path / 'out'
    use(OneByOne())
    replace = Path.replace

    def full(path: Path, target: Any) -> Path:
        if Path(target).name == full_at:
            raise OSError(errno.ENOSPC, 'No space left on device')
        return replace(path, target)

    with monkeypatch.context() as patch:
        patch.setattr(output_file.Path, 'replace', full)
        with pytest.raises(DdctError, match=f'{full_at}: .*No space left on device.*--resume'):
            carried_out(out)
    assert not [path for path in out.rglob('*') if path.name.startswith(f'.{full_at}')]
    assert carried_out(out, resume=True) == (whole / RESULTS).read_bytes()


@pytest.mark.parametrize(
    ('changes', 'key'),
    [
        ({'seed': 1}, 'root seed'),
        ({'controllers': ['pi']}, 'specification'),
    ],
)
def test_another_campaign_cannot_go_on(whole: Path, changes: Any, key: str) -> None:
    with refused(DdctError, key):
        carried_out(whole, resume=True, **changes)


def test_other_code_or_limits_cannot_go_on(whole: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = Path(conduct.__file__).parents[1] / 'verdict' / 'limits.yaml'
    mine = limits_of_text(file.read_text(encoding='utf-8') + '# mine\n', 'mine.yaml')
    with refused(DdctError, 'limits'):
        carry_out(made(), mine, whole, resume=True)
    monkeypatch.setattr('ddct_bringup.manifest.origin.code_digest', lambda: '0' * 64)
    with refused(DdctError, 'code'):
        carried_out(whole, resume=True)


def test_a_folder_with_other_content_is_not_touched(whole: Path, tmp_path: Path) -> None:
    with refused(DdctError, '--resume'):
        carried_out(whole)
    with pytest.raises(DdctError, match='there is nothing to go on with'):
        carried_out(tmp_path / 'absent', resume=True)
    foreign = tmp_path / 'foreign'
    foreign.mkdir()
    (foreign / 'thesis.txt').write_text('mine', encoding='utf-8')
    with refused(DdctError, '--out'):
        carried_out(foreign)
    (foreign / '.ddct-output').write_text('runs', encoding='utf-8')
    with refused(DdctError, '--out'):
        carried_out(foreign)


def test_two_campaigns_into_one_folder_are_one(tmp_path: Path) -> None:
    out = tmp_path / 'out'
    with locked_folders(out), refused(DdctError, place='out'):
        carried_out(out)
    assert not out.exists()


def test_a_damaged_manifest_is_reported(tmp_path: Path) -> None:
    with pytest.raises(DdctError, match='no manifest.json in it: give the folder of a result'):
        RecordedCampaign.read(tmp_path)
    (tmp_path / MANIFEST).write_text('{"schema_version": 1}', encoding='utf-8')
    with pytest.raises(DdctError, match=r'manifest.json: .*is missing: put the original back'):
        RecordedCampaign.read(tmp_path)


@pytest.mark.parametrize(
    'changes',
    [
        {'runs': 10**12},
        {'runs': '8'},
        {'runs': True},
        {'shard_size': 0},
        {'root_seed': None},
        {'root_seed': 2**31},
        {'limits': {'origin': {}}},
        {'limits': []},
        {'spec': 'text'},
        {'spec': {'grid': [1]}},
        {'spec': {'random': 'text'}},
        {'spec': {'random': {'vary': ['gear']}}},
    ],
)
def test_a_manifest_with_a_value_of_another_type_is_refused(
    whole: Path, tmp_path: Path, changes: dict[str, Any]
) -> None:
    out = shutil.copytree(whole, tmp_path / 'out')
    edit_manifest(out, lambda content: content['campaigns']['.'].update(changes))
    with pytest.raises(DdctError, match=f'{out}, campaign .: '):
        RecordedCampaign.read(out)


def flip(file: Path, place: int) -> None:
    """Flip one bit of a file."""
    data = bytearray(file.read_bytes())
    data[place] ^= 4
    file.write_bytes(data)


def test_a_damaged_edited_or_lost_shard_is_computed_again(
    whole: Path, tmp_path: Path, use, capsys: pytest.CaptureFixture[str]
) -> None:
    out = shutil.copytree(whole, tmp_path / 'out')
    shard_files = sorted((out / SHARDS).iterdir())
    flip(shard_files[1], 200)
    table = parquet.read_table(shard_files[3])
    edited = table.set_column(
        table.column_names.index('wear_gain'), 'wear_gain', pa.array([0.75] * len(table))
    )
    parquet.write_table(edited.cast(table.schema), shard_files[3])
    shard_files[2].unlink()
    (out / RESULTS).unlink()
    workers = use(OneByOne())
    assert carried_out(out, resume=True) == (whole / RESULTS).read_bytes()
    assert sorted(workers.computed) == [1, 2, 3]
    errors = capsys.readouterr().err
    assert all(str(shard_files[number]) in errors for number in (1, 3))


@pytest.mark.slow
def test_a_shard_without_its_digest_is_computed_again(whole: Path, tmp_path: Path, use) -> None:
    out = shutil.copytree(whole, tmp_path / 'out')
    replace(read_manifest(out), files={}).write(out)
    workers = use(OneByOne())
    assert carried_out(out, resume=True) == (whole / RESULTS).read_bytes()
    assert sorted(workers.computed) == list(range(CASES))


@pytest.mark.slow
def test_a_shard_that_is_altered_while_the_campaign_goes_on_is_not_merged(
    tmp_path: Path, use
) -> None:
    out = tmp_path / 'out'

    def alter(first: int) -> None:
        if first == CASES - 1:
            flip(min((out / SHARDS).iterdir()), 300)

    use(OneByOne(alter))
    with pytest.raises(DdctError, match='its bytes are not those that were written'):
        carried_out(out)
    assert not (out / RESULTS).exists()


def test_a_manifest_that_was_edited_is_not_resumed(whole: Path, tmp_path: Path) -> None:
    out = shutil.copytree(whole, tmp_path / 'out')
    file = out / MANIFEST
    file.write_text(file.read_text(encoding='utf-8') + ' ', encoding='utf-8')
    with pytest.raises(DdctError, match='its own digest does not match its content'):
        carried_out(out, resume=True)


@pytest.mark.parametrize('name', [MANIFEST, RESULTS])
def test_altered_files_of_a_campaign_are_not_read(whole: Path, tmp_path: Path, name: str) -> None:
    out = shutil.copytree(whole, tmp_path / 'out')
    recorded = RecordedCampaign.read(out)
    assert len(read_table(out, recorded)) == RUNS
    flip(out / name, 300)
    with pytest.raises(DdctError, match=name):
        read_table(out, recorded)


def test_what_a_batch_has_is_computed_at_once_and_all_else_step_by_step(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / 'wild.yaml').write_text(WILD, encoding='utf-8')
    kinds = {'controllers': ['wild.yaml', 'pi'], 'architecture': 'base'}
    grid = {'clutch': ['linear', 'stick_slip'], 'wear_gain': [0.7, 1.0], 'duration_s': [1.2]}
    made = Campaign(spec_of({**kinds, 'grid': grid}, tmp_path))
    scorer = Scorer(packaged_limits())
    schema = schema_of(made.spec)
    rows = runs_table(schema, scorer.scored(made.planned(0, made.runs))).to_pylist()
    assert [row['path'] for row in rows] == ['serial'] * 4 + ['vectorised'] * 4
    assert [row['valid'] for row in rows] == [False] * 4 + [True] * 4
    monkeypatch.setattr(scored, 'why_not_batchable', lambda settings, controller: 'not now')
    again = runs_table(schema, scorer.scored(made.planned(0, made.runs))).to_pylist()
    assert {row['path'] for row in again} == {'serial'}
    assert [differences(row, other) for row, other in zip(rows, again, strict=True)] == [[]] * 8


@pytest.mark.slow
def test_a_run_that_fails_is_a_row_with_its_reason(tmp_path: Path, use) -> None:
    (tmp_path / 'wild.yaml').write_text(WILD, encoding='utf-8')
    use(OneByOne())
    controllers = {'controllers': ['wild.yaml', 'pi'], 'architecture': 'base'}
    spec = spec_of({**SPEC, **controllers}, tmp_path)
    carry_out(Campaign(spec), packaged_limits(), tmp_path / 'out')
    rows = parquet.read_table(tmp_path / 'out' / RESULTS).to_pylist()
    assert [row['valid'] for row in rows] == [False] * 4 + [True] * 4
    failed = rows[0]
    assert "controller 'wild'" in failed['reason']
    assert (failed['state'], failed['why']) == ('invalid', '')
    assert {failed[name] for name in METRIC_COLUMNS} == {None}
