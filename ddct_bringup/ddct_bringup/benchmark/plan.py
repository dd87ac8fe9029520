# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Plan of a benchmark in the manifest of its result, used to go on with it and to repeat it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ddct_bringup.benchmark.cases import Cases
from ddct_bringup.benchmark.judged import Judged, require_no_path
from ddct_bringup.manifest.inputs import INPUTS, InputFiles
from ddct_bringup.manifest.manifest import BENCHMARK, Manifest, read_manifest, require_same_plan
from ddct_bringup.manifest.origin import CodeOrigin
from ddct_bringup.verdict.limits import packaged_limits
from ddct_controllers.from_file.controller_file import is_controller_file
from ddct_controllers.from_file.digests import controller_files
from ddct_plant.base.errors import DdctError
from ddct_plant.files.json_records import from_json
from ddct_plant.scenario.nouns.keys import CAR


@dataclass(frozen=True)
class JudgedEntry:
    """A judged controller in the plan."""

    name: str
    """Name in results, and of its folder."""
    chosen: str
    """Name, or name of the controller file without its folder."""
    folder: str
    """Folder of the controller file in the result; that itself for a controller without one."""
    digests: Mapping[str, str]
    """SHA-256 of the files that it is made of, or of its package, by their key."""
    held_out_seed: int

    def __post_init__(self) -> None:
        """Raise ParameterError for a name with a folder: it may be altered."""
        require_no_path(self.name, self.chosen)

    @classmethod
    def of(cls, judged: Judged, release: str, judge_seed: int | None) -> 'JudgedEntry':
        """Return the entry of a controller, judged by a release with this digest of its code."""
        seed = judged.held_out_seed(release) if judge_seed is None else judge_seed
        return cls(judged.name, judged.chosen, '.', dict(judged.digests), seed)

    def judged(self, result: Path) -> Judged:
        """Return the controller, whose file is that in the result."""
        return Judged(self.name, self.chosen, result / self.folder, self.digests)


@dataclass(frozen=True)
class BenchmarkPlan:
    """Inputs of a benchmark."""

    limits: Mapping[str, Any]
    """Name, digest and schema version of the limits by which runs are judged."""
    quick: bool
    judge_seed: int | None
    """Seed of a judge for all held-out cases; None where it follows from the digests."""
    controllers: tuple[JudgedEntry, ...]
    cases: Mapping[str, Any]
    """Specification of the cases; the file of a car is relative to the result."""
    left_out: Mapping[str, str]
    """Reasons by name of the scenarios that the car cannot drive."""

    @classmethod
    def of(
        cls,
        judged: Sequence[Judged],
        cases: Cases,
        judge_seed: int | None,
        inputs: InputFiles,
        release: str = '',
    ) -> 'BenchmarkPlan':
        """
        Return the plan of a benchmark, and take its files as `inputs`.

        `release` is the digest of the code of a release, by default of this one.
        """
        code = release or CodeOrigin.here().code
        entries = [
            replace(JudgedEntry.of(each, code, judge_seed), folder=_folder(each, inputs))
            for each in judged
        ]
        limits = dict(packaged_limits().origin)
        content = {**cases.content, **_placed_car(cases, inputs)}
        left_out = dict(cases.left_out)
        return cls(limits, cases.quick, judge_seed, tuple(entries), content, left_out)

    def cases_in(self, out: Path) -> Cases:
        """Return the cases of the benchmark whose result is in a folder."""
        return Cases(self.cases, self.quick, out, self.left_out)


@dataclass(frozen=True)
class RecordedBenchmark:
    """Plan of the benchmark in a folder, and the code of the release that computes its rows."""

    plan: BenchmarkPlan
    origin: CodeOrigin
    out: Path

    @property
    def cases(self) -> Cases:
        """Cases of the benchmark."""
        return self.plan.cases_in(self.out)

    @classmethod
    def read(cls, out: Path) -> 'RecordedBenchmark':
        """Return the benchmark in a folder; raise DdctError without a valid one."""
        return cls.of(read_manifest(out), out)

    @classmethod
    def of(cls, manifest: Manifest, out: Path) -> 'RecordedBenchmark':
        """Return the benchmark of a manifest; raise DdctError for that of another result."""
        if manifest.kind != BENCHMARK:
            raise DdctError('it is no benchmark: give the folder of one', place=out)
        plan = from_json(BenchmarkPlan, manifest.plan, f'{out}, plan')
        plan.cases_in(out).require_parts()
        return cls(plan, manifest.origin, out)

    def require_same(self, other: BenchmarkPlan, out: Path) -> None:
        """Raise DdctError with the first difference of another benchmark from this one, in out."""
        require_same_plan('benchmark', (self.plan, self.origin), other, _DIFFERENCES, out)


def _folder(judged: Judged, inputs: InputFiles) -> str:
    """Return the folder in the result for the file of a controller; take it as an input."""
    if not is_controller_file(judged.chosen):
        return '.'
    own = InputFiles(folder=f'{INPUTS}/{judged.name}')
    place = own.add(controller_files(judged.path))
    inputs.files.update(own.files)
    return Path(own.folder, place).parent.as_posix()


def _placed_car(cases: Cases, inputs: InputFiles) -> dict[str, str]:
    """Return the place in the result for the file of the car, by its key; take it as an input."""
    if not cases.car_files:
        return {}
    own = InputFiles(folder=f'{INPUTS}/{CAR}')
    place = own.add(cases.car_files)
    if both := own.files.keys() & inputs.files.keys():
        raise DdctError(
            f'the car and a controller called {CAR} both have a file {min(both)}: rename one'
        )
    inputs.files.update(own.files)
    return {CAR: f'{own.folder}/{place}'}


_DIFFERENCES = {
    'version': 'of another release',
    'code': 'of another release: its code is another one',
    'limits': 'by other limits',
    'cases': 'of other cases, or with another --car',
    'quick': 'with another number of cases: --quick is given for one of the two',
    'judge_seed': 'with another --seed',
    'controllers': 'of other controllers, or of one whose file has changed since',
}
"""Meaning of another value of each key of the plan and the origin, in the order of the checks."""
