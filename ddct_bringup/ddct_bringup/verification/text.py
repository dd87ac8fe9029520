# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A verification as text: a table of what was repeated, and what is not the same."""

from collections.abc import Iterator

from ddct_bringup.manifest.file_states import SAME
from ddct_bringup.verification.folder import Verification
from ddct_bringup.verification.result import RepetitionResult
from ddct_bringup.verification.states import BOUND, DIFFERENT, NOT_REPEATED, SAME_BITS, SAME_WITHIN
from ddct_plant.base.errors import printable
from ddct_plant.program.printed_table import print_table
from ddct_plant.program.table import TextTable

_WORDS = {
    SAME_BITS: 'same bits',
    SAME_WITHIN: f'same within {BOUND:g}',
    DIFFERENT: 'different',
    NOT_REPEATED: 'not repeated',
}
_MOST_FILES = 20
"""Largest number of files that are named on the terminal."""


def print_verification(found: Verification) -> None:
    """Print what was repeated as a table, and what the comparison showed as the last line."""
    folder = printable(found.folder)
    if found.runs:
        rows = [(run.run, _WORDS[run.state], _detail(run)) for run in found.runs]
        print_table(TextTable(f'{folder}, made again', ('what', 'state', 'detail'), rows))
    if found.same:
        # One line, however wide the terminal is, for those who read the last one.
        print(f'{folder}: {len(found.files)} files are as their digests; {_summary(found)}.')


def _summary(found: Verification) -> str:
    """Return what a comparison without a difference showed."""
    within = [run.run for run in found.runs if run.state == SAME_WITHIN]
    left = [f'{run.run} ({run.note})' for run in found.runs if run.state == NOT_REPEATED]
    parts = []
    if found.by_digest:
        parts.append(f'times on the wall clock ({", ".join(found.by_digest)}) by digest alone')
    if found.runs and not within and not left:
        what = 'everything else' if found.by_digest else 'everything'
        parts.append(f'{what} was made again, with equal bits')
    elif any(run.state == SAME_BITS for run in found.runs):
        parts.append('equal bits')
    if within:
        parts.append(f'{", ".join(within)} within {BOUND:g} of each peak')
    if left:
        parts.append(f'not repeated: {", ".join(left)}')
    if cause := '; '.join(found.environment_differences):
        parts.append(f'made with {cause}')
    return printable('; '.join(parts or ['nothing was repeated']))


def complaints(found: Verification) -> Iterator[str]:
    """Yield a line for each file and run that is not the same."""
    folder = found.folder
    wrong = [file for file in found.files if file.state != SAME]
    for file in wrong[:_MOST_FILES]:
        yield f'{folder / file.path}: {file.state}'
    if len(wrong) > _MOST_FILES:
        yield f'{folder}: {len(wrong) - _MOST_FILES} more files differ from their digests'
    if not found.intact:
        yield f'{folder}: nothing was repeated: put the original files back'
    if found.error:
        yield found.error
    for run in found.runs:
        if run.state == DIFFERENT:
            yield f'{folder}: {run.run}: {_detail(run)}'


def _detail(run: RepetitionResult) -> str:
    """Return the first difference of a run, and why it was not repeated or its changed gains."""
    return printable('; '.join(filter(None, (_difference(run), run.note))))


def _difference(run: RepetitionResult) -> str:
    if run.first_difference is None:
        return f'at most {run.largest_difference:.2g}' if run.largest_difference else ''
    first = dict(run.first_difference)
    reason = first.pop('reason', '')
    values = [f'{key} {first.pop(key)!r}' for key in ('recorded', 'repeated') if key in first]
    place = ', '.join(f'{key} {value}' for key, value in first.items())
    return ': '.join(filter(None, (place, reason or ', '.join(values))))
