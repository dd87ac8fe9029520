# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Whether a folder is free for a result, or holds one that was begun and goes on."""

from pathlib import Path

from ddct_bringup.manifest.inputs import INPUTS
from ddct_bringup.manifest.manifest import MANIFEST, Manifest, read_manifest
from ddct_bringup.run.output_folder import MARKER, require_ours_or_empty
from ddct_plant.base.errors import DdctError


def begun_manifest(
    out: Path, kind: str, parts: str, *, resume: bool | None = None
) -> Manifest | None:
    """
    Return the manifest of a result that was begun in a folder, None for a folder that is free.

    `kind` is what the result is in words, `parts` the folder in it that a start which was killed
    may have left. With `resume` there must be a result, without there must be none; None takes
    both. Raise DdctError for a folder that holds something else.
    """
    require_ours_or_empty(out)
    if (out / MANIFEST).exists():
        if resume is False:
            raise DdctError(
                f'{out} holds a {kind}: go on with --resume, or choose another --out',
                key='--resume',
            )
        return read_manifest(out)
    if resume:
        raise DdctError('there is nothing to go on with: leave --resume out', place=out)
    if out.is_dir() and {each.name for each in out.iterdir()} - {MARKER, INPUTS, parts}:
        raise DdctError(f'{out} holds other results: choose another --out', key='--out')
    return None
