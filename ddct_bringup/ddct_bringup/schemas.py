# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Schemas of the JSON that programs write: `python -m ddct_bringup.schemas DIR`."""

import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from ddct_bringup.api.shell.campaigns import ReplayDocument
from ddct_bringup.benchmark.plan import BenchmarkPlan
from ddct_bringup.benchmark.result import SCHEMA_VERSION as RESULT_VERSION
from ddct_bringup.benchmark.result_types import Result, ResultWithTimes
from ddct_bringup.benchmark.update_times import UpdateTimesFile
from ddct_bringup.campaign.plan import CampaignPlan, NoPlan
from ddct_bringup.evaluation.summary import SCHEMA_VERSION as SUMMARY_VERSION
from ddct_bringup.evaluation.summary import SummaryFile
from ddct_bringup.floor.front import LimitDocument
from ddct_bringup.identification.from_log.log_fit_report import LogFitDocument
from ddct_bringup.identification.identification_report import IdentificationDocument
from ddct_bringup.manifest.manifest import BENCHMARK, CAMPAIGN, RUNS, TUNING, Kind, Manifest
from ddct_bringup.manifest.manifest import SCHEMA_VERSION as MANIFEST_VERSION
from ddct_bringup.manifest.runs import RunsPlan
from ddct_bringup.reproduction.numbers.gate import NumbersDocument
from ddct_bringup.reproduction.studies.study import WrittenStudy
from ddct_bringup.run.timing_and_failure import RunTiming
from ddct_bringup.scores.document import ScoresDocument
from ddct_bringup.sweep.sweep import SCHEMA_VERSION as SWEEP_VERSION
from ddct_bringup.sweep.sweep import SweepDocument
from ddct_bringup.tuning.plan import TuningPlan
from ddct_bringup.tuning.result import SCHEMA_VERSION as FRONT_VERSION
from ddct_bringup.tuning.result import TuningResult
from ddct_bringup.verification.document import FolderDocument, FoldersDocument
from ddct_controllers.check.program import CheckReport
from ddct_controllers.design.h_infinity.record_types import HinfResult
from ddct_controllers.design.loop_shaping.record_types import LoopShapingRecord, ThesisRecord
from ddct_controllers.workflows.evidence_types import FrequencyEvidence
from ddct_controllers.workflows.plant_on_paper import PlantOnPaper
from ddct_plant.files.json_records import write_json
from ddct_plant.files.json_schema import Schema, json_schema
from ddct_plant.program.command_line import ProgramParser, run_program
from ddct_plant.program.table import WrittenTable

PROGRAM = 'python -m ddct_bringup.schemas'
SUFFIX = '.schema.json'


@dataclass(frozen=True)
class JsonDocument:
    """JSON that programs write: what it is, and the type that describes it."""

    title: str
    kind: Any
    """Dataclass, or a mapping of them by name."""
    others: Mapping[str, Any] = field(default_factory=dict)
    """Types of keys that are narrower in this document than in the dataclass."""

    @property
    def schema(self) -> Schema:
        """Schema of the document."""
        return json_schema(self.kind, self.title, self.others)


def _manifest(kind: Kind, plan: type) -> JsonDocument:
    others = {
        'schema_version': Literal[MANIFEST_VERSION],
        'kind': Literal[kind],
        'plan': plan,
        'campaigns': Mapping[str, CampaignPlan],
    }
    return JsonDocument(f'manifest.json of the kind {kind}', Manifest, others)


def _of_version(title: str, kind: type, version: int) -> JsonDocument:
    return JsonDocument(title, kind, {'schema_version': Literal[version]})


DOCUMENTS: Mapping[str, JsonDocument] = {
    'scores': JsonDocument('scores.json; --json of compare, score', ScoresDocument),
    'frequency': JsonDocument('frequency.json; --json of design margins', FrequencyEvidence),
    'timing': JsonDocument('timing.json of a bag', RunTiming),
    'manifest_runs': _manifest(RUNS, RunsPlan),
    'manifest_campaign': _manifest(CAMPAIGN, NoPlan),
    'manifest_benchmark': _manifest(BENCHMARK, BenchmarkPlan),
    'manifest_tuning': _manifest(TUNING, TuningPlan),
    'campaign': _of_version('summary.json; --json of campaign', SummaryFile, SUMMARY_VERSION),
    'benchmark': _of_version('result.json of benchmark', Result, RESULT_VERSION),
    'benchmark_with_times': _of_version('--json of benchmark', ResultWithTimes, RESULT_VERSION),
    'update_times': JsonDocument('timing.json of benchmark', UpdateTimesFile),
    'tune': _of_version('front.json; --json of tune', TuningResult, FRONT_VERSION),
    'limit': JsonDocument('--json of limit', LimitDocument),
    'sweep': _of_version('--json of sweep', SweepDocument, SWEEP_VERSION),
    'replay': JsonDocument('--json of campaign replay', ReplayDocument),
    'verify': JsonDocument('--json of verify, of one result', FolderDocument),
    'verify_several': JsonDocument('--json of verify, of several results', FoldersDocument),
    'identify': JsonDocument('--json of identify', IdentificationDocument),
    'identify_log': JsonDocument('--json of identify --from', LogFitDocument),
    'check': JsonDocument('--json of check', CheckReport),
    'numbers': JsonDocument('--json of thesis numbers', NumbersDocument),
    'studies': JsonDocument('--json of thesis studies', Mapping[str, WrittenStudy]),
    'benchmark_packaged': JsonDocument(
        '--json of benchmark --packaged', Mapping[str, WrittenTable]
    ),
    'plant': JsonDocument('--json of design plant', PlantOnPaper),
    'loop_shaping': JsonDocument('--json of design loop-shaping --rise-time', LoopShapingRecord),
    'loop_shaping_thesis': JsonDocument('--json of design loop-shaping', ThesisRecord),
    'h_infinity': JsonDocument('--json of design h-infinity', HinfResult),
}
"""Documents by the name of their schema."""


def write_schemas(folder: Path) -> list[Path]:
    """Write every schema into a folder as NAME.schema.json; return the files."""
    folder.mkdir(parents=True, exist_ok=True)
    files = {folder / f'{name}{SUFFIX}': each for name, each in DOCUMENTS.items()}
    for file, document in files.items():
        write_json(str(file), document.schema)
    return [*files]


def _main(argv: list[str]) -> int:
    parser = ProgramParser(prog=PROGRAM, description='Write the schemas into a folder.')
    parser.add_argument('folder', type=Path, metavar='DIR')
    for file in write_schemas(parser.parse_args(argv).folder):
        print(file)
    return 0


if __name__ == '__main__':
    sys.exit(run_program(PROGRAM, _main, None))
