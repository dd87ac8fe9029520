# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Parts that several controllers of the state of the art share."""
