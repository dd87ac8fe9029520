# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`benchmark.json`: the inputs of a benchmark, used to go on with it and to repeat it."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path
from typing import Any

from ddct_bringup.benchmark.cases import Cases
from ddct_bringup.benchmark.judged import Judged, require_no_path
from ddct_bringup.digests.manifests import (
    manifest_content,
    require_kinds,
    require_same_inputs,
    require_texts,
)
from ddct_bringup.digests.origin import CodeOrigin
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.files.json_records import write_json

MANIFEST = 'benchmark.json'
SCHEMA_VERSION = 1
"""Schema version of the manifest."""

_KINDS = {
    **dict.fromkeys(('version', 'commit', 'code_digest'), str),
    **dict.fromkeys(('limits', 'cases'), dict),
    'quick': bool,
}
"""Types of values of the manifest."""


@dataclass(frozen=True)
class JudgedEntry:
    """A judged controller in the manifest."""

    name: str
    """Name in results, and of its folder."""
    chosen: str
    """Name, or name of the controller file without its folder."""
    digests: Mapping[str, str]
    """SHA-256 of the files that it is made of, or of its package, by their key."""
    held_out_seed: int

    def __post_init__(self) -> None:
        """Raise ParameterError for a name with a folder, or another type: it may be altered."""
        require_kinds(self, {'chosen': str, 'held_out_seed': int}, 'controllers.')
        require_no_path(self.name, self.chosen)
        require_texts('controllers.digests', self.digests)

    @classmethod
    def of(cls, judged: Judged, release: str, judge_seed: int | None) -> 'JudgedEntry':
        """Return the entry of a controller, judged by a release with this digest of its code."""
        seed = judged.held_out_seed(release) if judge_seed is None else judge_seed
        return cls(judged.name, judged.chosen, dict(judged.digests), seed)


@dataclass(frozen=True)
class BenchmarkManifest:
    """Inputs of a benchmark."""

    schema_version: int
    version: str
    """Version of the release."""
    commit: str
    """Commit of its sources, as in `run_info`."""
    code_digest: str
    """Digest of the code of the release."""
    limits: Mapping[str, Any]
    """Name, digest and schema version of the limits by which runs are judged."""
    quick: bool
    judge_seed: int | None
    """Seed of a judge for all held-out cases; None where it follows from the digests."""
    controllers: Sequence[JudgedEntry]
    cases: Mapping[str, Any] = field(default_factory=dict)
    """Specification of the cases."""

    @classmethod
    def of(
        cls, judged: Sequence[Judged], cases: Cases, judge_seed: int | None
    ) -> 'BenchmarkManifest':
        """Return the manifest of a benchmark by this release."""
        here = CodeOrigin.here()
        return cls(
            schema_version=SCHEMA_VERSION,
            version=here.version,
            commit=here.commit,
            code_digest=here.code,
            limits=dict(packaged_limits().origin),
            quick=cases.quick,
            judge_seed=judge_seed,
            controllers=[JudgedEntry.of(each, here.code, judge_seed) for each in judged],
            cases=dict(cases.content),
        )

    @classmethod
    def read(cls, out: Path) -> 'BenchmarkManifest':
        """Return the manifest in a folder; raise DdctError without a valid one."""
        with manifest_content(out / MANIFEST, SCHEMA_VERSION, 'benchmark') as content:
            entries = [JudgedEntry(**each) for each in content['controllers']]
            known = {each.name: content[each.name] for each in fields(cls)}
            manifest = cls(**{**known, 'controllers': entries})
            require_kinds(manifest, _KINDS)
            if manifest.judge_seed is not None:
                require_kinds(manifest, {'judge_seed': int})
            manifest.run_cases.require_parts()
            return manifest

    def write(self, out: Path) -> None:
        """Write the manifest into a folder; raise DdctError when that fails."""
        write_json(str(out / MANIFEST), asdict(self))

    @property
    def origin(self) -> CodeOrigin:
        """Code of the release, which computes the rows of the benchmark."""
        return CodeOrigin(self.version, self.commit, self.code_digest)

    @property
    def run_cases(self) -> Cases:
        """Cases of the benchmark."""
        return Cases(self.cases, self.quick)

    def require_same(self, other: 'BenchmarkManifest', out: Path) -> None:
        """Raise DdctError with the first difference of another benchmark from this one, in out."""
        require_same_inputs(asdict(self), asdict(other), _DIFFERENCES, 'benchmark', out)


_DIFFERENCES = {
    'schema_version': 'of another version',
    'version': 'of another release',
    'code_digest': 'of another release: its code is another one',
    'limits': 'by other limits',
    'cases': 'of other cases',
    'quick': 'with another number of cases: --quick is given for one of the two',
    'judge_seed': 'with another --seed',
    'controllers': 'of other controllers, or of one whose file has changed since',
}
"""Meaning of another value of each key of the manifest, in the order of the checks."""
