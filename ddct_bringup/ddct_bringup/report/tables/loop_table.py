"""The table of frequency-domain evidence, one row per controller and wear gain."""

from collections.abc import Sequence
from dataclasses import dataclass

from ddct_bringup.report.evidence import LoopEvidence
from ddct_bringup.report.typeset import number_text
from ddct_controllers.design.analysis.margins import LOOP_FIGURES
from ddct_controllers.workflows.evidence import Evidence

NOT_LINEAR = 'not linear, so without a frequency response'


@dataclass(frozen=True)
class LoopRow:
    """One row of the table."""

    controller: str
    wear_gain: str
    stable: bool
    cells: tuple[tuple[float | None, str], ...]
    """(value, text) for each of `LOOP_FIGURES`."""
    stable_wear: str
    """Between which wear gains the loop is stable."""
    corner_peak: str
    """Highest M_s over all corners."""
    corners_unstable: str
    remark: str


def loop_rows(evidence: Sequence[LoopEvidence]) -> list[LoopRow]:
    """Return one row for each loop that has evidence."""
    rows = []
    for each in evidence:
        if each.entry is not None and each.point is not None:
            rows.append(_row(each, each.entry, each.point))
    return rows


def without_evidence(evidence: Sequence[LoopEvidence]) -> dict[str, list[str]]:
    """Return the controllers that have none, by the reason."""
    reasons: dict[str, list[str]] = {}
    for each in evidence:
        if each.point is None:
            linear = each.entry is None or each.entry['linear']
            names = reasons.setdefault(each.remark if linear else NOT_LINEAR, [])
            if each.controller not in names:
                names.append(each.controller)
    return reasons


def _row(evidence: LoopEvidence, entry: Evidence, point: Evidence) -> LoopRow:
    interval = entry['stable_wear_gain'] or {}
    return LoopRow(
        controller=evidence.controller,
        wear_gain=f'{evidence.wear_gain:g}',
        stable=point['stable'],
        cells=tuple(
            (point[each.key], number_text(point[each.key], each.form)) for each in LOOP_FIGURES
        ),
        stable_wear=f'{number_text(interval.get("lowest"), ".2f")} to '
        f'{number_text(interval.get("highest"), ".2f")}',
        corner_peak=number_text(entry['corners']['sensitivity_peak'], '.2f'),
        corners_unstable=str(entry['corners']['unstable']),
        remark=evidence.remark,
    )
