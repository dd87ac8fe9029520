# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Time until a browser has drawn all charts of a report, beside one bare chart."""

import tempfile
from collections.abc import Iterator
from pathlib import Path

from bench.peers.bare_chart import write_bare_chart
from bench.skeleton.comparison import Bench, Comparison, NotMeasured, Sides, comparison
from report.headless_chromium import chromium, visit

from ddct_bringup.bag.trajectory_bag import write_trajectory
from ddct_bringup.report.page import report_page
from ddct_bringup.run.description import custom_data
from ddct_bringup.run.headless import run_headless
from ddct_bringup.scores.scored_recording import score_any_bag
from ddct_bringup.verdict.limits import packaged_limits
from ddct_controllers.registry import own_controller_names
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

COUNTS = {'5 runs': 5, 'all controllers': len(own_controller_names())}


def _drawn(label: str) -> Comparison:
    @comparison(f'report of {label}, drawn', 'a page with one bare Bokeh chart')
    def sides(bench: Bench) -> Iterator[Sides]:
        """Time from the start of the navigation until all is drawn, in a headless Chromium."""
        if chromium() is None:
            raise NotMeasured('there is no Chromium on this machine')
        names = own_controller_names()[: COUNTS[label]]
        with tempfile.TemporaryDirectory() as folder:
            report, bare = Path(folder) / 'report.html', Path(folder) / 'bare.html'
            report.write_text(_page(names, Path(folder)), encoding='utf-8')
            write_bare_chart(bare, len(names))
            yield Sides(lambda: visit(report).ready_ms, lambda: visit(bare).ready_ms)

    return sides


def _page(names: list[str], folder: Path) -> str:
    """Return the report of a run under several names: drawing takes as long for any run."""
    settings = RunSettings(load_scenario('thesis'))
    trajectory, steps = run_headless(settings, 'ls8'), settings.scenario.steps
    bags = [folder / name for name in names]
    for bag in bags:
        write_trajectory(trajectory, bag, bag.name, custom_data(settings, bag.name, steps), {})
    limits = packaged_limits()
    return report_page([score_any_bag(bag, folder, limits) for bag in bags], [], limits)


REPORTS = tuple(_drawn(label) for label in COUNTS)
