"""What a predictive controller of the clutch torque is told, and what its model holds."""

from dataclasses import dataclass

from ddct_plant.base.options import REQUIRED, OptionGroup, option

MEASURED_SIGNALS = ('slip', 'speeds')


@dataclass(frozen=True)
class Knowledge(OptionGroup):
    """Signals, each set with the filter that it takes, and model; C_m, C_fOL are always known."""

    measured: str = option(
        REQUIRED,
        '`slip` is w_d alone, `speeds` are w_m, w_p and w_r',
        kind=str,
        choices=MEASURED_SIGNALS,
    )
    load_known: bool = option(
        REQUIRED,
        'whether C_load, computed from V_x and the slope, is an input of the model',
        kind=bool,
    )
    delay_in_model: bool = option(
        REQUIRED, 'whether the model has the delay of 10 ms, beside G_a(s)', kind=bool
    )


AS_DRAWN = Knowledge('slip', load_known=False, delay_in_model=False)
"""Figure 4.2: mo is w_d, md is C_m; the plant of Section 3.2.1.3 is P_2 G_a."""
FULL = Knowledge('speeds', load_known=True, delay_in_model=True)
"""All that the car measures and the plant does."""
