# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Readers take damaged inputs, or refuse them in one line; `make fuzz` tries many more."""

import sys
from pathlib import Path

import pytest
from fuzz.edits import KINDS, Edit, edited
from fuzz.loop import CORPUS, bounded_time, fuzz, inputs_in, keep
from fuzz.reader import Reader
from fuzz.readers import readers
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from ddct_plant.base.errors import DdctError

NAMES = (
    *('bag', 'bag_as_log', 'repair', 'log', 'controller', 'fmu_description', 'fmu'),
    *('timing', 'failed_run', 'repeated_failure', 'digests', 'scores', 'verified_scores'),
    *('frequency', 'campaign', 'manifest', 'results', 'result_row', 'summary'),
    *('benchmark', 'benchmark_rows', 'benchmark_limits', 'update_times', 'floor'),
    *('tuning_mpc_thesis', 'tuning_pi_launches', 'tuning_manifest', 'tuning_trials'),
    *('tuning_runs', 'scenario', 'profile', 'limits', 'columns', 'parquet'),
    *('live_head', 'live_frames'),
)
EDITS = st.lists(
    st.builds(Edit, st.sampled_from(KINDS), st.integers(0, 2**31 - 1), st.integers(0, 2**16 - 1)),
    min_size=1,
    max_size=5,
)


@pytest.fixture(scope='module')
def known(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Reader]:
    """Return all readers by name."""
    return readers(tmp_path_factory.mktemp('readers'))


def test_every_reader_is_tried(known: dict[str, Reader]) -> None:
    assert tuple(known) == NAMES
    assert {folder.name for folder in CORPUS.iterdir() if folder.is_dir()} <= set(NAMES)


@pytest.mark.parametrize('name', NAMES)
def test_good_inputs_are_read(known: dict[str, Reader], name: str) -> None:
    assert len(known[name].expected) == len(known[name].seeds)


@pytest.mark.parametrize('name', NAMES)
def test_good_and_kept_inputs_have_no_finding(
    known: dict[str, Reader], tmp_path: Path, name: str
) -> None:
    reader = known[name]
    for data in (*reader.seeds, *inputs_in(CORPUS / name), b''):
        with bounded_time():
            assert reader.finding(data, tmp_path / 'work') == ''


@pytest.mark.slow
@pytest.mark.parametrize('name', NAMES)
def test_damaged_inputs_have_no_finding(
    known: dict[str, Reader], tmp_path: Path, name: str
) -> None:
    reader = known[name]

    @settings(
        max_examples=30,
        derandomize=True,
        database=None,
        deadline=None,
        suppress_health_check=list(HealthCheck),
    )
    @given(st.sampled_from((*reader.seeds, *inputs_in(CORPUS / name))), EDITS)
    def require_no_finding(seed: bytes, edits: list[Edit]) -> None:
        with bounded_time():
            assert reader.finding(edited(seed, edits), tmp_path / 'work') == ''

    require_no_finding()


def test_a_traceback_printed_text_and_another_number_are_findings(tmp_path: Path) -> None:
    def read(file: Path) -> object:
        if file.read_bytes() == b'':
            print('nothing', file=sys.stderr)
            raise DdctError('it is empty')
        return int(file.read_bytes())

    reader = Reader('number', 'number', read, (b'12',), exact=True)
    assert reader.finding(b'12', tmp_path / 'work') == ''
    assert reader.finding(b'x', tmp_path / 'work').startswith('ValueError')
    assert reader.finding(b'', tmp_path / 'work') == "prints 'nothing\\n'"
    other = reader.finding(b'13', tmp_path / 'work')
    assert other == 'other numbers than those of the good inputs'


def test_inputs_of_findings_are_edited_too(tmp_path: Path) -> None:
    seen = set()
    reader = Reader('number', 'number', lambda file: seen.add(file.read_bytes()), (b'',))
    keep(b'far from all edits of nothing', tmp_path / 'kept')
    fuzz(reader, 0.3, 0, tmp_path / 'work', tmp_path / 'kept')
    assert any(b'all edits' in data for data in seen)
    assert any(b'all edits' not in data for data in seen)
