# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Every reader gets damaged inputs, first at random, then guided by the code reached.

What a reader fails on is kept in tests/formats/found_inputs, where the suite tries it. Guided runs
begin with the inputs by which earlier ones have reached new code, in .fuzz_cache.
"""

import argparse
import subprocess
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path

from fuzz.loop import FOUND, fuzz
from fuzz.readers import readers


def main() -> int:
    """Run the program; the exit code is 1 after a finding."""
    parser = argparse.ArgumentParser(prog='tools/run fuzz', description=__doc__)
    parser.add_argument('readers', nargs='*', help='names of readers; all if none is given')
    parser.add_argument('--seconds', type=float, default=20.0, help='for each reader and way')
    parser.add_argument('--seed', type=int, default=0)
    options = parser.parse_args()
    guide = find_spec('atheris') is not None
    if not guide:
        print('tools/run fuzz: atheris is not installed: inputs are random alone', file=sys.stderr)
    findings = 0
    with tempfile.TemporaryDirectory(prefix='fuzz-') as name:
        known = readers(Path(name))
        if unknown := [each for each in options.readers if each not in known]:
            parser.error(f'no reader {unknown[0]}: choose from {", ".join(known)}')
        for reader in options.readers or known:
            work, kept = Path(name) / 'work', FOUND / reader
            inputs, found = fuzz(known[reader], options.seconds, options.seed, work, kept)
            guided, more = _guided(reader, options.seconds, options.seed) if guide else (0, 0)
            print(f'{reader}: {inputs} + {guided} inputs, {found + more} findings', flush=True)
            findings += found + more
    return 1 if findings else 0


def _guided(reader: str, seconds: float, seed: int) -> tuple[int, int]:
    """Return the numbers of inputs and findings of a process that is guided by coverage."""
    # It ends without leaving its Python code, so that it cannot remove a folder itself.
    with tempfile.TemporaryDirectory(prefix=f'fuzz-{reader}-') as folder:
        command = [sys.executable, '-P', '-m', 'fuzz.guided', reader, str(seconds), str(seed)]
        done = subprocess.run([*command, folder], capture_output=True, text=True, check=False)
    counts = [line for line in done.stderr.splitlines() if line.startswith(('Done', '#'))]
    inputs = int(counts[-1].lstrip('#Done ').split()[0]) if counts else 0
    if done.returncode:
        print(done.stderr[-3000:], flush=True)
    return inputs, int(done.returncode != 0)


if __name__ == '__main__':
    raise SystemExit(main())
