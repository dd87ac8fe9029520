# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The search over score windows and starts finds the packaged scenario `thesis` again."""

from calibrate.__main__ import main


def test_the_whole_search_ends_at_the_packaged_scenario() -> None:
    assert main([]) == 0
