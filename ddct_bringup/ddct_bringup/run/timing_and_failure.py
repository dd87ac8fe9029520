# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Files beside a bag: `timing.json`, and `failed_run.json` of a run that failed."""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from ddct_bringup.bag.realtime_facts import RealtimeCounts
from ddct_bringup.bag.run_facts import RunFacts, described_run
from ddct_plant.base.errors import DdctError, printable, require_number
from ddct_plant.files.input_file import read_text_file
from ddct_plant.files.json_records import parse_json, write_json
from ddct_plant.files.output_file import write_text
from ddct_plant.graph.node_names import name_in_graph
from ddct_plant.ticks.durations import DurationHistogram, checked

TIMING_FILE = 'timing.json'
NOTE_FILE = 'failed_run.json'
_ADVICE = 'choose another output folder'
MOST_BYTES = 10_000_000
"""Largest size of `timing.json` in bytes; an hour's run has six tenths of that."""


@dataclass
class RunTiming(RealtimeCounts):
    """Content of `timing.json`: wall-clock times and counts, kept out of the deterministic bag."""

    update_times_us: list[float] = field(default_factory=list)
    """Wall time of each controller update in us, in order."""
    refused_messages: int = 0
    """Number of messages refused for an impossible stamp; real time only."""
    wall_time_s: float = 0.0
    """Wall time from the first tick to the last, s."""
    steps: int = 0

    def write(self, folder: Path) -> None:
        """Write `timing.json` into a bag's folder; raise DdctError when that fails."""
        write_text(str(folder / TIMING_FILE), json.dumps(asdict(self)) + '\n', _ADVICE)


def read_timing(folder: Path) -> RunTiming | None:
    """Return the timing of a bag folder, None without one; raise DdctError for invalid content."""
    path = folder / TIMING_FILE
    try:
        text = read_text_file(path, MOST_BYTES)
    except FileNotFoundError:
        return None
    except OSError as error:
        raise DdctError(f'cannot read the timing: {error.strerror}', place=path) from error
    try:
        values = parse_json(text)
        lateness = values.get('worst_lateness_us')
        if lateness is not None:
            lateness = _at_least_0('worst_lateness_us', lateness)
        return RunTiming(
            update_times_us=[_at_least_0('update_times_us', x) for x in values['update_times_us']],
            missed_steps=_count('missed_steps', values['missed_steps']),
            resends=_count('resends', values['resends']),
            late_messages=_count('late_messages', values['late_messages']),
            refused_messages=_count('refused_messages', values.get('refused_messages', 0)),
            worst_lateness_us=lateness,
            safe_states={
                name_in_graph(node): _count('safe_states', stamp)
                for node, stamp in values.get('safe_states', {}).items()
            },
            durations={
                str(name): _histogram(each) for name, each in values.get('durations', {}).items()
            },
            wall_time_s=_at_least_0('wall_time_s', values['wall_time_s']),
            steps=_count('steps', values['steps']),
        )
    except (DdctError, LookupError, TypeError, AttributeError, ValueError) as error:
        raise DdctError(
            f'not the timing of a run ({error!r}): delete it to score without', place=path
        ) from error


def _at_least_0(name: str, value: object) -> float:
    return require_number(name, value, at_least=0.0)


def _count(name: str, value: object) -> int:
    return int(_at_least_0(name, value))


def _histogram(values: Mapping[str, Any]) -> DurationHistogram:
    counts = {int(place): _count('counts', count) for place, count in values['counts'].items()}
    return checked(_at_least_0('largest_us', values['largest_us']), counts)


@dataclass(frozen=True)
class RunFailure:
    """Reason of a failed run, and its planned facts."""

    reason: str
    facts: RunFacts | None = None
    """Planned facts of the run; None where the note cannot be read."""
    custom_data: dict[str, str] = field(default_factory=dict)
    """Custom data that the bag of the run has, or would have; empty without facts."""


def note_failure(folder: Path, reason: str, custom_data: Mapping[str, str]) -> None:
    """
    Write the reason of a failure into a run's folder; `custom_data` is that of its bag.

    Raise DdctError when that fails.
    """
    write_json(str(folder / NOTE_FILE), {'reason': reason, 'run': dict(custom_data)}, _ADVICE)


def failed_run(folder: Path) -> RunFailure | None:
    """
    Return the failure noted in a run's folder; None without a note.

    A note that cannot be read still marks the run as failed.
    """
    path = folder / NOTE_FILE
    try:
        note = parse_json(read_text_file(path))
        known = note['run']
        if not all(isinstance(text, str) for text in known.values()):
            raise DdctError('its run has values that are no texts')
        return RunFailure(printable(note['reason']), described_run(known)[1], known)
    except FileNotFoundError:
        return None
    except (OSError, DdctError, LookupError, TypeError, AttributeError) as error:
        return RunFailure(printable(f'the run failed, and its {path} cannot be read ({error!r})'))
