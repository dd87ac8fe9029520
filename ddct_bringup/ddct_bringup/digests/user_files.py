# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Compare files of a controller or a handover with recorded digests, before any of them runs."""

from collections.abc import Mapping

from ddct_controllers.from_file.digests import controller_digests, handover_digests
from ddct_plant.base.errors import DdctError


def require_same_controller(chosen: str, recorded: Mapping[str, str]) -> None:
    """Raise DdctError unless the files of a controller have the recorded digests, by their key."""
    _require_same(f'controller {chosen}', controller_digests(chosen), recorded)


def require_same_handover(file: str, recorded: Mapping[str, str]) -> None:
    """Raise DdctError unless the files of a handover have the recorded digests, by their key."""
    _require_same(f'handover {file}', handover_digests(file), recorded)


def _require_same(what: str, files: Mapping[str, str], recorded: Mapping[str, str]) -> None:
    for key in {**recorded, **files}:
        if files.get(key) != recorded.get(key):
            how = 'has changed since' if key in files else 'is gone'
            raise DdctError(
                f'{what}: {key.removesuffix("_sha256")} {how}: put the old one back, or name its '
                'folder with --files'
            )
