# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Exported C controllers, compiled with a program that times their steps.

`PYTHONPATH=tests python -m bench.peers.exported_c` prints the sizes of their code.
"""

import re
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from bench.peers.replay import measurements_of
from bench.skeleton.comparison import NotMeasured

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


class ExportedController:
    """Exported controller, compiled in a folder with the measurements of one closed-loop run."""

    def __init__(self, case: str, folder: Path) -> None:
        """Export and compile; raise NotMeasured without a compiler."""
        compiler = shutil.which('cc')
        if compiler is None:
            raise NotMeasured('there is no C compiler cc')
        name, changes = CASES[case]
        settings = RunSettings(load_scenario('thesis', list(changes)))
        self.measurements = measurements_of(settings, make_controller(name, settings))
        self.original = make_controller(name, settings)
        """The Python controller that it is exported from."""
        self._folder = folder
        export_controller(self.original, name, settings, folder)
        self._compile(compiler)

    def _compile(self, compiler: str) -> None:
        held, updated = self.measurements
        values = np.array([_values(measurement) for measurement in (*held, *updated)])
        sizes = {'ROUNDS': _ROUNDS, 'STEPS': len(values), 'HELD': len(held)}
        data = f'{macros(sizes)}\n{constants({"VALUES": values})}'
        (self._folder / 'main.c').write_text(_MAIN.replace('@DATA@', data))
        build = [compiler, *_FLAGS, '-c', 'ddct_mpc.c', 'main.c']
        subprocess.run(build, cwd=self._folder, check=True)
        link = [compiler, 'ddct_mpc.o', 'main.o', '-o', 'main']
        subprocess.run(link, cwd=self._folder, check=True)

    def run(self) -> tuple[int, np.ndarray]:
        """
        Return the size of its state in bytes, and time in us and iterations of each step, (n, 2).

        A time includes reading the clock.
        """
        printed = subprocess.check_output(['./main'], cwd=self._folder, text=True)
        first, *lines = printed.splitlines()
        return int(first), np.array([[float(word) for word in line.split()] for line in lines])

    def sizes(self) -> dict[str, int]:
        """
        Return bytes of flash and stack, and the bound of the iterations, by name.

        Sizes are those of this machine's code: flash is code and tables, stack the sum of all
        frames.
        """
        listed = subprocess.check_output(['size', 'ddct_mpc.o'], cwd=self._folder, text=True)
        header = (self._folder / 'ddct_mpc.h').read_text()
        bound = re.search(r'DDCT_MPC_ITERATIONS (\d+)', header)
        assert bound is not None
        return {
            'flash_bytes': int(listed.splitlines()[1].split()[0]),
            'stack_bytes': _stack_bytes(self._folder / 'ddct_mpc.su'),
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


def main() -> None:
    """Print sizes and iterations of every case."""
    for case in CASES:
        with tempfile.TemporaryDirectory() as folder:
            exported = ExportedController(case, Path(folder))
            (ram_bytes, rows), sizes = exported.run(), exported.sizes()
        print(
            f'{case}: flash {sizes["flash_bytes"]} B, ram {ram_bytes} B, '
            f'stack {sizes["stack_bytes"]} B; iterations at most {rows[:, 1].max():.0f} '
            f'of {sizes["iteration_bound"]}'
        )


if __name__ == '__main__':
    main()
