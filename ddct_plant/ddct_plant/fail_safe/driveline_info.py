"""What the driveline says of itself, in a graph or without one."""

from ddct_plant.fail_safe.request_watch import CLUTCH_TIMEOUT_S, FailSafeSettings


def driveline_info(steps: int, clutch: FailSafeSettings | None = None) -> dict[str, str]:
    """Return N, and when and how fast it opens the clutch in real time."""
    clutch = clutch or FailSafeSettings(CLUTCH_TIMEOUT_S)
    return {
        'steps': str(steps),
        'clutch_timeout_s': repr(clutch.request_timeout_s),
        'fail_safe_ramp_n_m_s': repr(clutch.fail_safe_ramp_n_m_s),
    }
