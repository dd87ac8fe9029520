"""Tables of scored runs for the terminal; plain text where the output is no terminal."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TextIO

from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from ddct_bringup.scores.scoring import Entry
from ddct_plant.base.printable import printable

UNDEFINED = '-'
_PIPED_WIDTH = 200
"""Columns of a table that goes to a file or pipe, where nothing needs to fit a screen."""


@dataclass(frozen=True)
class Column:
    """One column of a table of runs."""

    heading: str
    """A newline parts the name from the unit."""
    text: Callable[[Entry], str]
    number: bool = True
    """Whether to align it to the right."""
    below: Callable[[Entry], str] = lambda run: ''
    """What a second line says beneath the text; empty for none."""

    def cell(self, run: Entry) -> str:
        """Return the text of a run's cell, of one line or two."""
        lines = (self.text(run), self.below(run))
        return '\n'.join(printable(line) for line in lines if line)


def fact(name: str, heading: str) -> Column:
    """Return the column of a run's fact, such as its controller."""
    return Column(heading, lambda run: _text(run[name], '{}'), number=False)


def metric(name: str, heading: str, form: str) -> Column:
    """Return the column of a metric, written in the format `form`, such as '{:.3f}'."""
    return Column(heading, lambda run: _text(run['metrics'][name], form))


BAG = fact('bag', 'bag')
CONTROLLER = fact('controller', 'controller')
WEAR = Column('wear', lambda run: _text(run['wear_gain'], '{:g}'))
ENGAGEMENT_TIME = metric('engagement_time_s', 't_a\ns', '{:.3f}')
TORSION_STD = metric('torsion_speed_std_rpm', 'std w_sr\nrpm', '{:.3f}')
ACCELERATION_STD = metric('acceleration_std_m_s2', 'std A_x\nm/s^2', '{:.3f}')
FINAL_SLIP = metric('slip_final_rpm', 'final\nw_d rpm', '{:.2f}')
SLIP_RMSE = metric('slip_rmse_rpm', 'slip\nRMSE rpm', '{:.2f}')
PEAK_JERK = metric('peak_jerk_m_s3', 'jerk\nm/s^3', '{:.2f}')
MISSED = metric('missed_steps', 'missed\nsteps', '{:d}')
LATENESS = Column(
    'latest\nms',
    lambda run: _text(_in_ms(run['metrics']['worst_lateness_us']), '{:.2f}'),
)
SAFE_STATE = Column('safe state', lambda run: _safe_state(run), number=False)
VALID = Column('valid', lambda run: 'yes' if run['valid'] else 'NO', number=False)

COLUMNS = (
    ENGAGEMENT_TIME,
    TORSION_STD,
    ACCELERATION_STD,
    FINAL_SLIP,
    SLIP_RMSE,
    PEAK_JERK,
    VALID,
)
"""What every table of runs shows, after the columns that tell the runs apart."""

REALTIME_COLUMNS = (MISSED, LATENESS, SAFE_STATE)
"""What a table also shows when one of its runs was in real time."""


def print_runs(
    runs: Sequence[Entry], columns: Sequence[Column], stream: TextIO, title: str | None = None
) -> None:
    """Print one row per run, then why one is invalid or not quite the controller's."""
    if any(run['mode'] == 'realtime' for run in runs):
        columns = [*columns[:-1], *REALTIME_COLUMNS, columns[-1]]
    table = Table(title=title, box=box.SIMPLE, pad_edge=False, collapse_padding=True)
    for column in columns:
        table.add_column(column.heading, justify='right' if column.number else 'left')
    for run in runs:
        table.add_row(*(Text(column.cell(run)) for column in columns))
    console = Console(
        file=stream, width=None if stream.isatty() else _PIPED_WIDTH, highlight=False
    )
    console.print(table)
    for run in runs:
        if not run['valid']:
            _note(console, f'{run["bag"]}: not valid: {run["reason"]}')
        elif run['fallbacks']:
            _note(console, f'{run["bag"]}: {fallback_note(run)}')


def fallback_note(run: Entry) -> str:
    """Return what to know of a run whose controller had to do without a solution."""
    return (
        f'at {run["fallbacks"]} of {run["metrics"]["steps"]} steps its program had no solution in '
        'time: the figures are partly those of its fallback'
    )


def _note(console: Console, text: str) -> None:
    console.print(Text(printable(text), 'bold'), soft_wrap=True)


def _safe_state(run: Entry) -> str:
    return UNDEFINED if run['safe_state'] is None else run['safe_state'] or 'none'


def _in_ms(time_us: float | None) -> float | None:
    return None if time_us is None else time_us / 1e3


def _text(value: Any, form: str) -> str:
    return UNDEFINED if value is None else form.format(value)
