"""Reading `timing.json`."""

import pytest

from ddct_bringup.run.run_timing import RunTiming
from ddct_bringup.run.timing_file import read_timing
from ddct_plant.errors import DdctError


def test_what_the_recorder_wrote_is_read_back(tmp_path):
    timing = RunTiming([1.5, 2.5], missed_steps=1, resends=2, late_messages=3, steps=300)
    timing.write(tmp_path)
    assert read_timing(tmp_path) == timing


def test_a_folder_without_timing_gives_none(tmp_path):
    assert read_timing(tmp_path) is None


@pytest.mark.parametrize('text', ['', '{}', '[]', '{"update_times_us": 3}', '\x00'])
def test_unusable_timing_is_an_error_that_names_the_file(tmp_path, text):
    (tmp_path / 'timing.json').write_text(text, encoding='utf-8')
    with pytest.raises(DdctError, match='timing.json: not the timing of a run'):
        read_timing(tmp_path)
