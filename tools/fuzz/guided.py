# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
One reader, given inputs that reach new code: `fuzz.guided READER SECONDS SEED FOLDER`.

It begins with the inputs of earlier runs, and adds to them. FOLDER is for what it needs until it
ends.
"""

import os
import sys
import time
from pathlib import Path

import atheris

with atheris.instrument_imports(
    include=['ddct_plant', 'ddct_bringup', 'ddct_controllers', 'mcap']
):
    from fuzz.loop import FOUND, REACHED, bounded_time, inputs_in, keep
    from fuzz.readers import readers


def main() -> None:
    """Run until the time is over or an input is a finding, which is kept."""
    name, seconds, seed, place = sys.argv[1:]
    folder = Path(place)
    reader = readers(folder)[name]
    seeds = folder / 'seeds'
    seeds.mkdir()
    for number, data in enumerate((*reader.seeds, *inputs_in(FOUND / name))):
        (seeds / str(number)).write_bytes(data)
    reached = REACHED / name
    reached.mkdir(parents=True, exist_ok=True)

    inputs, until = 0, time.monotonic() + float(seconds)

    def one(data: bytes) -> None:
        nonlocal inputs
        inputs += 1
        with bounded_time():
            what = reader.finding(data, folder / 'work')
        if what:
            keep(data, FOUND / name)
        if what or time.monotonic() > until:
            print(f'{what}\nDone {inputs}', file=sys.stderr, flush=True)
            # libFuzzer would wait for threads of pyarrow, which wait for the lock of Python.
            os._exit(1 if what else 0)

    limits = ['-rss_limit_mb=3000', '-max_len=200000', f'-seed={int(seed) + 1}']
    # What reaches new code is written into the first folder, and read from all.
    start = [f'-artifact_prefix={folder}/', str(reached), str(seeds)]
    atheris.Setup([sys.argv[0], *limits, *start], one)
    atheris.Fuzz()


if __name__ == '__main__':
    main()
