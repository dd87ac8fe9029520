"""Whether a run that is made again has the figures of its row."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ddct_bringup.campaign.columns import COMPARED, PATH
from ddct_bringup.campaign.manifest import Manifest
from ddct_bringup.campaign.rows import SERIAL
from ddct_bringup.campaign.runs import Campaign
from ddct_plant.base.errors import DdctError

VECTORISED_RTOL = 1e-9
"""What a row of the vectorised path may differ by, relative to the larger value."""


def campaign_in(folder: Path, manifest: Manifest) -> Campaign:
    """
    Return the campaign that a folder's manifest describes.

    Raise DdctError where a file that it names has changed since.
    """
    campaign = Campaign(manifest.campaign_spec())
    if campaign.digest() != manifest.spec_digest:
        raise DdctError(
            f'{folder}: a scenario, profile or controller file of its specification has changed '
            'since: put the old one back'
        )
    return campaign


def differences(row: Mapping[str, Any], again: Mapping[str, Any]) -> list[str]:
    """
    Return in words what of a run that was made again is not what its row says.

    Every metric, criterion and word of the verdict counts: of a serial row to the last bit.
    """
    rtol = 0.0 if row[PATH] == SERIAL else VECTORISED_RTOL
    return [
        f'{name} is {again[name]!r}, in the row {row[name]!r}'
        for name in COMPARED
        if not _same(row[name], again[name], rtol)
    ]


def _same(ours: Any, theirs: Any, rtol: float) -> bool:
    if isinstance(ours, float) and isinstance(theirs, (int, float)):
        return math.isclose(ours, theirs, rel_tol=rtol)
    return ours == theirs
