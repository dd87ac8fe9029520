# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Limits of what a bag unpacks to, by its planned duration and by the size of its file.

Both count, as a small file may claim any duration. What recorders write beside each message is
not compressed, so that a file of a given size has so many messages at most.
"""

from ddct_plant.base.timebase import LONGEST_S, STEPS_PER_S

MOST_UNPACKED_BYTES = 8_000_000_000
"""Largest size in bytes of all chunks of a bag, unpacked; an hour's run has a third of that."""
MOST_STEP_BYTES = 100_000
"""Largest mean size in bytes of a step of a run, unpacked; a usual step has 5000."""
SPARE_BYTES = 10_000_000
"""Size in bytes that a bag may have besides its steps: parameters, reports and definitions."""
MOST_STEP_RECORDS = 200
"""Largest mean number of records of a step of a run; a usual step has 15."""
SPARE_RECORDS = 10_000
"""Number of records that a bag may have besides its steps."""
MOST_CHANNELS = 1000
"""Largest number of channels; a run has 16 to 40."""
_STEP_IN_FILE = 80
"""Least size in bytes of a step in a file; a usual step has 600."""
_RECORD_IN_FILE = 16
"""Least size in bytes of a message in a file: that of its entry in the index of its chunk."""


class Allowance:
    """What may still be unpacked of a bag, while it is read."""

    def __init__(self, file_size: int, steps: int | None) -> None:
        """Begin with a file of `file_size` bytes, and the planned number of periods if known."""
        self._size = file_size
        longest = int(LONGEST_S) * STEPS_PER_S if steps is None else steps
        in_file = min(longest, file_size // _STEP_IN_FILE)
        self._most_bytes = min(MOST_UNPACKED_BYTES, SPARE_BYTES + in_file * MOST_STEP_BYTES)
        self._bytes = 0
        self.most_records = SPARE_RECORDS + min(
            longest * MOST_STEP_RECORDS, file_size // _RECORD_IN_FILE
        )
        self.records = 0
        """Number of records so far."""

    def add_bytes(self, count: int) -> None:
        """Count the bytes of an unpacked chunk; raise ValueError beyond the limit."""
        self._bytes += count
        if self._bytes > self._most_bytes:
            raise ValueError(
                f'its chunks have {self._bytes} bytes unpacked, more than the {self._most_bytes} '
                f'of such a run in a file of {self._size} bytes'
            )

    def add_record(self) -> None:
        """Count a record; raise ValueError beyond the limit."""
        self.records += 1
        if self.records > self.most_records:
            raise ValueError(
                f'it has more than the {self.most_records} records of such a run in a file of '
                f'{self._size} bytes'
            )
