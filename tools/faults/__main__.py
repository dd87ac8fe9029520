# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Every fault of the campaign on the real graph, beside its stated outcome.

    tools/run faults                      all cases, ten minutes on an idle machine
    tools/run faults killed lockstep      those with all of these words in their names

The exit code is 1 if a case does not end as stated.
"""

import argparse
import json
import tempfile
from pathlib import Path
from typing import Any

from faults.all_cases import all_cases
from faults.case import MOST_TRIES, Case
from faults.fewer_warnings import quiet_logs
from faults.leftovers import Leftovers, isolated
from faults.outcome import Observed


def attempt(case: Case) -> tuple[bool, Observed]:
    """Try a case in a folder of its own; return whether it ended as stated, and what it did."""
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


def main() -> int:
    """Run the program; the exit code is 1 when a case did not end as stated."""
    parser = argparse.ArgumentParser(
        prog='tools/run faults',
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument('words', nargs='*', help='words that the names of cases must have')
    parser.add_argument('--json', type=Path, help='file of the outcomes')
    parser.add_argument('--list', action='store_true', help='print the names of the cases alone')
    options = parser.parse_args()
    cases = [case for case in all_cases() if all(word in case.name for word in options.words)]
    if not cases:
        parser.error(f'no case has the words {" ".join(options.words)} in its name')
    if options.list:
        print('\n'.join(case.name for case in cases))
        return 0
    outcomes: list[dict[str, Any]] = []
    for number, case in enumerate(cases, 1):
        with quiet_logs():
            as_stated, seen, tries = attempt_in_time(case)
        word = 'ok  ' if as_stated else 'MISS'
        print(f'{number}/{len(cases)} {word} {case.name}: {seen.summary()}', flush=True)
        outcomes.append(
            {
                'case': case.name,
                'stated': case.stated.text,
                'as_stated': as_stated,
                'outcome': seen.summary(),
                'tries': tries,
            }
        )
    met = sum(each['as_stated'] for each in outcomes)
    print(f'{met} of {len(cases)} cases ended as stated')
    if options.json:
        options.json.write_text(f'{json.dumps(outcomes, indent=1)}\n', encoding='utf-8')
    return int(met < len(cases))


if __name__ == '__main__':
    raise SystemExit(main())
