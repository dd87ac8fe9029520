# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
`make faults`: every fault of the campaign on the real graph, beside its stated outcome.

    make faults                              all cases, some twenty minutes on an idle machine
    make faults CASES='killed lockstep'      those with all of these words in their names
    make faults JSON=docs/examples/faults.json   renews the records of these cases for the page

The exit code is 1 if a case does not end as stated.
"""

import argparse
import tempfile
from collections.abc import Sequence
from pathlib import Path

from faults.campaign.all_cases import all_cases
from faults.campaign.case import MOST_TRIES, Case
from faults.campaign.leftovers import Leftovers, isolated
from faults.campaign.outcome import Observed
from faults.campaign.records import read_records, record_of, write_records
from support.fewer_warnings import quiet_logs


def attempt(case: Case) -> tuple[bool, Observed]:
    """Try a case in a folder of its own; return whether it ended as stated, and what was seen."""
    with tempfile.TemporaryDirectory(prefix='faults-') as name, isolated():
        folder = Path(name) / 'run'
        folder.mkdir()
        try:
            seen = case.attempt(case, folder)
        except Exception as error:  # a finding as any other: the campaign goes on
            seen = Observed(error=f'traceback: {error!r}')
        seen.left += Leftovers().found() if not seen.left else []
    return case.met(seen), seen


def attempt_in_time(case: Case) -> tuple[bool, Observed, int]:
    """Try a case until the machine was quick enough for it; return the number of tries too."""
    as_stated, seen, tries = *attempt(case), 1
    while not as_stated and case.came_too_late(seen) and tries < MOST_TRIES:
        as_stated, seen = attempt(case)
        tries += 1
    return as_stated, seen, tries


def chosen(words: Sequence[str]) -> list[Case]:
    """Return the cases whose names have all of these words."""
    return [case for case in all_cases() if all(word in case.name for word in words)]


def main() -> int:
    """Run the program; the exit code is 1 when a case did not end as stated."""
    parser = argparse.ArgumentParser(
        prog='make faults',
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument('words', nargs='*', help='words that the names of cases must have')
    parser.add_argument('--json', type=Path, help='file whose records of these cases are replaced')
    parser.add_argument(
        '--missing', action='store_true', help='only cases that the file has no record of'
    )
    parser.add_argument('--list', action='store_true', help='print the names of the cases alone')
    options = parser.parse_args()
    cases = chosen(options.words)
    if options.list:
        print('\n'.join(case.name for case in cases))
        return 0
    if not cases:
        parser.error(f'no case has the words {" ".join(options.words)} in its name')
    records = read_records(options.json) if options.json else {}
    if options.missing:
        cases = [case for case in cases if not records.get(case.name, {}).get('tries')]
    misses = 0
    for number, case in enumerate(cases, 1):
        with quiet_logs():
            as_stated, seen, tries = attempt_in_time(case)
        misses += not as_stated
        word = 'ok  ' if as_stated else 'MISS'
        print(f'{number}/{len(cases)} {word} {case.name}: {seen.summary()}', flush=True)
        records[case.name] = record_of(case, seen, as_stated, tries)
        if options.json:
            write_records(options.json, records, all_cases())
    print(f'{len(cases) - misses} of {len(cases)} cases ended as stated')
    return 1 if misses else 0


if __name__ == '__main__':
    raise SystemExit(main())
