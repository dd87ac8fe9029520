# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Programs that score runs and write campaigns do so without slow libraries."""

import os
import subprocess
import sys
from pathlib import Path

from waiting import WITHIN_S

SCORED = """
import sys
from ddct_bringup.programs.ddct import main
code = main()
assert 'scipy.signal' not in sys.modules
assert 'scipy.stats' not in sys.modules
sys.exit(code)
"""


def test_a_program_that_scores_a_run_does_without_the_slow_parts_of_scipy(tmp_path):
    words = ['compare', '--headless', '--controllers', 'pi', '--out', str(tmp_path / 'out')]
    done = subprocess.run(
        [sys.executable, '-P', '-c', SCORED, *words],
        capture_output=True,
        text=True,
        timeout=WITHIN_S,
        check=False,
        env=os.environ,
    )
    assert done.returncode == 0, done.stderr


def test_a_worker_writes_and_a_page_reads_rows_without_pandas_or_scipy_stats(
    tmp_path: Path,
) -> None:
    code = (
        'import sys\nfrom pathlib import Path\n'
        'from ddct_bringup.campaign.conduct import carry_out\n'
        'from ddct_bringup.campaign.campaign import Campaign\n'
        'from ddct_bringup.campaign.spec import spec_of\n'
        'from ddct_bringup.campaign_report.folder import write_campaign_page\n'
        'from ddct_bringup.verdict.limits import packaged_limits\n'
        "content = {'controllers': ['pi', 'ls8'], 'grid': {'wear_gain': [0.8, 0.9, 1.0, 1.1]}}\n"
        'out = Path(sys.argv[1])\n'
        'made = Campaign(spec_of(content, Path()))\n'
        'carry_out(made, packaged_limits(), out, workers=1)\n'
        'write_campaign_page(out)\n'
        "assert not {'pandas', 'scipy.stats'} & set(sys.modules)\n"
    )
    done = subprocess.run(
        [sys.executable, '-c', code, str(tmp_path / 'out')], capture_output=True, check=False
    )
    assert done.returncode == 0, done.stderr.decode()
