"""`manifest.json`: what a campaign is, so that it can go on and its rows can be made again."""

import json
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

from ddct_bringup.campaign.code import code_digest
from ddct_bringup.campaign.runs import Campaign
from ddct_bringup.campaign.shards import shard_size
from ddct_bringup.campaign.spec import CampaignSpec, spec_of
from ddct_bringup.run.source_commit import short_commit, source_commit
from ddct_bringup.verdict.limits import Limits
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.files.input_file import read_text_file, require_schema_version
from ddct_plant.files.json_text import parse_json
from ddct_plant.files.output_file import write_json
from ddct_plant.program.command_line import package_version

MANIFEST = 'manifest.json'
SCHEMA_VERSION = 1
"""Of the manifest."""


@dataclass(frozen=True)
class Manifest:
    """What a campaign was started with."""

    schema_version: int
    root_seed: int
    version: str
    """Of the packages."""
    commit: str
    """As in `run_info`."""
    code_digest: str
    spec_digest: str
    """Of the specification and the files that it names."""
    limits: dict[str, Any]
    """`name`, `digest` and `schema_version` of what the runs are judged by."""
    runs: int
    shard_size: int
    folder: str
    """What files of the specification are relative to."""
    spec: dict[str, Any]

    @classmethod
    def of(cls, campaign: Campaign, limits: Limits) -> 'Manifest':
        """Describe a campaign that this program computes."""
        return cls(
            schema_version=SCHEMA_VERSION,
            root_seed=campaign.spec.root,
            version=package_version(),
            commit=source_commit(),
            code_digest=code_digest(),
            spec_digest=campaign.digest(),
            limits=dict(limits.origin),
            runs=campaign.runs,
            shard_size=shard_size(campaign.runs),
            folder=str(campaign.spec.folder),
            spec=dict(campaign.spec.content),
        )

    @classmethod
    def read(cls, out: Path) -> 'Manifest':
        """Read the manifest in a campaign's folder; raise DdctError without a good one."""
        path = out / MANIFEST
        try:
            content = parse_json(read_text_file(path))
            require_schema_version(content, SCHEMA_VERSION)
            return cls(**{field.name: content[field.name] for field in fields(cls)})
        except FileNotFoundError as error:
            raise DdctError(
                f'{out}: no {MANIFEST} in it: give the folder of a campaign'
            ) from error
        except (OSError, ParameterError, LookupError, TypeError, AttributeError) as error:
            raise DdctError(f'{path}: cannot be read ({error})') from error

    def write(self, out: Path) -> None:
        """Write it into a campaign's folder; raise DdctError when that fails."""
        write_json(str(out / MANIFEST), asdict(self))

    def campaign_spec(self) -> CampaignSpec:
        """Return the specification of the campaign."""
        return spec_of(self.spec, Path(self.folder))

    def require_same(self, other: 'Manifest', out: Path) -> None:
        """Raise DdctError that says what of another campaign is not as in this one, in `out`."""
        for what, ours, theirs in (
            ('root seed', str(self.root_seed), str(other.root_seed)),
            ('code', self.code, other.code),
            ('specification', self.spec_digest[:10], other.spec_digest[:10]),
            ('limits', json.dumps(self.limits), json.dumps(other.limits)),
        ):
            if ours != theirs:
                raise DdctError(
                    f'{out} holds a campaign of another {what}, {ours}, not {theirs}: go on with '
                    'that one, or choose another --out'
                )

    def require_limits(self, limits: Limits, out: Path) -> None:
        """Raise DdctError unless runs are judged by the limits of this campaign, in `out`."""
        if self.limits != limits.origin:
            raise DdctError(
                f'{out}: its runs were judged by the limits {json.dumps(self.limits)}, not by '
                f'{json.dumps(limits.origin)}: give --limits with that file'
            )

    @property
    def code(self) -> str:
        """The commit, and what tells two dirty ones apart."""
        return f'{short_commit(self.commit)} ({self.code_digest[:10]})'
