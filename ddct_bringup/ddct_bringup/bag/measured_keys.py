# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Keys under `run` of a column map: the facts of a run that its log does not contain."""

from dataclasses import dataclass

from ddct_bringup.bag.run_facts import MEASURED
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import OptionGroup, option
from ddct_plant.models.gearbox import EngagedGear


@dataclass(frozen=True)
class MeasuredKeys(OptionGroup, prefix='run.'):
    """Keys under `run` of a column map, with their defaults and ranges."""

    controller: str = option(MEASURED, 'name of the controller in tables', kind=str)
    scenario: str = option(
        MEASURED, 'name of the drive in tables; logs of one name are comparable'
    )
    start_s: float | None = option(
        None, "the log's time at scenario time 0", 's', otherwise='that of the first row'
    )
    control_start_s: float = option(
        0.0,
        'scenario time at which the engagement begins, a multiple of 10 ms',
        's',
        at_least=0.0,
        whole_periods=True,
    )
    score_window_s: tuple[float, ...] = option(
        (),
        '`[first, last]` sample of the figures over a window, multiples of 10 ms; none: control '
        'start to the end',
        's',
        many=True,
        at_least=0.0,
        rising=True,
        whole_periods=True,
    )
    total_ratio: float | None = option(
        None, 'w_p over w_r with a stiff driveshaft; w_sr needs it', above=0.0
    )
    wear_gain: float = option(1.0, 'wear gain of the clutch in tables', above=0.0, at_most=3.0)

    def __post_init__(self) -> None:
        """Check every option; raise ParameterError that names a bad one."""
        super().__post_init__()
        if self.score_window_s and len(self.score_window_s) != 2:
            raise ParameterError('run.score_window_s: give two times, [first, last]')

    @property
    def gear(self) -> EngagedGear | None:
        """Engaged gear of the log, None where no total ratio is given."""
        return None if self.total_ratio is None else EngagedGear(self.total_ratio)

    def require_within(self, duration_s: float) -> None:
        """Raise ParameterError for an engagement or a score window beyond the end of the log."""
        if self.control_start_s >= duration_s:
            raise ParameterError(
                f'run.control_start_s is {self.control_start_s:g} s, but the log ends '
                f'{duration_s:g} s after scenario time 0: give a time before that'
            )
        if not self.score_window_s:
            return
        first_s, last_s = self.score_window_s
        if last_s > duration_s or last_s <= self.control_start_s:
            raise ParameterError(
                f'run.score_window_s is [{first_s:g}, {last_s:g}] s, but the log has '
                f'{self.control_start_s:g} s (run.control_start_s) to {duration_s:g} s: give a '
                'window that ends within'
            )
