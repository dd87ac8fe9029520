# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""States of a repeated result, and the bound of comparisons; cheap to import."""

SAME_BITS, SAME_WITHIN, DIFFERENT = 'same_bits', 'same_within', 'different'
"""States of a comparison."""
NOT_REPEATED = 'not_repeated'
"""State of what was not made again, or made and not compared."""
BOUND = 1e-9
"""
Largest difference of two numbers that are the same, relative to the largest magnitude.

That is the larger magnitude of a single number, and the largest in the run of a signal; 1 in its
unit where it is smaller.
"""
