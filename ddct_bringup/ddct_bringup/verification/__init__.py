# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Verify results: repeat the runs of a folder headless and compare them."""

from typing import TYPE_CHECKING

from ddct_plant.base.late_names import late_names

if TYPE_CHECKING:
    from ddct_bringup.verification.text import complaints, print_verification
    from ddct_bringup.verification.verified import verified_results
else:
    __getattr__, __dir__, __all__ = late_names(__name__)
