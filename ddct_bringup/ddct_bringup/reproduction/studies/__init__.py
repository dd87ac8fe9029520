# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of closed-loop runs on the causes of the predictive controllers' results."""
