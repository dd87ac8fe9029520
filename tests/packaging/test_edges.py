# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Mappings of values of any type stand only at the edges: elsewhere data have types."""

import ast
from collections.abc import Iterator
from pathlib import Path

from syntax import tree_of

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ('ddct_plant', 'ddct_reference', 'ddct_controllers', 'ddct_bringup')
MAPPINGS = {'dict', 'Mapping', 'MutableMapping'}
FILES = {
    'ddct_plant/bag_file/metadata.py': 'metadata.yaml of a bag',
    'ddct_bringup/bag/writer.py': 'metadata of a bag',
    'ddct_bringup/benchmark/cases.py': 'cases of a benchmark, YAML',
    'ddct_bringup/benchmark/other_car.py': 'cases of a benchmark, YAML',
    'ddct_bringup/benchmark/plan.py': 'manifest.json',
    'ddct_bringup/campaign/columns.py': 'rows of results.parquet',
    'ddct_bringup/campaign/plan.py': 'manifest.json',
    'ddct_bringup/campaign/rows.py': 'rows of results.parquet',
    'ddct_bringup/campaign/spec.py': 'specification of a campaign, YAML',
    'ddct_bringup/campaign/specification/distribution.py': 'specification of a campaign, YAML',
    'ddct_bringup/campaign/specification/named_files.py': 'specification of a campaign, YAML',
    'ddct_bringup/campaign/specification/parts.py': 'specification of a campaign, YAML',
    'ddct_bringup/campaign_report/maps_figure.py': 'keywords of Bokeh',
    'ddct_bringup/documents/document.py': 'figures of Bokeh',
    'ddct_bringup/manifest/manifest.py': 'manifest.json',
    'ddct_bringup/manifest/runs.py': 'manifest.json',
    'ddct_bringup/schemas.py': 'types of the keys of documents',
    'ddct_bringup/reproduction/numbers/number_files.py': 'claims of the thesis, YAML',
    'ddct_bringup/sweep/as_campaign.py': 'specification of a campaign, YAML',
    'ddct_bringup/sweep/sweep.py': 'sweep --json',
    'ddct_bringup/tuning/specification/development.py': 'specification of a tuning, YAML',
    'ddct_bringup/tuning/specification/goals.py': 'specification of a tuning; rows',
    'ddct_bringup/tuning/specification/other_car.py': 'specification of a tuning, YAML',
    'ddct_bringup/tuning/plan.py': 'manifest.json',
    'ddct_bringup/tuning/specification/spec.py': 'specification of a tuning, YAML',
    'ddct_bringup/verdict/limits.py': 'limits, YAML',
    'ddct_bringup/verdict/limits_keys.py': 'limits, YAML',
    'ddct_bringup/verification/comparison.py': 'any JSON, compared with its repetition',
    'ddct_bringup/verification/result.py': 'verify --json',
    'ddct_controllers/from_file/controller_file.py': 'controller file, YAML',
    'ddct_controllers/from_file/designed.py': 'provenance in a controller file, YAML',
    'ddct_controllers/from_file/fmu/fmu_controller.py': 'variables of an FMU, objects of FMPy',
    'ddct_controllers/from_file/fmu/unit.py': 'variables of an FMU, objects of FMPy',
    'ddct_controllers/from_file/transfer_functions.py': 'controller file, YAML',
    'ddct_controllers/from_file/with_options.py': 'controller file, YAML',
    'ddct_controllers/workflows/design_output.py': 'records as JSON; arguments of argparse',
    'ddct_plant/files/input_file.py': 'the schema version of any file',
    'ddct_plant/files/json_records.py': 'any JSON',
    'ddct_plant/files/json_schema.py': 'schemas',
    'ddct_bringup/identification/from_log/car_of_log.py': 'car, YAML',
    'ddct_bringup/identification/from_log/drive_of_log.py': 'drive, YAML',
    'ddct_bringup/identification/from_log/origins.py': 'car, YAML',
    'ddct_bringup/logs/columns.py': 'column map, YAML',
    'ddct_bringup/logs/mat_source.py': 'structures of a MAT file',
    'ddct_plant/scenario/case.py': 'options --case, and files of a case, YAML',
    'ddct_plant/scenario/content.py': 'scenario, YAML',
    'ddct_plant/scenario/csv_profiles.py': 'profiles of a scenario, YAML and CSV',
    'ddct_plant/scenario/file.py': 'scenario, YAML',
    'ddct_plant/scenario/nouns/composed.py': 'car, drive and scenario, YAML',
    'ddct_plant/scenario/nouns/keys.py': 'car, drive and scenario, YAML',
    'ddct_plant/scenario/nouns/layers.py': 'car and drive, YAML',
    'ddct_plant/scenario/nouns/part.py': 'car and drive, YAML',
    'ddct_plant/scenario/nouns/scenario_text.py': 'scenario, YAML',
    'ddct_plant/scenario/nouns/written.py': 'scenario, YAML',
    'ddct_plant/scenario/overrides.py': 'options --set of a scenario',
    'ddct_plant/scenario/recorded_settings.py': 'settings in a bag, JSON',
}
"""Modules that read or write files, with what they read or write."""
VALUES_BY_KEY = {
    'ddct_bringup/campaign/run_set.py',
    'ddct_bringup/gym/cases.py',
    'ddct_bringup/gym/environment.py',
    'ddct_bringup/run/run_base.py',
    'ddct_controllers/interface.py',
    'ddct_controllers/mpc/program/settings.py',
    'ddct_controllers/registry.py',
    'ddct_plant/base/options.py',
    'ddct_plant/scenario/rules/body.py',
    'ddct_plant/scenario/scenario.py',
    'ddct_plant/scenario/settings.py',
}
"""Modules that hand users' values on by their option's key, until an `Option` has checked them."""
CALLERS = {
    'ddct_bringup/api/arguments.py': 'arguments of Python programs',
    'ddct_bringup/api/campaigns.py': 'arguments of Python programs',
    'ddct_bringup/api/result.py': 'scores.json, given to Python programs',
    'ddct_bringup/api/run_and_load.py': 'arguments of Python programs',
    'ddct_bringup/api/shell/sweeps.py': 'arguments of Python programs',
    'ddct_bringup/api/shell/tunings.py': 'arguments of Python programs',
    'ddct_bringup/api/tuning.py': 'arguments of Python programs',
    'ddct_bringup/programs/options/of_runs.py': 'arguments of argparse',
    'ddct_bringup/batch/plant/linear_drivelines.py': 'signals of many runs',
    'ddct_bringup/batch/plant/plants.py': 'signals of many runs',
    'ddct_bringup/batch/recorder.py': 'signals of many runs',
    'ddct_bringup/batch/simulate.py': 'signals of many runs',
    'ddct_bringup/bag/trajectory.py': 'signals: arrays of numbers, or tuples of texts and events',
    'ddct_plant/models/driveline.py': 'signals: numbers, or tuples of numbers and events',
    'ddct_plant/scenario/choices/scenarios.py': 'arguments of Python programs',
}
"""Modules at the other edges, with what passes there."""
EDGES = {*FILES, *VALUES_BY_KEY, *CALLERS}


def open_mappings(package: str) -> Iterator[str]:
    """Yield the modules, within their package, that name a mapping from text to Any."""
    for file in sorted((ROOT / package / package).rglob('*.py')):
        module = file.relative_to(ROOT / package)
        if file.name.endswith('_node.py') or 'graph' in module.parts:
            continue
        for node in ast.walk(tree_of(file)):
            if (
                isinstance(node, ast.Subscript)
                and isinstance(node.value, ast.Name)
                and node.value.id in MAPPINGS
                and ast.unparse(node.slice) == '(str, Any)'
            ):
                yield module.as_posix()
                break


def test_mappings_of_any_type_stand_at_the_listed_edges_alone() -> None:
    """Give data of any other module a dataclass, or list the file that it reads."""
    found = {name for each in PACKAGES for name in open_mappings(each)}
    assert sorted(found) == sorted(EDGES)
