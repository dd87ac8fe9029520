# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The limits by which the runs of a result are judged, in its manifest."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from ddct_bringup.manifest.inputs import INPUTS, InputFiles
from ddct_bringup.verdict.limits import Limits, load_limits
from ddct_plant.base.errors import DdctError

_FOLDER = 'limits'


@dataclass(frozen=True)
class NamedLimits:
    """Limits of a result: their origin, and their file."""

    origin: Mapping[str, str | int]
    """Name, digest and schema version, as in `scores.json`."""
    file: str | None
    """Place of a file of the user in the inputs; None for the packaged limits."""

    @classmethod
    def of(cls, limits: Limits, inputs: InputFiles) -> 'NamedLimits':
        """Return the limits of a result, and take a file of the user into its `inputs`."""
        place = f'{_FOLDER}/{limits.origin["name"]}'
        return cls(
            dict(limits.origin), inputs.add_text(place, limits.text) if limits.text else None
        )

    def load(self, result: Path) -> Limits:
        """Return the limits; raise DdctError where this version reads others, or none."""
        limits = load_limits(result / INPUTS / self.file if self.file else None)
        if limits.origin != self.origin:
            raise DdctError(
                f'its limits are {self.origin}, but here they are {limits.origin}: take the '
                'version that computed it',
                key='limits.origin',
                place=result,
            )
        return limits
