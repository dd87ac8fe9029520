# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`tuning.json`: the inputs of a tuning, used to go on with it and to repeat it."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path
from typing import Any

from ddct_bringup.benchmark.judged import Judged
from ddct_bringup.campaign.keys import CONTROLLERS
from ddct_bringup.campaign.specification.named_files import digest_of
from ddct_bringup.digests.code import code_digest
from ddct_bringup.digests.manifests import (
    manifest_content,
    require_kinds,
    require_same_inputs,
    require_texts,
)
from ddct_bringup.tuning.specification.spec import TuningSpec, tuning_spec_of
from ddct_bringup.tuning.tuning import Tuning
from ddct_bringup.verdict.limits import Limits
from ddct_controllers.registry import controller_spec
from ddct_plant.base.errors import DdctError
from ddct_plant.files.json_records import write_json
from ddct_plant.program.command_line import package_version

MANIFEST = 'tuning.json'
SCHEMA_VERSION = 1
"""Schema version of the manifest."""

_KINDS = {
    **dict.fromkeys(('version', 'code_digest', 'optuna', 'campaign_digest', 'folder'), str),
    **dict.fromkeys(('limits', 'controller', 'spec'), dict),
}
"""Types of values of the manifest."""
_OF_CONTROLLER = ('name', 'chosen', 'folder')
"""Keys of the controller, besides its digests."""


@dataclass(frozen=True)
class TuningManifest:
    """Inputs of a tuning."""

    schema_version: int
    version: str
    """Version of the packages."""
    code_digest: str
    optuna: str
    """Version of Optuna."""
    limits: Mapping[str, Any]
    """Name, digest and schema version of the limits by which runs are judged."""
    controller: Mapping[str, Any]
    """Name of the controller, how it was given, and the digests of its files."""
    campaign_digest: str
    """Digest of the cases and of the files that they name."""
    spec: Mapping[str, Any]
    """Specification as given."""
    folder: str
    """Folder that files of the specification are relative to."""

    @classmethod
    def of(cls, tuning: Tuning, optuna: str) -> 'TuningManifest':
        """Return the manifest of a tuning by this version, and by that of Optuna."""
        judged = tuning.judged
        return cls(
            schema_version=SCHEMA_VERSION,
            version=package_version(),
            code_digest=code_digest(),
            optuna=optuna,
            limits=dict(tuning.limits.origin),
            controller={
                'name': judged.name,
                'chosen': judged.chosen,
                'folder': str(judged.folder),
                'digests': dict(judged.digests),
            },
            campaign_digest=tuning.campaign.digest(),
            spec=dict(tuning.spec.content),
            folder=str(tuning.spec.folder),
        )

    @classmethod
    def read(cls, out: Path) -> 'TuningManifest':
        """Return the manifest in a folder; raise DdctError without a valid one."""
        with manifest_content(out / MANIFEST, SCHEMA_VERSION, 'tuning') as content:
            manifest = cls(**{each.name: content[each.name] for each in fields(cls)})
            require_kinds(manifest, _KINDS)
            controller = dict(manifest.controller)
            require_texts('controller.digests', controller.pop('digests'))
            require_texts('controller', {key: controller[key] for key in _OF_CONTROLLER})
            return manifest

    def write(self, out: Path) -> None:
        """Write the manifest into a folder; raise DdctError when that fails."""
        write_json(str(out / MANIFEST), asdict(self))

    def tuning(self, limits: Limits, files: Path | None = None) -> Tuning:
        """Return the tuning; its files are in `files` if they were moved. Raise DdctError."""
        judged = self._judged(files)
        judged.require_unchanged()
        spec: TuningSpec = tuning_spec_of(
            self.spec, files or Path(self.folder), controller_spec(judged.path)
        )
        tuning = Tuning(judged, spec, limits)
        # Cases of a benchmark name no files, and may be others in another release.
        if not spec.development.scenarios and self.digest_of_cases(tuning) != self.campaign_digest:
            raise DdctError(
                'a scenario, profile or handover file of its cases has changed since: put the old '
                'one back',
                key='campaign_digest',
                place=tuning.spec.folder,
            )
        return tuning

    def digest_of_cases(self, tuning: Tuning) -> str:
        """Return the present `campaign_digest`, of a tuning whose files may have been moved."""
        spec = tuning.campaign.spec
        # The specification has the path of the controller's file, which counts as recorded.
        recorded = {**spec.content, CONTROLLERS: [self._judged().path]}
        return digest_of(replace(spec, content=recorded))

    def _judged(self, folder: Path | None = None) -> Judged:
        """Return the controller; its file is in `folder` if it was moved."""
        return Judged(
            self.controller['name'],
            self.controller['chosen'],
            folder or Path(self.controller['folder']),
            self.controller['digests'],
        )

    def require_same(self, other: 'TuningManifest', out: Path) -> None:
        """Raise DdctError with the first difference of another tuning from this one, in `out`."""
        require_same_inputs(asdict(self), asdict(other), _DIFFERENCES, 'tuning', out)


_DIFFERENCES = {
    'schema_version': 'of another version',
    'version': 'of another release',
    'code_digest': 'of another release: its code is another one',
    'optuna': 'with another version of Optuna',
    'limits': 'by other limits',
    'controller': 'of another controller, or its file has changed since',
    'spec': 'with another specification',
    'campaign_digest': 'with other cases: a file of them has changed since',
}
"""Meaning of another value of each key of the manifest, in the order of the checks."""
