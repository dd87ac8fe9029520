# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Verify every result below a path, and put what was found into one document."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ddct_bringup.run.output_folder import locked_folders
from ddct_bringup.verification.document import (
    FolderDocument,
    FoldersDocument,
    document_of,
    document_of_all,
)
from ddct_bringup.verification.folder import Verification, results_in, verified
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
    def document(self) -> FolderDocument | FoldersDocument:
        """Document of `--json`."""
        if len(self.results) == 1:
            return document_of(self.results[0])
        return document_of_all(self.results, self.state, same=self.state != DIFFERENT)


def verified_results(path: Path, workers: int | None) -> VerifiedResults:
    """Check and repeat every result at or below a path; raise DdctError without any."""
    found = []
    for folder in results_in(path):
        with locked_folders(folder, shared=True):
            found.append(verified(folder, workers))
    return VerifiedResults(found)
