"""What a predictive controller of the clutch torque is told, and what its model holds."""

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Any

from ddct_controllers.mpc.options import switch_option
from ddct_plant.base.checks import require_choice

MEASURED_SIGNALS = ('slip', 'speeds')


@dataclass(frozen=True)
class Knowledge:
    """Signals and model; C_m and C_fOL are always known."""

    measured: str
    """`slip`, w_d alone, or `speeds`, w_m, w_p and w_r; each with the filter that it takes."""
    load_known: bool
    """Whether C_load, computed from V_x and the slope, is an input of the model."""
    delay_in_model: bool
    """Whether the model has the actuator's delay of 10 ms, beside G_a(s)."""


AS_DRAWN = Knowledge('slip', load_known=False, delay_in_model=False)
"""Figure 4.2: mo is w_d, md is C_m; the plant of Section 3.2.1.3 is P_2 G_a."""
FULL = Knowledge('speeds', load_known=True, delay_in_model=True)
"""All that the car measures and the plant does."""
KEYS = tuple(field.name for field in fields(Knowledge))
"""Keys of `controllers.<name>`."""


def with_knowledge(name: str, default: Knowledge, options: Mapping[str, Any]) -> Knowledge:
    """Return `default` changed by `controllers.<name>`; raise ParameterError for a bad value."""
    measured = options.get('measured', default.measured)
    require_choice(f'controllers.{name}.measured', str(measured), MEASURED_SIGNALS)
    switches = {
        key: switch_option(name, options, key, getattr(default, key))
        for key in KEYS
        if key != 'measured'
    }
    return replace(default, measured=measured, **switches)
