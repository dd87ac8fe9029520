# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Write and keep the digests of the folders that programs commit."""

import os
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path

from ddct_bringup.digests.digest_file import (
    CAMPAIGN,
    DIGESTS,
    RUNS,
    SCHEMA_VERSION,
    Digests,
    RunDigests,
    file_digest,
    read_digests,
)
from ddct_bringup.digests.environment import this_environment
from ddct_bringup.digests.files import digests_of_files, files_in
from ddct_bringup.run.output_folder import is_ours
from ddct_bringup.run.plan import RunPlan
from ddct_controllers.from_file.controller_file import is_controller_file
from ddct_controllers.from_file.digests import handover_digests
from ddct_controllers.registry import controller_spec
from ddct_plant.scenario.file import scenario_digest
from ddct_plant.scenario.settings import is_handover_file

ITSELF = '.'
"""Name of the bag of a run's own folder."""


def write_run_digests(folder: Path, plans: Mapping[str, RunPlan]) -> None:
    """
    Write the digests of a folder of runs, by the names of their bags.

    A folder that gets another name beside this one later has the same digests. Raise DdctError
    when a file cannot be read or written.
    """
    runs = {name: _run_digests(folder, plan) for name, plan in plans.items()}
    files = digests_of_files(folder)
    Digests(SCHEMA_VERSION, RUNS, files, this_environment(), runs).write(folder)


def begin_campaign_digests(
    folder: Path, shards: str, *, one_machine: bool, kind: str = CAMPAIGN
) -> Digests:
    """
    Write the digests of a campaign, or another `kind`, that begins or is resumed; return them.

    Those of its files in the folder `shards` stay as they were when each was written. The kind of
    processor is that of this one only if all rows are computed on `one_machine` and none before on
    another. Raise DdctError when the file cannot be read or written.
    """
    here = this_environment()
    known = read_digests(folder) if (folder / DIGESTS).exists() else None
    resumed = any((folder / shards).glob('*'))
    if not one_machine or (resumed and (known is None or known.environment != here)):
        here = replace(here, processor=None)
    files = {
        name: file_digest(path)
        for name, path in files_in(folder).items()
        if not name.startswith(f'{shards}/')
    }
    digests = Digests(SCHEMA_VERSION, kind, dict(known.files) if known else {}, here)
    digests = digests.with_files(files)
    digests.write(folder)
    return digests


def finish_campaign_digests(folder: Path) -> None:
    """Add the files of a finished campaign to its digests; raise DdctError when that fails."""
    read_digests(folder).with_files(digests_of_files(folder)).write(folder)


def write_folder_digests(folder: Path, kind: str) -> None:
    """
    Write the digests of a folder with folders of results in it.

    The kind of processor is that of this one only if it is that of all of these. Raise DdctError
    when a file cannot be read or written.
    """
    here = this_environment()
    inner = [read_digests(file.parent).environment for file in folder.glob(f'*/**/{DIGESTS}')]
    if any(each != here for each in inner):
        here = replace(here, processor=None)
    Digests(SCHEMA_VERSION, kind, digests_of_files(folder), here).write(folder)


def keep_digests(paths: Iterable[Path | str]) -> None:
    """
    Renew the digests of files that a program has written, in the folders of results around them.

    Files elsewhere have none. Raise DdctError when a file cannot be read or written.
    """
    for path in paths:
        file = Path(os.path.realpath(path))
        changed = [file]
        for folder in file.parents:
            if is_ours(folder) and (folder / DIGESTS).is_file():
                names = {each.relative_to(folder).as_posix(): each for each in changed}
                files = {name: file_digest(each) for name, each in names.items()}
                read_digests(folder).with_files(files).write(folder)
                changed.append(folder / DIGESTS)


def _run_digests(folder: Path, plan: RunPlan) -> RunDigests:
    spec, chosen = controller_spec(plan.controller), None
    if isinstance(plan.controller, str):
        is_file = is_controller_file(plan.controller)
        chosen = os.path.relpath(plan.controller, folder) if is_file else plan.controller
    digests = RunDigests(scenario_digest(plan.settings.scenario), chosen, dict(spec.digests))
    handover = plan.settings.handover
    if not is_handover_file(handover):
        return digests
    place = os.path.relpath(handover, folder)
    return replace(digests, handover=place, handover_files=handover_digests(handover))
