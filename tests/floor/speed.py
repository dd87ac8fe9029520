# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Time of a front of 15 lock times for peak jerk, and of 200 headless runs of mpc3, side by side.

    python tests/floor/speed.py --scenario launch

Times are those of the processor, so that other programs hardly matter. Nothing comes from the
cache. The exit code is 1 where the front takes longer.
"""

import argparse
import os
import time

from ddct_bringup.floor.control_start import control_start
from ddct_bringup.floor.front import front, usual_lock_times
from ddct_bringup.run.headless import run_headless
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

RUNS = 200
_BLOCKS = 5


def main() -> int:
    """Measure both in turns, print the times, and return the exit code."""
    parser = argparse.ArgumentParser(description='Time of a front and of 200 runs of mpc3.')
    parser.add_argument('--scenario', default='launch')
    options = parser.parse_args()
    os.environ['DDCT_CACHE'] = ''
    settings = RunSettings(KnownSettings(load_scenario(options.scenario)))
    start = control_start(settings)
    times = usual_lock_times(settings, start)
    next(front(settings, ['peak_jerk'], times[-1:], start))  # imports
    spent = {'front': 0.0, 'runs': 0.0}
    for block in range(_BLOCKS):
        begun = time.process_time()
        list(front(settings, ['peak_jerk'], times[block::_BLOCKS], start))
        between = time.process_time()
        for _ in range(RUNS // _BLOCKS):
            run_headless(settings, 'mpc3')
        spent['front'] += between - begun
        spent['runs'] += time.process_time() - between
    print(
        f'{options.scenario}: front of {len(times)} lock times '
        f'{spent["front"]:.2f} s, {RUNS} runs of mpc3 {spent["runs"]:.2f} s: '
        f'{spent["front"] / spent["runs"] * RUNS:.0f} runs'
    )
    return 1 if spent['front'] > spent['runs'] else 0


if __name__ == '__main__':
    raise SystemExit(main())
