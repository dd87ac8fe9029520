"""The table that `sweep` prints, and what needs a word below it."""

from collections.abc import Sequence

from ddct_bringup.scores.tables import CONTROLLER, STATE, RunColumn, dash_notes, metric
from ddct_bringup.sweep.axis import Axis, value_text
from ddct_bringup.sweep.sweep import Sweep, SweptRun
from ddct_plant.program.table import Column, Figure, Table, table_of
from ddct_plant.scenario.differences import scenario_title
from ddct_plant.scenario.settings import RunSettings


def sweep_table(sweep: Sweep, runs: Sequence[SweptRun], metrics: Sequence[Figure]) -> Table:
    """Return a row per run: the controller, where it ran, its metrics and its state."""
    columns = [
        _of_entry(CONTROLLER),
        *map(_of_axis, sweep.axes),
        *(_of_entry(metric(each)) for each in metrics),
        _of_entry(STATE),
    ]
    return table_of(_title(sweep), columns, runs)


def sweep_notes(runs: Sequence[SweptRun], metrics: Sequence[Figure]) -> list[str]:
    """Return what dashes mean, and why runs are not valid."""
    notes = dash_notes([run.entry for run in runs], [metric(each) for each in metrics])
    failed: dict[str, list[str]] = {}
    for run in runs:
        if not run.entry['valid']:
            reason = f'{run.entry["controller"]} is not valid: {run.entry["reason"]}'
            failed.setdefault(reason, []).append(run.place)
    return [*notes, *(f'{reason} (at {"; ".join(places)})' for reason, places in failed.items())]


def _title(sweep: Sweep) -> str:
    settings: RunSettings = sweep.settings[0]
    changes = [f'{key}={value}' for key, value in sweep.base.changes.items()]
    wear = f', wear gain {settings.wear_gain:g}'
    swept = [axis.key for axis in sweep.axes]
    return (
        f'{scenario_title(settings.scenario.name, changes)}; {settings.architecture}, '
        f'{settings.clutch} clutch{"" if "wear_gain" in swept else wear}; over {", ".join(swept)}'
    )


def _of_axis(axis: Axis) -> Column[SweptRun]:
    heading = f'{axis.key}\n{axis.unit}' if axis.unit else axis.key
    return Column(heading, '', lambda run: value_text(run.varied[axis.key]), number=axis.numeric)


def _of_entry(column: RunColumn) -> Column[SweptRun]:
    """Return a column of a table of runs as one of a sweep's."""
    return Column(
        column.heading,
        column.form,
        lambda run: column.value(run.entry),
        number=column.number,
        undefined=column.undefined,
    )
