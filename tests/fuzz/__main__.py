# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`make fuzz`: every reader gets damaged inputs for some seconds, with and without coverage."""

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from fuzz.loop import CORPUS, fuzz
from fuzz.readers import readers


def main() -> int:
    """Run the program; the exit code is 1 after a finding."""
    parser = argparse.ArgumentParser(prog='make fuzz', description=__doc__)
    parser.add_argument('readers', nargs='*', help='names of readers; all if none is given')
    parser.add_argument('--seconds', type=float, default=20.0, help='for each reader and way')
    parser.add_argument('--seed', type=int, default=0)
    parser.add_argument('--guided', action='store_true', help='by coverage, with atheris')
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix='fuzz-') as name:
        known = readers(Path(name))
        if unknown := [each for each in options.readers if each not in known]:
            parser.error(f'no reader {unknown[0]}: choose from {", ".join(known)}')
        findings = 0
        for reader in options.readers or known:
            if options.guided:
                inputs, found = _guided(reader, options.seconds, options.seed)
            else:
                work, kept = Path(name) / 'work', CORPUS / reader
                inputs, found = fuzz(known[reader], options.seconds, options.seed, work, kept)
            print(f'{reader}: {inputs} inputs, {found} findings', flush=True)
            findings += found
    return 1 if findings else 0


def _guided(reader: str, seconds: float, seed: int) -> tuple[int, int]:
    """Return the numbers of inputs and findings of a process that is guided by coverage."""
    # It ends without leaving its Python code, so that it cannot remove a folder itself.
    with tempfile.TemporaryDirectory(prefix=f'fuzz-{reader}-') as folder:
        command = [sys.executable, '-P', '-m', 'fuzz.guided', reader, str(seconds), str(seed)]
        done = subprocess.run(
            [*command, folder], capture_output=True, text=True, check=False, env={**os.environ}
        )
    counts = [line for line in done.stderr.splitlines() if line.startswith(('Done', '#'))]
    inputs = int(counts[-1].lstrip('#Done ').split()[0]) if counts else 0
    if done.returncode:
        print(done.stderr[-3000:], flush=True)
    return inputs, int(done.returncode != 0)


if __name__ == '__main__':
    raise SystemExit(main())
