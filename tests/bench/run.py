# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
`make bench`: time of the graph as a multiple of that of a bare rclpy chain of the same shape.

Both are run in turn, so that a busy machine slows both; the ratio of the medians counts, absolute
times do not. Also measured: the headless loop, with a clutch that sticks as well, beside
python-control, and batches of runs; each controller's update, H-infinity synthesis, the quadratic
programs of predictive control, a whole step of `mpc_preview`, the verdict, campaigns, and the time
until a report is drawn.
"""

import argparse
import json
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from bare_chain import WIRING
from batch import measure as measure_batch
from batch import print_table as print_batch
from campaign import measure as measure_campaign
from campaign import print_table as print_campaign
from exported_mpc import measure as measure_exported
from exported_mpc import print_table as print_exported
from mpc_step import measure as measure_mpc_step
from mpc_step import print_table as print_mpc_step
from page import measure as measure_page
from page import print_table as print_page
from python_control import measure as measure_python_control
from python_control import print_table as print_python_control
from qp import measure as measure_qp
from qp import print_table as print_qp
from stick_slip import measure as measure_stick_slip
from stick_slip import print_table as print_stick_slip
from synthesis import measure as measure_synthesis
from verdict import GOAL_MS as VERDICT_GOAL_MS
from verdict import measure as measure_verdict

from ddct_bringup.run.execution import execute
from ddct_bringup.run.headless import run_headless
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.run.timing_and_failure import TIMING_FILE, RunTiming
from ddct_controllers.registry import controller_names
from ddct_plant.files.output_file import write_json
from ddct_plant.graph.domain import own_domain
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

PERIOD_US = 10_000.0
WORST_RATIOS = {'processes': 1.5, 'single-process': 1.75}
"""
Largest ratio of the time per step of the graph to that of the bare chain, by layout.

In one process the chain itself is short, so that the MCAP library's writer weighs more.
"""
BARE_S = 300.0
"""Timeout of a bare chain, s; it ends by itself when a message is lost."""
BARE = Path(__file__).with_name('bare_chain.py')


def main() -> int:
    """Measure, print, and return 0 when both ratios reach their goal."""
    parser = argparse.ArgumentParser(description='Measure the graph against bare rclpy.')
    parser.add_argument('--rounds', type=int, default=5)
    parser.add_argument('--duration', type=float, default=20.0, help='simulated seconds per run')
    parser.add_argument('--json', metavar='FILE')
    options = parser.parse_args()
    settings = RunSettings(load_scenario('thesis', [f'duration_s={options.duration}']))
    results = {
        layout: _measure(layout, settings, options.rounds)
        for layout in ('processes', 'single-process')
    }
    headless = [_headless_us(settings, name) for name in controller_names()]
    for name, (step_us, update_us) in zip(controller_names(), headless, strict=True):
        print(
            f'headless {name}: {step_us:.1f} us per step ({PERIOD_US / step_us:.0f}x real time), '
            f'of which its update {update_us:.1f} us'
        )
    batch = measure_batch()
    print_batch(batch)
    python_control = measure_python_control()
    print_python_control(python_control)
    stick_slip = measure_stick_slip()
    print_stick_slip(stick_slip)
    synthesis = measure_synthesis()
    _print_synthesis(synthesis)
    programs = measure_qp()
    print_qp(programs)
    mpc_step = measure_mpc_step()
    print_mpc_step(mpc_step)
    exported = measure_exported()
    print_exported(exported)
    verdict_ms = measure_verdict()
    print(f'metrics and verdict of one run: {verdict_ms:.2f} ms (goal {VERDICT_GOAL_MS:g} ms)')
    campaign = measure_campaign()
    print_campaign(campaign)
    page = measure_page()
    print_page(page)
    if options.json:
        stored = {
            **results,
            'headless_us': headless,
            'batch_us': batch,
            'python_control': python_control,
            'stick_slip': stick_slip,
            'synthesis': synthesis,
            'quadratic_programs': programs,
            'mpc_step': mpc_step,
            'exported_mpc': exported,
            'verdict_ms': verdict_ms,
            'campaign': campaign,
            'report_page': page,
        }
        write_json(options.json, stored)
    return (
        0
        if all(results[layout]['ratio'] <= worst for layout, worst in WORST_RATIOS.items())
        else 1
    )


def _print_synthesis(results: dict[str, Any]) -> None:
    print(f'H-infinity synthesis: {results["ours_s"]:.3f} s, gamma {results["ours_gamma"]:.4f}')
    if 'skipped' in results:
        print(f'  not compared: {results["skipped"]}')
        return
    print(
        f'  slycot: {results["slycot_s"]:.3f} s, gamma {results["slycot_gamma"]:.4f}; '
        f'ours takes {results["time_ratio"]:.2f} of its time'
    )


def _measure(layout: str, settings: RunSettings, rounds: int) -> dict[str, Any]:
    """Return the times per step of chain and graph in us, and the ratio of their medians."""
    bare, graph = [], []
    for _ in range(rounds):
        bare.append(_bare_us(layout, settings.scenario.steps))
        graph.append(_graph_us(layout, settings))
    bare_us, graph_us = statistics.median(bare), statistics.median(graph)
    ratios = sorted(ours / floor for ours, floor in zip(graph, bare, strict=True))
    print(
        f'{layout}: bare {bare_us:.0f} us, graph {graph_us:.0f} us per step '
        f'({PERIOD_US / graph_us:.1f}x real time), ratio {graph_us / bare_us:.2f} '
        f'(rounds {ratios[0]:.2f} to {ratios[-1]:.2f}; at most {WORST_RATIOS[layout]} wanted)',
        flush=True,
    )
    return {'bare_us': bare, 'graph_us': graph, 'ratio': graph_us / bare_us}


def _graph_us(layout: str, settings: RunSettings) -> float:
    with tempfile.TemporaryDirectory() as folder:
        execute(RunPlan(settings, 'pi', layout), Path(folder))
        timing = json.loads((Path(folder) / TIMING_FILE).read_text(encoding='utf-8'))
    return 1e6 * timing['wall_time_s'] / timing['steps']


def _bare_us(layout: str, steps: int) -> float:
    names = ['all'] if layout == 'single-process' else list(WIRING)
    with own_domain():
        processes = [
            subprocess.Popen(
                [sys.executable, str(BARE), name, str(steps)], stdout=subprocess.PIPE, text=True
            )
            for name in names
        ]
        try:
            output, _ = processes[-1].communicate(timeout=BARE_S)
        except subprocess.TimeoutExpired:
            sys.exit(f'run.py: the bare chain of {steps} steps took more than {BARE_S:g} s')
        finally:
            for process in processes:
                process.terminate()
            for process in processes:
                process.wait(timeout=20)
    if processes[-1].returncode:
        sys.exit('run.py: the bare chain failed; its reason is above')
    return float(output)


def _headless_us(settings: RunSettings, controller: str) -> tuple[float, float]:
    """Return the shortest of five times per step and the median time of an update, in us."""
    steps, updates = [], []
    for _ in range(5):
        timing = RunTiming()
        started = time.perf_counter()
        run_headless(settings, controller, timing)
        steps.append(1e6 * (time.perf_counter() - started) / timing.steps)
        updates += timing.update_times_us
    return min(steps), statistics.median(updates)


if __name__ == '__main__':
    raise SystemExit(main())
