# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Time of one step of exported C controllers, and of the Python controllers they come from."""

import re
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from replay import measurements_of, times_of

from ddct_controllers.interface import Measurement
from ddct_controllers.mpc.export.export_controller import constants, export_controller, macros
from ddct_controllers.registry import make_controller
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

CASES = {
    'mpc3': ('mpc3', ()),
    'mpc3, torque and rate limited': (
        'mpc3',
        ('controllers.mpc3.highest_torque_n_m=200', 'controllers.mpc3.torque_rate_n_m_s=300'),
    ),
    'mpc2': ('mpc2', ()),
    'mpc_preview': ('mpc_preview', ()),
    'mpc_offset_free': ('mpc_offset_free', ()),
}
"""
Registry name of the controller and changes of the scenario, by case.

mpc4 is absent: by itself, without the plant that it commands, it is unstable, so that it
diverges when the measurements come from a file.
"""
_ROUNDS = 20
_FLAGS = ('-std=c99', '-O2', '-fstack-usage')
_MAIN = """\
#define _POSIX_C_SOURCE 199309L
#include <stdio.h>
#include <string.h>
#include <time.h>
#include "ddct_mpc.h"
@DATA@
static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e6 * (double)t.tv_sec + 1e-3 * (double)t.tv_nsec;
}

int main(void)
{
    ddct_mpc controller;
    printf("%zu\\n", sizeof controller);
    for (int round = 0; round < ROUNDS; ++round) {
        ddct_mpc_reset(&controller);
        for (int step = 0; step < STEPS; ++step) {
            ddct_mpc_measurement m;
            memcpy(&m, VALUES[step], sizeof m);
            if (step < HELD) {
                ddct_mpc_hold(&controller, &m);
                continue;
            }
            const double started = now();
            const ddct_mpc_command command = ddct_mpc_update(&controller, &m);
            const double ended = now();
            printf("%.9g %d\\n", ended - started, command.iterations);
        }
    }
    return 0;
}
"""


def measure() -> dict[str, Any]:
    """
    Return for each case median and p99 per step of both in us, and sizes and iterations of the C.

    Both update with the measurements of one closed-loop run; the time of the C includes reading
    the clock. Sizes are those of this machine's code: flash is code and tables, ram the state,
    stack the sum of all frames. Without cc the only entry is `skipped`, the reason.
    """
    compiler = shutil.which('cc')
    if compiler is None:
        return {'skipped': 'there is no C compiler cc'}
    return {case: _measure(compiler, *what) for case, what in CASES.items()}


def print_table(results: dict[str, Any]) -> None:
    """Print the results of `measure`."""
    if 'skipped' in results:
        print(f'exported controllers not measured: {results["skipped"]}')
        return
    print('exported controllers, one step:')
    for case, row in results.items():
        print(
            f'  {case}: C median {row["c_us"][0]:.2f} us, p99 {row["c_us"][1]:.2f} us; Python '
            f'{row["python_us"][0]:.1f} us, {row["python_us"][1]:.1f} us '
            f'({row["ratio"]:.0f}x); flash {row["flash_bytes"]} B, ram {row["ram_bytes"]} B, '
            f'stack {row["stack_bytes"]} B; iterations at most {row["iterations"]} '
            f'of {row["iteration_bound"]}'
        )


def _measure(compiler: str, name: str, changes: tuple[str, ...]) -> dict[str, Any]:
    settings = RunSettings(load_scenario('thesis', list(changes)))
    measurements = measurements_of(settings, make_controller(name, settings))
    original = make_controller(name, settings)
    times_us = times_of(original, measurements, _ROUNDS)
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        export_controller(original, name, settings, folder)
        rows, sizes = _run_c(compiler, folder, *measurements)
    python_us, c_us = (np.percentile(times, [50, 99]) for times in (times_us, rows[:, 0]))
    return {
        'c_us': c_us.tolist(),
        'python_us': python_us.tolist(),
        'ratio': python_us[0] / c_us[0],
        'iterations': int(rows[:, 1].max()),
        **sizes,
    }


def _run_c(
    compiler: str, folder: Path, held: list[Measurement], updated: list[Measurement]
) -> tuple[np.ndarray, dict[str, int]]:
    """Return the time in us and the iterations of each step, (n, 2), and the sizes by name."""
    values = np.array([_values(measurement) for measurement in (*held, *updated)])
    sizes = {'ROUNDS': _ROUNDS, 'STEPS': len(values), 'HELD': len(held)}
    data = f'{macros(sizes)}\n{constants({"VALUES": values})}'
    (folder / 'main.c').write_text(_MAIN.replace('@DATA@', data))
    build = [compiler, *_FLAGS, '-c', 'ddct_mpc.c', 'main.c']
    subprocess.run(build, cwd=folder, check=True)
    subprocess.run([compiler, 'ddct_mpc.o', 'main.o', '-o', 'main'], cwd=folder, check=True)
    first, *lines = subprocess.check_output(['./main'], cwd=folder, text=True).splitlines()
    listed = subprocess.check_output(['size', 'ddct_mpc.o'], cwd=folder, text=True)
    bound = re.search(r'DDCT_MPC_ITERATIONS (\d+)', (folder / 'ddct_mpc.h').read_text())
    assert bound is not None
    return np.array([[float(word) for word in line.split()] for line in lines]), {
        'flash_bytes': int(listed.splitlines()[1].split()[0]),
        'ram_bytes': int(first),
        'stack_bytes': _stack_bytes(folder / 'ddct_mpc.su'),
        'iteration_bound': int(bound[1]),
    }


def _values(measurement: Measurement) -> list[float]:
    """Return the values of the fields of ddct_mpc_measurement, in the order of the fields."""
    names = ('engine_speed', 'shaft_speed', 'wheel_speed', 'engine_torque', 'load_torque')
    scalars = [getattr(measurement, name) for name in (*names, 'open_loop_torque')]
    return [*scalars, *measurement.slip_reference, *measurement.slip_reference_rate]


def _stack_bytes(usage: Path) -> int:
    """Return the sum of all stack frames in bytes, an upper bound for calls without recursion."""
    return sum(int(line.split('\t')[1]) for line in usage.read_text().splitlines())


if __name__ == '__main__':
    print_table(measure())
