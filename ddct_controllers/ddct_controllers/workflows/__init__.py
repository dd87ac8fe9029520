# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `design`: from specifications to a verified controller, and its robustness."""

from typing import TYPE_CHECKING

from ddct_plant.base.late_names import late_names

if TYPE_CHECKING:
    from ddct_controllers.workflows import (
        h_infinity_command,
        loop_shaping_command,
        loop_summary,
        margins_command,
        mpc_command,
        plant_command,
    )
else:
    __getattr__, __dir__, __all__ = late_names(__name__)
