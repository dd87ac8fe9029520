"""Engine: a torque that follows the driver's demand, a fixed profile over time (Section 1.4.3)."""

from collections.abc import Sequence
from dataclasses import dataclass

from ddct_plant.checks import require_number
from ddct_plant.errors import ParameterError
from ddct_plant.timebase import time_of_step


@dataclass(frozen=True)
class TorqueProfile:
    """Engine torque over scenario time, linear between its points and constant outside them."""

    time_s: tuple[float, ...]
    """Scenario times in s, strictly increasing."""
    torque_n_m: tuple[float, ...]
    """C_m in N m at those times, not negative."""

    def __post_init__(self) -> None:
        """Check the points; raise ParameterError that names the first bad one."""
        _require_points('engine.time_s', self.time_s, at_least=None)
        _require_points('engine.torque_n_m', self.torque_n_m, at_least=0.0)
        if len(self.time_s) != len(self.torque_n_m):
            raise ParameterError(
                f'engine has {len(self.time_s)} times and {len(self.torque_n_m)} torques: '
                'give one torque for each time'
            )
        for earlier, later in zip(self.time_s, self.time_s[1:], strict=False):
            if later <= earlier:
                raise ParameterError(
                    f'engine.time_s goes from {earlier:g} to {later:g}: it must rise'
                )


def _require_points(name: str, values: Sequence[float], at_least: float | None) -> None:
    if not values:
        raise ParameterError(f'{name} is empty: give at least one point')
    for index, value in enumerate(values):
        require_number(f'{name}[{index}]', value, at_least=at_least)


class Engine:
    """
    The thesis's engine: it delivers the demanded torque C_m at once (Section 1.4.3).

    Torque is held over the 10 ms period that starts at its stamp.
    """

    def __init__(self, profile: TorqueProfile) -> None:
        self._profile = profile

    def demand(self, step: int) -> float:
        """Return the driver's torque demand in N m at step `step`."""
        times, torques = self._profile.time_s, self._profile.torque_n_m
        time = time_of_step(step)
        if time <= times[0]:
            return torques[0]
        for index in range(1, len(times)):
            if time < times[index]:
                share = (time - times[index - 1]) / (times[index] - times[index - 1])
                return torques[index - 1] + share * (torques[index] - torques[index - 1])
        return torques[-1]

    def torque(self, step: int) -> float:
        """Return the torque C_m in N m delivered over the period of step `step`."""
        return self.demand(step)
