"""The columns of the table of frequency-domain evidence, and what they take of an entry."""

from typing import Any

from ddct_plant.base.checks import require_number
from ddct_plant.base.errors import ParameterError

LOOP_COLUMNS = (
    ('gain_margin_db', 'GM', 'dB', '.1f', 'Least increase of the gain that makes it unstable'),
    ('phase_margin_deg', 'PM', '°', '.1f', 'Least change of phase that does'),
    ('delay_margin_s', 'DM', 's', '.3f', 'Least additional delay that does'),
    ('disk_margin', 'disk', '', '.2f', 'Disk margin α = 2 / max |S − T|'),
    ('sensitivity_peak', 'M_s', '', '.2f', 'Peak of |1/(1 + L)|'),
    ('complementary_peak', 'M_t', '', '.2f', 'Peak of |L/(1 + L)|'),
    ('crossover_rad_s', 'w_c', 'rad/s', '.2f', 'Highest frequency with |L| = 1'),
    ('bandwidth_rad_s', 'w_b', 'rad/s', '.2f', 'Lowest frequency with |T| below 0.71'),
    ('driveline_mode_hz', 'mode', 'Hz', '.2f', 'Closed-loop pole pair nearest the zeros of P_2'),
    ('driveline_mode_damping', 'damping', '', '.3f', 'Of that mode'),
)
"""Key of the evidence, symbol, unit, format and meaning."""


def is_whole(entry: Any, wear_gain: float) -> bool:
    """Say whether an entry that stood in a file holds everything that the page shows of it."""
    try:
        if entry['linear'] is not True:
            return entry['linear'] is False and not entry['wear']
        point = next(each for each in entry['wear'] if each['wear_gain'] == wear_gain)
        interval = entry['stable_wear_gain'] or {}
        for value in (
            *(point[key] for key, *_ in LOOP_COLUMNS),
            *(interval.get(end) for end in ('lowest', 'highest')),
            entry['corners']['sensitivity_peak'],
        ):
            if value is not None:
                require_number('evidence', value)
        return isinstance(point['stable'], bool) and isinstance(entry['corners']['unstable'], int)
    except (LookupError, TypeError, AttributeError, StopIteration, ParameterError):
        return False
