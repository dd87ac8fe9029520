# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Write what `replay` and the two memorisers know: `python tests/support/gaming/memorise.py`.

To be called again when the development cases, the sensors or `least_jerk` change.
"""

import textwrap
from pathlib import Path

from memory_key import SAMPLES, Key
from replay import EVERY_S

from ddct_bringup.benchmark.cases import Cases
from ddct_bringup.run.headless import run_headless, run_loop
from ddct_controllers.interface import Command, Controller, Measurement
from ddct_controllers.loop import ClosedLoop
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.scenario.choices.scenarios import scenario_names
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

HERE = Path(__file__).parent
EVERY = round(EVERY_S / PERIOD_S)


class Listener(Controller):
    """A controller that does nothing but take the key of the case."""

    def __init__(self) -> None:
        self.key = Key()

    def reset(self) -> None:
        pass

    def hold(self, measurement: Measurement) -> None:
        self.key.add(measurement)

    def update(self, measurement: Measurement) -> Command:
        return Command(0.0)


def recorded(scenario: str) -> list[float]:
    """Return the request of `least_jerk` from the start of feedback on, each 50 ms."""
    settings = RunSettings(KnownSettings(load_scenario(scenario)))
    run = run_headless(settings, 'least_jerk')
    on = [dict(pairs)['feedback'] == 'on' for pairs in run.status]
    return [round(float(each), 2) for each in run.torque_request[on.index(True) :: EVERY]]


def memory() -> dict[int, float]:
    """Return the wear gain of each development case by its key."""
    cases = Cases.packaged().planned
    known = {}
    for index in range(cases.cases):
        settings = cases.run(index).settings
        listener = Listener()
        run_loop(ClosedLoop(settings, listener), SAMPLES + 1)
        known[listener.key.value] = settings.case.wear_gain
    assert len(known) == cases.cases, 'two cases have one key'
    return known


def write(file: str, text: str) -> None:
    """Replace the text in a file, which its first lines and its code surround."""
    path = HERE / file
    head, begins, rest = path.read_text(encoding='utf-8').partition('TEXT = """\n')
    _, ends, code = rest.partition('"""\n')
    lines = '\n'.join(each for line in text.splitlines() for each in textwrap.wrap(line, 95))
    path.write_text(f'{head}{begins}{lines}\n{ends}{code}', encoding='utf-8')


def main() -> None:
    """Write both files."""
    requests = (f'{name}: ' + ' '.join(map(str, recorded(name))) for name in scenario_names())
    write('recorded_requests.py', '\n'.join(requests))
    write('memory.py', ' '.join(f'{key}:{gain:.4f}' for key, gain in memory().items()))


if __name__ == '__main__':
    main()
