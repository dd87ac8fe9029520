# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Plan the repetition of a recorded run: its settings and its controller, unchanged."""

import os
from collections.abc import Mapping
from pathlib import Path

from ddct_bringup.bag.recording import Recording
from ddct_bringup.digests.digest_file import RunDigests
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.verification.request import VerificationRequest
from ddct_controllers.from_file.controller_file import (
    FILE_DIGEST,
    is_controller_file,
    text_digest,
)
from ddct_controllers.registry import controller_spec
from ddct_plant.base.errors import DdctError
from ddct_plant.files.input_file import user_text


def plan_of(request: VerificationRequest, recording: Recording, digests: RunDigests) -> RunPlan:
    """Return the headless plan of a recorded run; raise DdctError where it cannot be made."""
    settings = recording.settings
    if settings is None:
        version = recording.custom_data.get('version', 'unknown')
        raise DdctError(
            f'this version cannot build its settings; it was recorded by version {version}: '
            'verify it with that one'
        )
    plan = RunPlan(settings, controller_of(request, digests), 'headless')
    if plan.name != recording.facts.controller:
        raise DdctError(
            f'its controller is {recording.facts.controller}, its digests are of {plan.name}'
        )
    return plan


def controller_of(request: VerificationRequest, digests: RunDigests) -> str:
    """Return the name or the file of a run's controller; raise DdctError unless it is the same."""
    chosen = digests.controller
    if chosen is None:
        raise DdctError(
            'its controller was an object of a Python program, and cannot be made again: record '
            'it with a controller file'
        )
    if is_controller_file(chosen):
        file = _found(request, Path(chosen))
        chosen = str(file)
        recorded = {FILE_DIGEST: digests.controller_files.get(FILE_DIGEST, '')}
        # First: what is written in a Python file runs when it is loaded.
        _require_same(chosen, recorded, {FILE_DIGEST: text_digest(user_text(file))})
    _require_same(chosen, digests.controller_files, dict(controller_spec(chosen).digests))
    return chosen


def _require_same(chosen: str, recorded: Mapping[str, str], files: Mapping[str, str]) -> None:
    """Raise DdctError unless the files of a controller have the recorded digests."""
    for key, digest in recorded.items():
        if files.get(key) != digest:
            what = 'has changed since' if key in files else 'is gone'
            raise DdctError(
                f'controller {chosen}: {key.removesuffix("_sha256")} {what}: put the old one '
                'back, or name its folder with --files'
            )


def _found(request: VerificationRequest, file: Path) -> Path:
    """Return the path of a controller file; raise DdctError where it is gone."""
    places = [Path(os.path.normpath(request.folder / file))]
    if request.files:
        places.insert(0, request.files / file.name)
    for place in places:
        if place.is_file():
            return place
    raise DdctError(
        f'the controller file {places[0]} is gone: put it back, or name its folder with --files'
    )
