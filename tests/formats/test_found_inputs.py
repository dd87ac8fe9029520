# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Readers refuse damaged inputs in a line: found ones, a few new; `tools/run fuzz` has more."""

from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fuzz.edits import KINDS, Edit, edited
from fuzz.loop import FOUND, bounded_time, inputs_in
from fuzz.reader import Reader

pytestmark = pytest.mark.slow

NAMES = (
    *('bag', 'bag_as_log', 'unfinished_bag', 'log', 'controller', 'fmu_description', 'fmu'),
    *('timing', 'failed_run', 'manifest', 'plan', 'scores'),
    *('frequency', 'campaign', 'campaign_plan', 'results', 'result_row', 'summary'),
    *('benchmark', 'benchmark_rows', 'update_times', 'floor'),
    *('tuning_mpc_thesis', 'tuning_pi_launches', 'tuning_plan', 'tuning_trials'),
    *('tuning_runs', 'scenario', 'car', 'drive', 'profile', 'limits', 'columns', 'parquet'),
    'live_frames',
)
EDITS = st.lists(
    st.builds(Edit, st.sampled_from(KINDS), st.integers(0, 2**31 - 1), st.integers(0, 2**16 - 1)),
    min_size=1,
    max_size=5,
)


@pytest.fixture(scope='module')
def known(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Reader]:
    """Return all readers by name."""
    from fuzz.readers import readers

    return readers(tmp_path_factory.mktemp('readers'))


def test_every_reader_is_tried(known: dict[str, Reader]) -> None:
    assert tuple(known) == NAMES
    assert {folder.name for folder in FOUND.iterdir()} <= set(NAMES)


@pytest.mark.parametrize('name', NAMES)
def test_good_and_found_inputs_are_read_or_refused_in_one_line(
    known: dict[str, Reader], tmp_path: Path, name: str
) -> None:
    reader = known[name]
    assert len(reader.expected) == len(reader.seeds)
    for data in (*reader.seeds, *inputs_in(FOUND / name), b''):
        with bounded_time():
            assert reader.finding(data, tmp_path / 'work') == ''


@pytest.mark.slow
@pytest.mark.parametrize('name', NAMES)
def test_damaged_inputs_are_read_or_refused_in_one_line(
    known: dict[str, Reader], tmp_path: Path, name: str
) -> None:
    reader = known[name]

    @settings(
        max_examples=8,
        derandomize=True,
        database=None,
        deadline=None,
        suppress_health_check=list(HealthCheck),
    )
    @given(st.sampled_from((*reader.seeds, *inputs_in(FOUND / name))), EDITS)
    def require_no_finding(seed: bytes, edits: list[Edit]) -> None:
        with bounded_time():
            assert reader.finding(edited(seed, edits), tmp_path / 'work') == ''

    require_no_finding()
