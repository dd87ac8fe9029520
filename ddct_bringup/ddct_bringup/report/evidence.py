# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Frequency-domain evidence of the runs, and its table.

It is read from the file that `compare` writes next to the bags, or computed.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from ddct_bringup.documents.page_parts import number_text
from ddct_bringup.scores.scored_recording import ScoredRecording
from ddct_controllers.design.analysis.loop_quantities import LOOP_QUANTITIES
from ddct_controllers.workflows.evidence import actuator_conditions, frequency_evidence
from ddct_controllers.workflows.evidence_types import (
    ControllerEntry,
    FrequencyEvidence,
    LinearEntry,
    PointEntry,
)
from ddct_plant.base.errors import DdctError
from ddct_plant.files.json_records import read_json, to_json

FREQUENCY_FILE = 'frequency.json'
"""Name of the file that `compare` writes next to the scores."""
COMPUTED = 'computed for this page'
OF_A_LOG = 'measured in a car, and a log does not tell the loop that was closed there'
NOT_LINEAR = 'not linear, so without a frequency response'


@dataclass(frozen=True)
class LoopEvidence:
    """The sampled loop of one controller at one wear gain."""

    controller: str
    wear_gain: float
    entry: ControllerEntry | None
    """Entry of `frequency_evidence`; None where there is none."""
    remark: str = ''
    """Reason why there is no entry, or `COMPUTED`."""

    @property
    def point(self) -> PointEntry | None:
        """Values of the loop at this wear gain."""
        points = (self.entry and self.entry.wear) or ()
        return next((point for point in points if point.wear_gain == self.wear_gain), None)


def evidence_of(runs: Iterable[ScoredRecording]) -> list[LoopEvidence]:
    """
    Return the evidence of every controller and wear gain of the readable runs, each once.

    A log has none, as its closed loop is not known.
    """
    found: dict[tuple[str, float], LoopEvidence | None] = {}
    missing: dict[float, dict[str, ScoredRecording]] = {}
    logs: dict[str, LoopEvidence] = {}
    for run in runs:
        if run.recording is None:
            continue
        if run.measured:
            name, wear = run.recording.facts.controller, run.recording.facts.wear_gain
            logs[name] = LoopEvidence(name, wear, None, OF_A_LOG)
            continue
        facts = run.recording.facts
        key = (facts.controller, facts.wear_gain)
        if found.setdefault(key, _stored(run, *key)) is None:
            missing.setdefault(facts.wear_gain, {}).setdefault(facts.controller, run)
    computed = {
        (each.controller, each.wear_gain): each
        for wear_gain, by_controller in missing.items()
        for each in _computed(by_controller, wear_gain)
    }
    return [*(each or computed[key] for key, each in found.items()), *logs.values()]


def _stored(run: ScoredRecording, controller: str, wear_gain: float) -> LoopEvidence | None:
    """Return the evidence of exactly this loop from the file next to the bag's folder, if any."""
    assert run.recording is not None
    try:
        file = run.recording.path.parent.parent / FREQUENCY_FILE
        content = read_json(FrequencyEvidence, file)
    except DdctError:
        return None
    if run.digest is None or content.conditions.scenario_digest != run.digest:
        return None
    actuator = run.settings and actuator_conditions(run.settings.scenario.actuator)
    if actuator not in (None, content.conditions.actuator):
        return None
    entry = next((each for each in content.controllers if each.controller == controller), None)
    found = LoopEvidence(controller, wear_gain, entry)
    return found if found.point or (entry and entry.linear is False) else None


def _computed(runs: Mapping[str, ScoredRecording], wear_gain: float) -> list[LoopEvidence]:
    """Return the evidence of the controllers in the loops of their runs, all of one wear gain."""
    settings = next((run.settings for run in runs.values() if run.settings), None)
    if settings is None:
        remark = 'the bag does not tell its scenario in a form that this version reads'
        return [LoopEvidence(name, wear_gain, None, remark) for name in runs]
    try:
        entries = frequency_evidence(list(runs), settings).controllers
    except DdctError as error:
        if len(runs) > 1:  # one at a time, so that only the faulty one has none
            return [each for name in runs for each in _computed({name: runs[name]}, wear_gain)]
        return [LoopEvidence(name, wear_gain, None, str(error)) for name in runs]
    return [
        LoopEvidence(name, wear_gain, entry, COMPUTED)
        for name, entry in zip(runs, entries, strict=True)
    ]


@dataclass(frozen=True)
class LoopRow:
    """One row of the table."""

    loop: LoopEvidence
    stable: bool
    cells: tuple[tuple[float | None, str], ...]
    """Cells (value, text) for each of `LOOP_QUANTITIES`."""
    stable_wear: str
    """Range of wear gains in which the loop is stable."""
    corner_peak: str
    """Largest M_s over all corners."""
    corners_unstable: str


def loop_rows(evidence: Sequence[LoopEvidence]) -> list[LoopRow]:
    """Return one row for each loop that has evidence."""
    return [
        _row(each, each.entry, each.point)
        for each in evidence
        if isinstance(each.entry, LinearEntry) and each.point is not None
    ]


def without_evidence(evidence: Sequence[LoopEvidence]) -> dict[str, list[str]]:
    """Return the controllers without evidence, by reason."""
    reasons: dict[str, list[str]] = {}
    for each in evidence:
        if each.point is None:
            linear = each.entry is None or each.entry.linear
            names = reasons.setdefault(each.remark if linear else NOT_LINEAR, [])
            if each.controller not in names:
                names.append(each.controller)
    return reasons


def _row(evidence: LoopEvidence, entry: LinearEntry, point: PointEntry) -> LoopRow:
    interval = entry.stable_wear_gain
    ends = (interval.lowest, interval.highest) if interval else (None, None)
    values = to_json(point)
    return LoopRow(
        loop=evidence,
        stable=point.margins.stable,
        cells=tuple(
            (values[each.key], number_text(values[each.key], each.form))
            for each in LOOP_QUANTITIES
        ),
        stable_wear=' to '.join(number_text(end, '.2f') for end in ends),
        corner_peak=number_text(entry.corners.sensitivity_peak, '.2f'),
        corners_unstable=str(entry.corners.unstable_corners),
    )
