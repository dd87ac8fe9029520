# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Verify a result: its files first, then everything again, then file against file."""

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from ddct_bringup.manifest.file_states import SAME, UNLISTED, FileState, file_states
from ddct_bringup.manifest.manifest import MANIFEST, Manifest, read_manifest, result_around
from ddct_bringup.manifest.origin import CodeOrigin
from ddct_bringup.run.output_folder import PARTIAL
from ddct_bringup.verification.files import FileComparison
from ddct_bringup.verification.repetition import repeat
from ddct_bringup.verification.result import RepetitionResult
from ddct_bringup.verification.states import DIFFERENT, NOT_REPEATED, SAME_BITS, SAME_WITHIN
from ddct_plant.base.errors import DdctError
from ddct_plant.program.arithmetic import arithmetic


@dataclass(frozen=True)
class Verification:
    """What was found of one result."""

    folder: Path
    manifest: Manifest
    files: Sequence[FileState]
    runs: Sequence[RepetitionResult] = ()
    """What was made again; nothing where a file was not the same."""
    by_digest: Sequence[str] = ()
    """Names of files with times on the wall clock: their digests alone are checked."""
    error: str = ''
    """Reason why the result could not be made again; empty in general."""

    @property
    def same(self) -> bool:
        """Whether nothing differs."""
        return (
            not self.error
            and all(file.state == SAME for file in self.files)
            and all(run.state != DIFFERENT for run in self.runs)
        )

    @property
    def intact(self) -> bool:
        """Whether every listed file is the same, so that the result was made again."""
        return all(file.state in (SAME, UNLISTED) for file in self.files)

    @property
    def state(self) -> str:
        """State of all: different, not repeated in a part, the same within a bound, or in bits."""
        if not self.same:
            return DIFFERENT
        states = {run.state for run in self.runs}
        order = (NOT_REPEATED, SAME_WITHIN)
        return next((each for each in order if each in states), SAME_BITS)

    @cached_property
    def environment_differences(self) -> list[str]:
        """Differences of code, libraries and versions from those here, as text."""
        return _differences(self.manifest)


def results_in(path: Path) -> list[Path]:
    """
    Return the folder at `path` if it is that of a result, else those below it.

    Raise DdctError where there is none.
    """
    if not path.exists():
        raise DdctError(f'{path}: no such file or folder')
    if not path.is_dir():
        raise DdctError(f'{path} is a file: give the folder that it is in')
    found = [file.parent for file in sorted(path.rglob(MANIFEST))]
    top = [each for each in found if not any(other in each.parents for other in found)]
    if not top:
        if around := result_around(path):
            raise DdctError(f'{path} is a part of the result {around}: give that')
        interrupted = path.resolve().name.endswith(PARTIAL)
        why = 'an interrupted run left it' if interrupted else 'it is no result, or that was lost'
        raise DdctError(f'{path}: no {MANIFEST} in it or below it: {why}: make the result again')
    return top


def verified(result: Path, workers: int | None = None) -> Verification:
    """
    Compare the files of a result with its manifest, make it again, and compare both.

    `workers` is the number of processes of a campaign, None for one per core. Raise DdctError for
    a damaged manifest, and for a result that is not complete.
    """
    manifest = read_manifest(result)
    if manifest.state != 'done':
        raise DdctError(
            f'{result}: it is not complete: it was interrupted, or still runs: finish it, or make '
            'it again'
        )
    found = Verification(result, manifest, file_states(result, manifest))
    if not found.intact:
        return found
    with tempfile.TemporaryDirectory(prefix='ddct-verify-') as place:
        scratch = Path(place) / 'again'
        scratch.mkdir()
        try:
            repeated = repeat(result, manifest, scratch, workers)
            comparison = FileComparison(
                result,
                scratch,
                manifest,
                repeated,
                not found.environment_differences,
                manifest.origin.code == CodeOrigin.here().code,
            )
            runs = list(comparison.results())
        except DdctError as error:
            text = str(error).replace(f'{scratch}/', '')
            return Verification(result, manifest, found.files, error=f'{result}: {text}')
    return Verification(result, manifest, found.files, runs, sorted(comparison.wall_clock))


def _differences(manifest: Manifest) -> list[str]:
    ours, here = manifest.origin, CodeOrigin.here()
    found = []
    if ours.version != here.version:
        found.append(f'version {ours.version}, here {here.version}')
    if ours.code != here.code:
        found.append(f'code {ours.code[:10]}, here {here.code[:10]}')
    if manifest.arithmetic is None:
        return [*found, 'machines or versions that differ among its parts']
    return found + manifest.arithmetic.differences(arithmetic())
