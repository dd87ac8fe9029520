# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Plan of a tuning in the manifest of its result, used to go on with it and to repeat it."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ddct_bringup.benchmark.judged import Judged, require_no_path
from ddct_bringup.campaign.specification.named_files import files_of, with_places
from ddct_bringup.manifest.inputs import INPUTS, InputFiles, full_path
from ddct_bringup.manifest.limits import NamedLimits
from ddct_bringup.manifest.manifest import TUNING, Manifest, read_manifest, require_same_plan
from ddct_bringup.manifest.origin import CodeOrigin
from ddct_bringup.tuning.specification.development import CAMPAIGN
from ddct_bringup.tuning.specification.spec import tuning_spec_of
from ddct_bringup.tuning.tuning import Tuning
from ddct_controllers.from_file.controller_file import is_controller_file
from ddct_controllers.from_file.digests import controller_files
from ddct_controllers.registry import controller_spec
from ddct_plant.base.errors import DdctError
from ddct_plant.files.json_records import from_json


@dataclass(frozen=True)
class TunedEntry:
    """The tuned controller in the plan."""

    name: str
    chosen: str
    """Name, or name of the controller file without its folder."""
    folder: str
    """Folder of the controller file in the result; that itself for a controller without one."""
    digests: Mapping[str, str]
    """SHA-256 of the files that it is made of, or of its package, by their key."""

    def __post_init__(self) -> None:
        """Raise ParameterError for a name with a folder: it may be altered."""
        require_no_path(self.name, self.chosen)


@dataclass(frozen=True)
class TuningPlan:
    """Inputs of a tuning."""

    optuna: str
    """Version of Optuna, which the search depends on."""
    limits: NamedLimits
    controller: TunedEntry
    spec: Mapping[str, Any]
    """Specification, whose files are relative to the inputs of the result."""

    @classmethod
    def of(cls, tuning: Tuning, optuna: str, inputs: InputFiles) -> 'TuningPlan':
        """Return the plan of a tuning, and take its files as `inputs`."""
        judged, spec = tuning.judged, tuning.spec
        folder, content = '.', dict(spec.content)
        content[CAMPAIGN] = with_places(
            content[CAMPAIGN],
            lambda key, name: inputs.add(files_of(key, spec.folder / name)),
        )
        if is_controller_file(judged.chosen):
            place = inputs.add(controller_files(judged.path))
            folder = Path(INPUTS, place).parent.as_posix()
        return cls(
            optuna,
            NamedLimits.of(tuning.limits, inputs),
            TunedEntry(judged.name, judged.chosen, folder, dict(judged.digests)),
            content,
        )


@dataclass(frozen=True)
class RecordedTuning:
    """Plan of the tuning in a folder, and the code that computes it."""

    plan: TuningPlan
    origin: CodeOrigin

    @classmethod
    def read(cls, out: Path) -> 'RecordedTuning':
        """Return the tuning in a folder; raise DdctError without a valid one."""
        return cls.of(read_manifest(out), out)

    @classmethod
    def of(cls, manifest: Manifest, out: Path) -> 'RecordedTuning':
        """Return the tuning of a manifest; raise DdctError for that of another result."""
        if manifest.kind != TUNING:
            raise DdctError('it is no tuning: give the folder of one', place=out)
        return cls(from_json(TuningPlan, manifest.plan, f'{out}, plan'), manifest.origin)

    def tuning(self, out: Path) -> Tuning:
        """Return the tuning, whose files are those in its folder; raise DdctError."""
        # In full, as programs that run elsewhere get the paths of its files.
        result, entry = full_path(out), self.plan.controller
        judged = Judged(entry.name, entry.chosen, result / entry.folder, entry.digests)
        known = controller_spec(judged.path)
        judged = replace(judged, name=known.name)
        spec = tuning_spec_of(self.plan.spec, result / INPUTS, known)
        return Tuning(judged, spec, self.plan.limits.load(out))

    def require_same(self, other: TuningPlan, out: Path) -> None:
        """Raise DdctError with the first difference of another tuning from this one, in `out`."""
        require_same_plan('tuning', (self.plan, self.origin), other, _DIFFERENCES, out)


_DIFFERENCES = {
    'version': 'of another release',
    'code': 'of another release: its code is another one',
    'optuna': 'with another version of Optuna',
    'limits': 'by other limits',
    'controller': 'of another controller, or its file has changed since',
    'spec': 'with another specification',
}
"""Meaning of another value of each key of the plan and the origin, in the order of the checks."""
