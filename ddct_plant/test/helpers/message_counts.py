# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Number of messages by topic in a bag, by the MCAP library alone."""

from pathlib import Path

from mcap.reader import make_reader


def message_counts(bag: Path) -> dict[str, int]:
    """Return the numbers of a finished bag, given by its folder or by the file in it."""
    (file,) = bag.glob('*.mcap') if bag.is_dir() else [bag]
    with file.open('rb') as stream:
        summary = make_reader(stream).get_summary()
    assert summary and summary.statistics
    counts = summary.statistics.channel_message_counts
    return {
        channel.topic: counts[key] for key, channel in summary.channels.items() if counts.get(key)
    }
