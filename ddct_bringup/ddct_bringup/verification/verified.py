# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Verify every result below a path, and put what was found into one document."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ddct_bringup.run.output_folder import locked_folders
from ddct_bringup.verification.folder import Verification, entry_of, results_in, verified
from ddct_bringup.verification.states import DIFFERENT, NOT_REPEATED, SAME_BITS, SAME_WITHIN

_WORST = (DIFFERENT, NOT_REPEATED, SAME_WITHIN)


@dataclass(frozen=True)
class VerifiedResults:
    """What was found of each result below a path."""

    results: Sequence[Verification]

    @property
    def state(self) -> str:
        """Worst state of the results."""
        states = {each.state for each in self.results}
        return next((each for each in _WORST if each in states), SAME_BITS)

    @property
    def document(self) -> Mapping[str, Any]:
        """Document of `--json`; with several folders, paths and runs begin with the folder."""
        if len(self.results) == 1:
            return entry_of(self.results[0])
        folders = [dict(entry_of(each)) for each in self.results]
        files, runs = [], []
        for each in folders:
            name = each['folder']
            files += [{**file, 'path': f'{name}/{file["path"]}'} for file in each.pop('files')]
            runs += [{**run, 'run': f'{name}: {run["run"]}'} for run in each.pop('runs')]
        state = self.state
        same = state != DIFFERENT
        return {'same': same, 'state': state, 'files': files, 'runs': runs, 'folders': folders}


def verified_results(path: Path, workers: int | None) -> VerifiedResults:
    """Check and repeat every result at or below a path; raise DdctError without any."""
    found = []
    for folder in results_in(path):
        with locked_folders(folder, shared=True):
            found.append(verified(folder, workers))
    return VerifiedResults(found)
