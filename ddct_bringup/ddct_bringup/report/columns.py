"""The columns of the page's tables: what each figure is called, and how it is printed."""

from dataclasses import dataclass

from ddct_bringup.verdict.comfort import VDV_WEIGHTING


@dataclass(frozen=True)
class FigureColumn:
    """A figure as the page shows it."""

    key: str
    """Name in `scores.json` or `frequency.json`."""
    symbol: str
    """An underscore begins the index."""
    unit: str
    form: str
    """Format of the number."""
    meaning: str

    def text(self, value: float | None) -> str:
        """Return a value as it is printed."""
        return number_text(value, self.form)


TABLE_5_1 = (
    FigureColumn('engagement_time_s', 't_a', 's', '.3f', 'Control start to w_d = 0'),
    FigureColumn(
        'torsion_speed_std_rpm',
        'σ w_sr',
        'rpm',
        '.3f',
        'Standard deviation of w_sr over the score window',
    ),
    FigureColumn(
        'acceleration_std_m_s2',
        'σ A_x',
        'm/s²',
        '.3f',
        'Standard deviation of A_x over the score window',
    ),
)
"""The metrics that the thesis prints."""

FURTHER = (
    FigureColumn(
        'slip_rmse_rpm', 'RMSE w_d', 'rpm', '.2f', 'Reference less w_d over the score window'
    ),
    FigureColumn('slip_final_rpm', 'final w_d', 'rpm', '.2f', 'Last sample'),
    FigureColumn(
        'peak_jerk_m_s3',
        'peak jerk',
        'm/s³',
        '.2f',
        'A_x through a 20 Hz low-pass without delay, over the score window',
    ),
    FigureColumn(
        'vdv_m_s1_75',
        'VDV',
        'm/s¹·⁷⁵',
        '.3f',
        f'Vibration dose over the score window, weighted by {VDV_WEIGHTING}',
    ),
    FigureColumn(
        'weighted_acceleration_m_s2',
        'weighted A_x',
        'm/s²',
        '.3f',
        'Root of the mean square over the score window, weighted as VDV',
    ),
    FigureColumn(
        'friction_energy_j',
        'friction energy',
        'J',
        '.0f',
        'Friction work of the clutch, whole run',
    ),
    FigureColumn(
        'lockup_slip_acceleration_rad_s2',
        'dw_d/dt at lock-up',
        'rad/s²',
        '.2f',
        'Slope of w_d where it first changes its sign',
    ),
    FigureColumn(
        'torque_total_variation_n_m',
        'variation C_f',
        'N m',
        '.0f',
        'Sum of all changes of the torque request, whole run',
    ),
    FigureColumn('steps', 'steps', '', '.0f', 'Periods of 10 ms'),
)
"""The other metrics but those of `timing.json`."""

LOOP_COLUMNS = (
    FigureColumn(
        'gain_margin_db', 'GM', 'dB', '.1f', 'Least increase of the gain that makes it unstable'
    ),
    FigureColumn('phase_margin_deg', 'PM', '°', '.1f', 'Least change of phase that does'),
    FigureColumn('delay_margin_s', 'DM', 's', '.3f', 'Least additional delay that does'),
    FigureColumn('disk_margin', 'disk', '', '.2f', 'Disk margin α = 2 / max |S − T|'),
    FigureColumn('sensitivity_peak', 'M_s', '', '.2f', 'Peak of |1/(1 + L)|'),
    FigureColumn('complementary_peak', 'M_t', '', '.2f', 'Peak of |L/(1 + L)|'),
    FigureColumn('crossover_rad_s', 'w_c', 'rad/s', '.2f', 'Highest frequency with |L| = 1'),
    FigureColumn('bandwidth_rad_s', 'w_b', 'rad/s', '.2f', 'Lowest frequency with |T| below 0.71'),
    FigureColumn(
        'driveline_mode_hz', 'mode', 'Hz', '.2f', 'Closed-loop pole pair nearest the zeros of P_2'
    ),
    FigureColumn('driveline_mode_damping', 'damping', '', '.3f', 'Of that mode'),
)
"""The figures of a loop, by their names in `frequency.json`."""


def number_text(value: float | None, form: str) -> str:
    """Return a number in a format, or a dash for what does not exist or has no limit."""
    return '–' if value is None else format(value, form)
