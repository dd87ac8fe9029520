# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Names of the clutch models, and the option of their wear; cheap to import."""

from ddct_plant.base.options import Option

LINEAR, STICK_SLIP = CLUTCHES = ('linear', 'stick_slip')
"""Names of the clutch models, values of the scenario key `clutch`."""
WEAR_GAIN = Option(
    1.0, 'K_usura, wear gain of the clutch, 1 for a new one', above=0.0, at_most=3.0
)
