# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Plan of a campaign in the manifest of its result, used to resume it and to repeat its rows."""

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.keys import CONTROLLERS
from ddct_bringup.campaign.shards import shard_size_of
from ddct_bringup.campaign.spec import CampaignSpec, spec_of
from ddct_bringup.campaign.specification.named_files import digest_of, files_of, with_places
from ddct_bringup.manifest.inputs import InputFiles, full_path
from ddct_bringup.manifest.limits import NamedLimits
from ddct_bringup.manifest.manifest import read_manifest, result_around
from ddct_bringup.manifest.origin import CodeOrigin
from ddct_bringup.verdict.limits import Limits
from ddct_controllers.from_file.controller_file import is_controller_file
from ddct_controllers.from_file.digests import controller_files
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.files.json_records import from_json, to_json

MOST_ROWS = 10_000_000
"""Most runs of a campaign that is read; a million take an hour on many cores."""
_NUMBERS = (
    ('root_seed', 0, 2**31 - 1),
    ('runs', 1, MOST_ROWS),
    ('shard_size', 1, MOST_ROWS),
)
"""Keys of whole numbers, with the least and the most."""


@dataclass(frozen=True)
class NoPlan:
    """Plan of a result that is a campaign: it has all of it under `campaigns`."""


@dataclass(frozen=True)
class CampaignPlan:
    """Inputs of a campaign: seed, specification and limits."""

    root_seed: int
    spec_digest: str
    """Digest of the specification and of the files that it names."""
    limits: NamedLimits
    runs: int
    shard_size: int
    """Number of cases in a shard; it depends only on the specification."""
    folder: str
    """Folder in the result that files of the specification are relative to."""
    spec: Mapping[str, Any]

    def __post_init__(self) -> None:
        """Raise ParameterError for a value beyond its bounds, as in an edited file."""
        for name, least, most in _NUMBERS:
            value = getattr(self, name)
            if not least <= value <= most:
                raise ParameterError(f'{name} is {value!r}, not {least} to {most}', key=name)
        random = self.spec.get('random') or {}
        _require_group('spec.grid', self.spec.get('grid') or {})
        _require_group('spec.random', random)
        _require_group('spec.random.vary', random.get('vary') or {})

    @classmethod
    def of(cls, campaign: Campaign, limits: NamedLimits, result: Path) -> 'CampaignPlan':
        """Return the plan of a campaign whose files are in the folder of its result."""
        folder = os.path.relpath(campaign.spec.folder, result)
        return cls(
            root_seed=campaign.spec.root,
            spec_digest=campaign.digest(),
            limits=limits,
            runs=campaign.runs,
            shard_size=shard_size_of(campaign),
            folder='.' if folder.startswith('..') else folder,
            spec=dict(campaign.spec.content),
        )

    @property
    def grid(self) -> tuple[str, ...]:
        """Keys varied on a grid, also in a plan of a version with other keys."""
        return _keys(self.spec.get('grid'))

    @property
    def random(self) -> tuple[str, ...]:
        """Keys drawn at random, also in a plan of a version with other keys."""
        return _keys((self.spec.get('random') or {}).get('vary'))


@dataclass(frozen=True)
class RecordedCampaign:
    """A campaign in a folder, which is that of a result or in it."""

    plan: CampaignPlan
    origin: CodeOrigin
    """Code that computes the rows."""
    result: Path

    @classmethod
    def read(cls, out: Path) -> 'RecordedCampaign':
        """Return the campaign in a folder; raise DdctError without a valid one."""
        result = result_around(out)
        if result is None:
            read_manifest(out)  # raises, or there is one in a folder without our mark
            result = full_path(out)
        manifest = read_manifest(result)
        name = full_path(out).relative_to(result).as_posix()
        if name not in manifest.campaigns:
            raise DdctError('there is no campaign in it: give the folder of one', place=out)
        place = f'{result}, campaign {name}'
        return cls(
            from_json(CampaignPlan, manifest.campaigns[name], place), manifest.origin, result
        )

    def limits(self) -> Limits:
        """Return the limits; raise DdctError where this version has others of that name."""
        return self.plan.limits.load(self.result)

    def campaign_spec(self) -> CampaignSpec:
        """Return the specification, whose files are those in the result."""
        return spec_of(self.plan.spec, self.result / self.plan.folder)

    def campaign(self) -> Campaign:
        """Return the campaign; raise DdctError where one of its files or its plan was edited."""
        spec = self.campaign_spec()
        if digest_of(spec) != self.plan.spec_digest:  # first: making it runs Python files
            raise DdctError(
                'a file that its specification names has changed since: put the old one back',
                place=self.result,
            )
        campaign = Campaign(spec)
        ours = (self.plan.root_seed, self.plan.runs, self.plan.shard_size)
        given = (spec.root, campaign.runs, shard_size_of(campaign))
        for (key, *_), value, expected in zip(_NUMBERS, ours, given, strict=True):
            if value != expected and (key != 'shard_size' or self.origin == CodeOrigin.here()):
                raise _contradiction(key, value, expected, self.result)
        return campaign

    def require_same(self, other: CampaignPlan) -> None:
        """Raise DdctError with the first difference of another campaign from this one."""
        here = CodeOrigin.here()
        ours, theirs = to_json(self.plan), to_json(other)
        for what, mine, given in (
            ('root seed', self.plan.root_seed, other.root_seed),
            ('code', self.origin.short, here.short),
            ('limits', ours['limits']['origin'], theirs['limits']['origin']),
            ('specification', self.plan.spec_digest[:10], other.spec_digest[:10]),
        ):
            if mine != given:
                raise DdctError(
                    f'{self.result} holds a campaign of another {what}, {_text(mine)}, not '
                    f'{_text(given)}: go on with that one, or choose another --out',
                    key=what,
                )
        for key in ours:
            if ours[key] != theirs[key]:
                raise _contradiction(key, ours[key], theirs[key], self.result)


def carried(spec: CampaignSpec, inputs: InputFiles) -> dict[str, Any]:
    """
    Return the content of a specification with the copies of its files, taken as `inputs`.

    Files of its own folder keep their names. Raise DdctError for one that cannot be read.
    """

    def place(key: str, name: str) -> str:
        return inputs.add(files_of(key, spec.folder / name))

    content = with_places(spec.content, place)
    if CONTROLLERS in content:
        content[CONTROLLERS] = [
            inputs.add(controller_files(str(spec.folder / each)))
            if is_controller_file(each)
            else each
            for each in content[CONTROLLERS]
        ]
    return content


def _contradiction(key: str, value: object, expected: object, result: Path) -> DdctError:
    return DdctError(
        f'{key} is {_text(value)}, but the specification gives {_text(expected)}: put the '
        'original back, or start the campaign anew in another --out',
        key=key,
        place=result,
    )


def _text(value: object) -> str:
    return value if isinstance(value, str) else json.dumps(value)


def _require_group(key: str, value: object) -> None:
    if not isinstance(value, dict):
        raise ParameterError(f'{key} is no group of keys', key=key)


def _keys(group: Any) -> tuple[str, ...]:
    """Return the keys of an optional part of a specification."""
    return tuple(group or ())
