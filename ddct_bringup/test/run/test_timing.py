# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`timing.json` is read back, and unusable content is an error."""

import json

import pytest

from ddct_bringup.run.timing_and_failure import RunTiming, read_timing
from ddct_plant.base.errors import DdctError
from ddct_plant.files.json_records import to_json


def test_what_the_recorder_wrote_is_read_back(tmp_path):
    timing = RunTiming(
        update_times_us=[1.5, 2.5],
        missed_steps=1,
        resends=2,
        late_messages=3,
        refused_messages=4,
        safe_states={'/actuator': 1870000000},
        lateness_us=[12.5, 0.0],
        latency_us=[812.5, 2500.0, 30.25],
        steps=300,
    )
    timing.write(tmp_path)
    assert read_timing(tmp_path) == timing


def test_a_folder_without_timing_gives_none(tmp_path):
    assert read_timing(tmp_path) is None


def changed(**values):
    return json.dumps({**to_json(RunTiming(update_times_us=[1.5], steps=1)), **values})


@pytest.mark.parametrize(
    'text',
    [
        *('', '{}', '[]', '{"update_times_us": 3}', '\x00'),
        changed(update_times_us=['nan']),
        changed(update_times_us=[float('nan')]),
        changed(wall_time_s=float('inf')),
        changed(wall_time_s=-1.0),
        changed(update_times_us=[1.0, -1.0]),
        changed(safe_states={'/actuator': -1}),
        changed(unknown=1),
        changed(missed_steps=-1),
        changed(missed_steps='many'),
        changed(steps=None),
        changed(latency_us={'latency': 3}),
        changed(latency_us=[1.0, -1.0]),
        changed(lateness_us=[-1.0]),
        changed(lateness_us=[float('nan')]),
        changed(steps=1)[:-1] + ', "steps": 2}',
    ],
)
def test_unusable_timing_is_an_error_that_names_the_file(tmp_path, text):
    (tmp_path / 'timing.json').write_text(text, encoding='utf-8')
    with pytest.raises(
        DdctError, match=r'timing\.json: .*: delete it to score without$'
    ) as caught:
        read_timing(tmp_path)
    assert caught.value.place == str(tmp_path / 'timing.json')
