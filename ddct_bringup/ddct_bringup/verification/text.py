# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A verification as text: the table of its runs, the bound that was used, what is not the same."""

from collections.abc import Iterator

from ddct_bringup.digests.files import SAME
from ddct_bringup.verification.comparison import (
    BOUND,
    DIFFERENT,
    DIGEST_ONLY,
    SAME_BITS,
    SAME_WITHIN,
)
from ddct_bringup.verification.folder import Verification
from ddct_bringup.verification.result import RepetitionResult
from ddct_plant.base.errors import printable
from ddct_plant.program.printed_table import print_note, print_table
from ddct_plant.program.table import Table

_WORDS = {
    SAME_BITS: 'same bits',
    SAME_WITHIN: 'same within',
    DIFFERENT: 'different',
    DIGEST_ONLY: 'digest only',
}
_MOST_FILES = 20
"""Largest number of files that are named on the terminal."""


def print_verification(found: Verification) -> None:
    """Print the runs of a folder as a table, the bound that was used, and whether all is same."""
    folder = printable(found.request.folder)
    if found.runs:
        rows = [(run.run, _word(run), _detail(run)) for run in found.runs]
        print_table(Table(f'{folder}, repeated', ('run', 'state', 'detail'), rows))
    if found.repeated:
        print_note(_bound(found))
        if by_digest := found.by_digest:
            print_note(f'By their digests alone: {", ".join(by_digest)}.')
    if found.same:
        what = 'every run is the same' if found.repeated else 'no run could be repeated'
        print_note(f'{folder}: {len(found.files)} files are as their digests; {what}.')


def complaints(found: Verification) -> Iterator[str]:
    """Yield a line for each file and run that is not the same."""
    folder = found.request.folder
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
        if not run.same:
            yield f'{folder}: {run.run}: {_detail(run)}'


def _word(run: RepetitionResult) -> str:
    """Return the state of a run in words, with its bound where that was needed."""
    return (
        f'{_WORDS[run.state]} {run.bound:.1g}' if run.state == SAME_WITHIN else _WORDS[run.state]
    )


def _bound(found: Verification) -> str:
    request = found.request
    if request.same_environment:
        return 'Code, versions and processor are those of the result: every bit was compared.'
    differences = printable('; '.join(request.environment_differences))
    return (
        f'The result was made with {differences}. Other code or processors may round '
        f'otherwise: the bound is {BOUND:g} of the largest value.{_measured(found)}'
    )


def _measured(found: Verification) -> str:
    runs = [run.run for run in found.runs if run.bound > BOUND]
    if not runs:
        return ''
    names = printable(', '.join(runs))
    return f' These amplify rounding, and have a larger one that was measured: {names}.'


def _detail(run: RepetitionResult) -> str:
    """Return the first difference of a run, and why it was not repeated or its changed gains."""
    return printable('; '.join(filter(None, (_difference(run), run.note))))


def _difference(run: RepetitionResult) -> str:
    if run.first_difference is None:
        return f'at most {run.largest:.2g}' if run.largest else ''
    first = dict(run.first_difference)
    reason = first.pop('reason', '')
    values = [f'{key} {first.pop(key)!r}' for key in ('recorded', 'repeated') if key in first]
    place = ', '.join(f'{key} {value}' for key, value in first.items())
    return ': '.join(filter(None, (place, reason or ', '.join(values))))
