"""Clutch: what the actuator's torque becomes between the plates."""

from collections.abc import Sequence

from ddct_plant.base.options import Option

LINEAR, STICK_SLIP = CLUTCHES = ('linear', 'stick_slip')
"""Names of the clutch models that `--clutch` takes."""
WEAR_GAIN = Option(
    1.0, 'K_usura, wear gain of the clutch, 1 for a new one', above=0.0, at_most=3.0
)


class LinearClutch:
    """
    The thesis's clutch: it transmits the actuator's torque times the wear gain K_usura.

    The thesis has K_usura inside the actuator, before the delay and G_a(s) (Section 1.4.2); a
    constant gain commutes with both, so here it is the clutch's, whose friction wears.
    """

    def __init__(self, wear_gain: float = WEAR_GAIN.default) -> None:
        self._wear_gain = WEAR_GAIN.checked('wear_gain', wear_gain)

    def transmit(self, actuator_torque: Sequence[float]) -> list[float]:
        """Return the transmitted torque in N m at the same instants as `actuator_torque`."""
        return [self._wear_gain * torque for torque in actuator_torque]
