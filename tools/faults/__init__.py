# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The hundred faults on the real graph that differ in cause, each beside its stated outcome."""
