# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The records of tried cases: a JSON file by the names of the cases, in their order."""

import json
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from faults.campaign.case import Case
from faults.campaign.outcome import Observed

_FOLDER = re.compile(r'/\S*?(faults-\w+/(run/)?|/build/(?=ddct_\w+/ddct_))')
"""Path of the temporary folder of a case, or of the folder that has the packages."""

Records = dict[str, dict[str, Any]]
"""Facts of tried cases, by the names of the cases."""


def record_of(case: Case, seen: Observed, as_stated: bool, tries: int) -> dict[str, Any]:
    """Return the facts of a tried case for the JSON file."""
    return {
        'fault': case.fault,
        'target': case.target,
        'instant': case.instant,
        'mode': case.mode,
        'clutches': case.clutches,
        'stated': case.stated.text,
        'as_stated': as_stated,
        'outcome': _FOLDER.sub('', seen.summary()),
        'tries': tries,
    }


def not_tried(case: Case) -> dict[str, Any]:
    """Return the record of a case that was not tried yet."""
    return record_of(case, Observed(error='not tried yet'), False, 0)


def read_records(file: Path) -> Records:
    """Return the records in a file, none where it does not exist."""
    if not file.exists():
        return {}
    records: Records = json.loads(file.read_text(encoding='utf-8'))
    return records


def write_records(
    file: Path, records: Mapping[str, dict[str, Any]], cases: Iterable[Case]
) -> None:
    """Write the records of all cases that the campaign has, those of other outcomes anew."""
    kept = {}
    for case in cases:
        record = records.get(case.name, {})
        known = record.get('stated') == case.stated.text
        kept[case.name] = record if known else not_tried(case)
    file.write_text(json.dumps(kept, indent=1, ensure_ascii=False) + '\n', encoding='utf-8')
