# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Write the definitions of the message types of all topics into the package, by rosbags."""

from ddct_plant.bag_file.message_definitions import KEPT, all_types, definition_in
from ddct_plant.files.json_records import write_json
from ddct_plant.signals.topics import TOPICS


def main() -> int:
    """Write the file."""
    types = sorted({topic.type for topic in TOPICS})
    write_json(str(KEPT), {each: definition_in(all_types(), each) for each in types})
    return 0


if __name__ == '__main__':
    raise SystemExit(main())
