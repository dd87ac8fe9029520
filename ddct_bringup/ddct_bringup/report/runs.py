"""The runs that a report shows, read from their bags; a bag that cannot be read stays in."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from ddct_bringup.bag.measured_run import read_recording
from ddct_bringup.bag.reader import Recording
from ddct_bringup.run.run_timing import RunTiming, read_timing
from ddct_bringup.scores.bags import bag_name
from ddct_bringup.scores.scoring import (
    Entry,
    score_recording,
    unreadable_entry,
)
from ddct_bringup.verdict.limits import Limits
from ddct_controllers.registry import controller_names
from ddct_plant.base.errors import DdctError
from ddct_plant.measured.columns import ColumnMap
from ddct_plant.scenario.file import scenario_digest
from ddct_plant.scenario.settings import RunSettings


@dataclass(frozen=True)
class ReportRun:
    """One bag and what is known of it."""

    entry: Entry
    """As in `scores.json`."""
    recording: Recording | None = None
    """None where the bag cannot be read."""
    timing: RunTiming | None = None
    """None without a `timing.json` beside the bag."""
    settings: RunSettings | None = None
    """As `Recording.settings`."""

    @property
    def controller(self) -> str | None:
        """The controller's name."""
        return self.entry['controller']

    @cached_property
    def digest(self) -> str | None:
        """
        What tells two scenarios of one name apart, None where the bag does not tell.

        It is taken anew: the bag's own digest changes when a version adds a scenario key.
        """
        if self.settings:
            return scenario_digest(self.settings.scenario)
        nodes = self.recording.run_info.values() if self.recording else ()
        return next((node['scenario_digest'] for node in nodes if 'scenario_digest' in node), None)


def read_run(
    bag: Path, folder: Path | None, limits: Limits, columns: ColumnMap | None = None
) -> ReportRun:
    """Read and judge a bag, which is named relative to the folder; never raises DdctError."""
    try:
        recording = read_recording(bag, columns)
        entry = score_recording(recording, bag_name(bag, folder), limits)
        timing = None if recording.measured else read_timing(recording.path.parent)
        return ReportRun(entry, recording, timing, recording.settings)
    except DdctError as error:
        return ReportRun(unreadable_entry(bag, error, relative_to=folder))


def in_order(runs: Sequence[ReportRun]) -> list[ReportRun]:
    """Return the runs in the order in which the registry lists their controllers."""
    places = {name: place for place, name in enumerate(controller_names())}
    return sorted(runs, key=lambda run: places.get(run.entry['controller'], len(places)))


def require_one_scenario(runs: Sequence[ReportRun]) -> None:
    """Raise DdctError that names the scenarios when the readable runs are not all of one."""
    bags: dict[str, list[str]] = {}
    for run in runs:
        if run.recording is not None:
            digest = f' (digest {run.digest})' if run.digest else ''
            bags.setdefault(f'{run.entry["scenario"]}{digest}', []).append(run.entry['bag'])
    if len(bags) > 1:
        parts = '; '.join(f'{scenario}: {", ".join(names)}' for scenario, names in bags.items())
        raise DdctError(
            f'the runs are of {len(bags)} scenarios, which do not compare: {parts}: '
            'make one report of each'
        )
