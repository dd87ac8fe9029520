# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The packaged cases cover what they should, and the packaged rows come out again."""

import io
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
from shown_tables import require_reasons, require_whole_lines
from small_benchmark import shown_runs

from ddct_bringup.benchmark.cases import Cases, packaged_folder
from ddct_bringup.benchmark.release import ReleaseRows, columns_kept, release_rows
from ddct_bringup.benchmark.report.packaged import packaged_document, packaged_tables
from ddct_bringup.campaign.columns import runs_table, schema_of
from ddct_bringup.campaign.scored import Scorer
from ddct_bringup.documents.document import Table
from ddct_bringup.documents.terminal import print_document, text_table
from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verification.comparison import Comparison, plain_json
from ddct_controllers.registry import own_controller_names
from ddct_plant.base.clutch_kinds import STICK_SLIP
from ddct_plant.scenario.choices.scenarios import scenario_names
from ddct_plant.scenario.file import load_scenario

pytestmark = pytest.mark.slow

SYNTHESISED = ('hinf_fitted', 'hinf_sampled', 'hinf_thesis')
"""Controllers that are synthesised in each process; docs/use/benchmark.md: Verify a result."""
ROWS = 8
"""Number of rows that are computed again, each of another controller and case."""


@pytest.fixture(scope='module')
def release() -> ReleaseRows:
    return release_rows(packaged_folder())


def test_the_cases_are_all_scenarios_that_stick_with_the_stated_car_and_sensors() -> None:
    spec = Cases.packaged().whole
    sticking = [name for name in scenario_names() if load_scenario(name).clutch == STICK_SLIP]
    assert sorted(spec.values_of('scenario')) == sticking
    ends = {key: spec.vary[key].ends for key in spec.vary}
    assert ends == {
        'wear_gain': (0.7, 1.3),
        'actuator.delay_s': (0.005, 0.02),
        'vehicle.mass_kg': (0.8 * 1500.0, 1.3 * 1500.0),
    }
    (sensors,) = spec.values_of('sensors')
    assert sensors.keys() == {'engine_speed', 'shaft_speed', 'vehicle_speed', 'engine_torque'}
    assert spec.controllers == ('pi', 'ls8', 'hinf_sampled', 'mpc_wear')


def test_a_quick_benchmark_has_the_first_tenth_of_the_cases(release: ReleaseRows) -> None:
    whole, quick = Cases.packaged().planned, Cases.packaged(quick=True).planned
    assert quick.cases == whole.cases / 10
    each, spec = whole.spec.samples, quick.spec
    for case in (0, 1, quick.cases - 1):
        same = whole.run(case // spec.samples * each + case % spec.samples)
        assert quick.run(case).settings == same.settings
    rows = release.of(Cases.packaged(quick=True)).rows
    wear = [quick.run(case).varied['wear_gain'] for case in range(quick.cases)]
    assert rows.only(['pi']).rows['wear_gain'].to_pylist() == wear


def test_the_release_has_every_packaged_controller_in_every_case(release: ReleaseRows) -> None:
    campaign = Cases.packaged().planned
    assert list(release.rows.controllers) == own_controller_names()
    assert release.rows.cases == campaign.cases
    assert release.cases_digest == Cases.packaged().digest
    assert {*columns_kept(campaign.spec)} == {*release.rows.rows.column_names}


def test_a_sample_of_the_rows_comes_out_again_within_the_bound(release: ReleaseRows) -> None:
    names = [name for name in own_controller_names() if name not in SYNTHESISED]
    campaign = Cases.packaged().development(names, Path())
    scorer = Scorer(packaged_limits())
    kept = columns_kept(campaign.spec)
    assert {*kept} <= {*schema_of(campaign.spec).names}
    comparison = Comparison()
    draw = np.random.default_rng(1)
    for place in draw.choice(len(names), ROWS, replace=False).tolist():
        case = int(draw.integers(campaign.cases))
        index = place * campaign.cases + case
        (run,) = campaign.planned(index, index + 1)
        (found,) = scorer.scored([run])
        (row,) = runs_table(schema_of(campaign.spec), [found]).to_pylist()
        columns = release.rows.only([names[place]]).rows
        for name in (each for each in kept if each in columns.column_names):
            ours = columns[name][case].as_py()
            comparison.add({'row': index, 'column': name}, ours, plain_json(row[name]))
    assert comparison.beyond is None


@pytest.fixture(scope='module')
def tables() -> Mapping[str, Table]:
    return packaged_tables()


def test_every_controller_of_the_release_stands_in_every_table_with_all_its_runs(
    tables: Mapping[str, Table],
) -> None:
    for name, found in tables.items():
        table = text_table(found)
        controllers = list(dict.fromkeys(row[0] for row in table.rows))
        assert controllers == own_controller_names()
        if 'engaged' in table.headers:
            among = 330 if name == 'all' else 30
            assert {shown_runs(table, row) for row in range(len(controllers))} == {among}


def test_the_tables_of_the_release_fit_a_file_with_a_reason_for_each_dash(
    tables: Mapping[str, Table],
) -> None:
    stream = io.StringIO()
    print_document(packaged_document(tables), stream)
    lines = stream.getvalue().splitlines()
    require_whole_lines(lines, 120)
    require_reasons(lines)
