# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Compare the files of a controller with recorded digests, before any of them runs."""

from collections.abc import Mapping

from ddct_controllers.from_file.digests import controller_digests
from ddct_plant.base.errors import DdctError


def require_same_files(chosen: str, recorded: Mapping[str, str]) -> None:
    """Raise DdctError unless the files of a controller have the recorded digests, by their key."""
    files = controller_digests(chosen)
    for key in {**recorded, **files}:
        if files.get(key) != recorded.get(key):
            what = 'has changed since' if key in files else 'is gone'
            raise DdctError(
                f'controller {chosen}: {key.removesuffix("_sha256")} {what}: put the old one '
                'back, or name its folder with --files'
            )
