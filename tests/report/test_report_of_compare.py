"""`compare` leaves the report beside the bags, with the evidence it has just written."""

from pathlib import Path

import pytest

from ddct_bringup.programs.compare import main


def test_compare_ends_with_the_report(tmp_path: Path) -> None:
    pytest.importorskip('rclpy', reason='rclpy serialises the messages')
    out = tmp_path / 'demo'
    assert main(['--controllers', 'pi,ls8', '--headless', '--out', str(out)]) == 0
    page = (out / 'report.html').read_text(encoding='utf-8')
    assert '<title>Clutch engagement, thesis: pi, ls8</title>' in page
    assert 'Computed for this page' not in page
