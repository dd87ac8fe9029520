# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Plan the repetition of a recorded run: its settings and its controller, unchanged."""

import os
from dataclasses import replace
from pathlib import Path

from ddct_bringup.bag.recording import Recording
from ddct_bringup.digests.digest_file import RunDigests
from ddct_bringup.digests.user_files import require_same_controller, require_same_handover
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.verification.request import VerificationRequest
from ddct_controllers.from_file.controller_file import is_controller_file
from ddct_plant.base.errors import DdctError


def plan_of(request: VerificationRequest, recording: Recording, digests: RunDigests) -> RunPlan:
    """Return the headless plan of a recorded run; raise DdctError where it cannot be made."""
    settings = recording.settings
    if settings is None:
        raise DdctError('it is the log of another tool, and has no settings to repeat it with')
    if digests.handover is not None:
        settings = replace(settings, handover=_handover_of(request, digests.handover, digests))
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
        chosen = str(_found(request, 'controller', Path(chosen)))
    require_same_controller(chosen, digests.controller_files)
    return chosen


def _handover_of(request: VerificationRequest, named: str, digests: RunDigests) -> str:
    """Return the path of a run's handover file; raise DdctError unless it is the same."""
    file = str(_found(request, 'handover', Path(named)))
    require_same_handover(file, digests.handover_files)  # first: a plan runs the file
    return file


def _found(request: VerificationRequest, what: str, file: Path) -> Path:
    """Return the path of the file of a controller or a handover; raise DdctError if it is gone."""
    places = [Path(os.path.normpath(request.folder / file))]
    if request.files:
        places.insert(0, request.files / file.name)
    for place in places:
        if place.is_file():
            return place
    raise DdctError(
        f'the {what} file {places[0]} is gone: put it back, or name its folder with --files'
    )
