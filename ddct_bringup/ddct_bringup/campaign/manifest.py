# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`manifest.json`: the inputs of a campaign, used to resume it and to repeat its rows."""

import json
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.shard_size import shard_size_of
from ddct_bringup.campaign.spec import CampaignSpec, spec_of
from ddct_bringup.campaign.specification.named_files import digest_of
from ddct_bringup.digests.code import code_digest
from ddct_bringup.digests.manifests import manifest_content
from ddct_bringup.digests.origin import CodeOrigin
from ddct_bringup.verdict.limits import Limits
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.files.json_records import write_json

MANIFEST = 'manifest.json'
SCHEMA_VERSION = 1
"""Schema version of the manifest."""
MOST_ROWS = 10_000_000
"""Most runs of a campaign that is read; a million take an hour on many cores."""
_TEXTS = ('version', 'commit', 'code_digest', 'spec_digest', 'folder')
"""Keys of texts."""
_NUMBERS = (
    ('root_seed', 0, 2**31 - 1),
    ('runs', 1, MOST_ROWS),
    ('shard_size', 1, MOST_ROWS),
)
"""Keys of whole numbers, with the least and the most."""


@dataclass(frozen=True)
class Manifest:
    """Inputs of a campaign: versions, seed, specification and limits."""

    schema_version: int
    root_seed: int
    version: str
    """Version of the packages."""
    commit: str
    """Commit of the sources, as in `run_info`."""
    code_digest: str
    spec_digest: str
    """Digest of the specification and of the files that it names."""
    limits: dict[str, Any]
    """Name, digest and schema version of the limits by which the runs are judged."""
    runs: int
    shard_size: int
    """Number of runs in a shard; it depends only on the specification."""
    folder: str
    """Folder that files of the specification are relative to."""
    spec: dict[str, Any]

    @classmethod
    def of(cls, campaign: Campaign, limits: Limits) -> 'Manifest':
        """Return the manifest of a campaign that this version of the program computes."""
        here = CodeOrigin.here()
        return cls(
            schema_version=SCHEMA_VERSION,
            root_seed=campaign.spec.root,
            version=here.version,
            commit=here.commit,
            code_digest=here.code,
            spec_digest=campaign.digest(),
            limits=dict(limits.origin),
            runs=campaign.runs,
            shard_size=shard_size_of(campaign),
            folder=str(campaign.spec.folder),
            spec=dict(campaign.spec.content),
        )

    @classmethod
    def read(cls, out: Path) -> 'Manifest':
        """Return the manifest in a campaign's folder; raise DdctError without a valid one."""
        with manifest_content(out / MANIFEST, SCHEMA_VERSION, 'campaign') as content:
            manifest = cls(**{field.name: content[field.name] for field in fields(cls)})
            manifest._require_types()
            return manifest

    def _require_types(self) -> None:
        """Raise ParameterError for a value of another type, or beyond the bounds of campaigns."""
        for name in _TEXTS:
            if not isinstance(getattr(self, name), str):
                raise ParameterError(f'{name} is no text', key=name)
        for name, least, most in _NUMBERS:
            value = getattr(self, name)
            if type(value) is not int or not least <= value <= most:
                raise ParameterError(f'{name} is {value!r}, not {least} to {most}', key=name)
        _require_group('limits', self.limits)
        _require_group('spec', self.spec)
        _require_group('spec.grid', self.spec.get('grid') or {})
        random = self.spec.get('random') or {}
        _require_group('spec.random', random)
        _require_group('spec.random.vary', random.get('vary') or {})

    def write(self, out: Path) -> None:
        """Write the manifest to a campaign's folder; raise DdctError when that fails."""
        write_json(str(out / MANIFEST), asdict(self), ours=True)

    @property
    def grid(self) -> tuple[str, ...]:
        """Keys varied on a grid, also in a manifest of a version with other keys."""
        return _keys(self.spec.get('grid'))

    @property
    def random(self) -> tuple[str, ...]:
        """Keys drawn at random, also in a manifest of a version with other keys."""
        return _keys((self.spec.get('random') or {}).get('vary'))

    def campaign_spec(self, folder: Path | None = None) -> CampaignSpec:
        """Return the specification; its files are in `folder` if they were moved."""
        return spec_of(self.spec, folder or Path(self.folder))

    def campaign(self, out: Path, folder: Path | None = None) -> Campaign:
        """
        Return the campaign in `out`; the files that it names are in `folder` if they were moved.

        Raise DdctError where one of them has changed, or where the manifest was edited.
        """
        spec = self.campaign_spec(folder)
        if digest_of(spec) != self.spec_digest:  # first: making the campaign runs Python files
            raise DdctError(
                f'{out}: a scenario, profile, controller or handover file of its specification '
                'has changed since: put the old one back'
            )
        campaign = Campaign(spec)
        self._require_given('runs', campaign.runs, out)
        return campaign

    def require_same(self, other: 'Manifest', out: Path) -> None:
        """Raise DdctError with the differences of another campaign from this one, in `out`."""
        for what, ours, theirs in (
            ('root seed', str(self.root_seed), str(other.root_seed)),
            ('code', self.origin.short, other.origin.short),
            ('specification', self.spec_digest[:10], other.spec_digest[:10]),
            ('limits', json.dumps(self.limits), json.dumps(other.limits)),
        ):
            if ours != theirs:
                raise DdctError(
                    f'{out} holds a campaign of another {what}, {ours}, not {theirs}: go on with '
                    'that one, or choose another --out',
                    key=what,
                )
        for key in ('runs', 'shard_size', 'spec'):
            self._require_given(key, getattr(other, key), out)

    def _require_given(self, key: str, given: object, out: Path) -> None:
        """Raise DdctError unless a value is the one that the specification gives."""
        value, expected = json.dumps(getattr(self, key)), json.dumps(given)
        if value != expected:
            raise DdctError(
                f'{key} is {value}, but the specification gives {expected}: put the original '
                'back, or start the campaign anew in another --out',
                key=key,
                place=out / MANIFEST,
            )

    def require_limits(self, limits: Limits, out: Path) -> None:
        """Raise DdctError unless the limits are those of this campaign, in `out`."""
        if self.limits != limits.origin:
            raise DdctError(
                f'{out}: its runs were judged by the limits {json.dumps(self.limits)}, not by '
                f'{json.dumps(limits.origin)}: give --limits with that file'
            )

    @property
    def origin(self) -> CodeOrigin:
        """Code that computes the rows."""
        return CodeOrigin(self.version, self.commit, self.code_digest)


def _require_group(key: str, value: object) -> None:
    if not isinstance(value, dict):
        raise ParameterError(f'{key} is no group of keys', key=key)


def _keys(group: Any) -> tuple[str, ...]:
    """Return the keys of an optional part of a specification."""
    return tuple(group or ())


def require_code(digest: str) -> None:
    """Raise DdctError unless this process has the sources of the campaign's start."""
    if code_digest() != digest:
        raise DdctError(
            'a worker has other sources than the program that started the campaign: install the '
            'same version there'
        )
