# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Our cost over that of a reference, measured in turn; less is better.

    tools/run bench                             beside peers
    tools/run bench --base HEAD~5               beside peers, and commands beside those of a commit
    tools/run bench graph headless --rounds 3   only names with one of these words
"""

import argparse
import json
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path

from bench.batch import BATCH
from bench.commands import GRAPH, beside
from bench.headless import HEADLESS
from bench.predictive import PREDICTIVE
from bench.ratios import HEAD, Comparison, measure
from bench.workspaces import ProgramError, base_workspace


def main() -> None:
    """Measure, print each line when it is there, and write the JSON."""
    parser = argparse.ArgumentParser(
        prog='tools/run bench',
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument('what', nargs='*', metavar='WORD', help='part of a name')
    parser.add_argument('--base', metavar='REV', help='commit to measure beside')
    parser.add_argument('--rounds', type=int, default=5, help='default: 5')
    parser.add_argument('--json', type=Path, help='file of the ratios of all rounds')
    options = parser.parse_args()
    # So that the clean-up takes place.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))
    results = []
    with _comparisons(options.base) as known:
        words = options.what or ['']
        chosen = [each for each in known if any(word in each.name for word in words)]
        if not chosen:
            parser.error(f'no name has {" or ".join(words)}: {", ".join(x.name for x in known)}')
        print(HEAD)
        for comparison in chosen:
            results.append(measure(comparison, max(options.rounds, 1)))
            print(results[-1].line(), flush=True)
    if options.json:
        text = json.dumps([asdict(each) for each in results], indent=1)
        options.json.write_text(f'{text}\n', encoding='utf-8')


@contextmanager
def _comparisons(base: str | None) -> Iterator[list[Comparison]]:
    peers = [*GRAPH, *HEADLESS, *BATCH, *PREDICTIVE]
    if not base:
        yield peers
        return
    with base_workspace(base) as folder:
        yield [*peers, *beside(folder)]


if __name__ == '__main__':
    try:
        main()
    except ProgramError as error:
        sys.exit(f'tools/run bench: {error}')
    except KeyboardInterrupt:
        sys.exit(128 + signal.SIGINT)
