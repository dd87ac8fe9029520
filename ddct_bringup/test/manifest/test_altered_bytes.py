# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Any altered byte of any kind of file of a result is found, and the file is named."""

from pathlib import Path

import pytest
from altered_bytes import kinds_of_files, not_found
from samples import sampled
from verified import leave_out_charts, make_runs, make_small_campaign

pytestmark = pytest.mark.slow


@pytest.fixture(scope='module')
def results(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Return a folder of runs and that of a campaign."""
    place = tmp_path_factory.mktemp('results')
    with pytest.MonkeyPatch.context() as patch:
        leave_out_charts(patch)
        runs, rows = make_runs(place / 'runs', 'pi'), make_small_campaign(place)
    return {'runs': runs, 'campaign': rows}


@pytest.mark.parametrize('count', sampled([20, 200], every=2))
@pytest.mark.parametrize(
    ('kind', 'names'),
    [
        (
            'runs',
            ['.mcap', '.yaml', '.html', 'timing.json', 'scores.json', 'frequency.json'],
        ),
        ('campaign', ['.parquet', '.html', 'summary.json']),
    ],
)
def test_every_altered_byte_is_found_in_the_file_that_is_named(
    results: dict[str, Path], kind: str, names: list[str], count: int
) -> None:
    files = kinds_of_files(results[kind])
    assert {*names, 'manifest.json', '.ddct-output'} <= files.keys()
    lost = {name: not_found(results[kind], file, count) for name, file in files.items()}
    assert lost == dict.fromkeys(files, [])
