# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Verify one folder: its files first, then its runs; the result as JSON."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from ddct_bringup.digests.digest_file import DIGESTS
from ddct_bringup.digests.environment import this_environment
from ddct_bringup.digests.files import SAME, UNLISTED, FileState, file_states
from ddct_bringup.run.output_folder import PARTIAL
from ddct_bringup.verification.comparison import BOUND, DIGEST_ONLY
from ddct_bringup.verification.kinds import KINDS
from ddct_bringup.verification.request import VerificationRequest
from ddct_bringup.verification.result import RepetitionResult
from ddct_plant.base.errors import DdctError

BY_DIGEST = frozenset({'report.html', 'timing.json'})
"""Names of files that no run gives again: pages, times on the wall clock."""


@dataclass(frozen=True)
class Verification:
    """Result of one folder."""

    request: VerificationRequest
    files: Sequence[FileState]
    runs: Sequence[RepetitionResult]
    """Results of the runs; none where a file was not the same, so that nothing was repeated."""
    error: str = ''
    """Reason why the runs could not be repeated; empty in general."""

    @property
    def same(self) -> bool:
        """Whether every file, and every run that can be repeated, is the same."""
        return (
            not self.error
            and all(file.state == SAME for file in self.files)
            and all(run.same for run in self.runs)
        )

    @property
    def intact(self) -> bool:
        """Whether every listed file is the same, so that the runs were repeated."""
        return all(file.state in (SAME, UNLISTED) for file in self.files)

    @property
    def repeated(self) -> bool:
        """Whether at least one result was computed again."""
        return not all(run.state == DIGEST_ONLY for run in self.runs)

    @property
    def by_digest(self) -> list[str]:
        """Kinds of files that no run gives again, so that their digests alone are checked."""
        names = {Path(file.path).name for file in self.files if file.state == SAME}
        return sorted(names & BY_DIGEST)


def folders_with_digests(path: Path) -> list[Path]:
    """
    Return the folder at `path` if it has digests, else those below it, without those in others.

    Raise DdctError where there is none.
    """
    if not path.exists():
        raise DdctError(f'{path}: no such file or folder')
    if not path.is_dir():
        raise DdctError(f'{path} is a file: give the folder that it is in')
    found = [file.parent for file in sorted(path.rglob(DIGESTS))]
    top = [each for each in found if not any(other in each.parents for other in found)]
    if not top:
        interrupted = path.resolve().name.endswith(PARTIAL)
        why = (
            'an interrupted run left this folder'
            if interrupted
            else 'it was recorded before results had digests, or they were lost'
        )
        raise DdctError(f'{path}: no {DIGESTS} in it or below it: {why}: make the result again')
    return top


def verified_folder(request: VerificationRequest) -> Verification:
    """Compare the files of a folder with their digests, then repeat its runs."""
    files = file_states(request.folder, request.digests)
    found = Verification(request, files, ())
    if not found.intact:
        return found
    repeat = KINDS.get(request.digests.kind)
    if repeat is None:
        error = f'this version cannot verify a folder of the kind {request.digests.kind!r}'
        return Verification(request, files, (), error)
    runs: list[RepetitionResult] = []
    try:
        runs.extend(repeat(request))
    except DdctError as error:
        return Verification(request, files, runs, str(error))
    return Verification(request, files, runs)


def entry_of(found: Verification) -> Mapping[str, Any]:
    """Return the result of a folder as JSON."""
    environment = found.request.digests.environment
    return {
        'folder': str(found.request.folder),
        'kind': found.request.digests.kind,
        'same': found.same,
        'error': found.error or None,
        'environment': asdict(environment),
        'environment_here': asdict(this_environment()),
        'environment_differences': found.request.environment_differences,
        'bound': 0.0 if found.request.same_environment else BOUND,
        'files': [asdict(file) for file in found.files],
        'by_digest': found.by_digest,
        'runs': [run.entry() for run in found.runs],
    }
