# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The examples of the pages run: Python, specifications, and diffs that add something."""

import re
import subprocess
from pathlib import Path

import pytest
from extras import needs
from support.documented import ROOT, blocks, package_page, run_examples

from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.spec import read_spec
from ddct_controllers.from_file.designed import load_designed
from ddct_controllers.printed import PRINTED_CONTROLLERS

PACKAGES = ('ddct_plant', 'ddct_reference', 'ddct_controllers', 'ddct_bringup')


@pytest.mark.slow
@pytest.mark.parametrize(
    'page',
    [
        'README.md',
        'docs/controllers/writing.md',
        pytest.param('docs/controllers/files.md', marks=pytest.mark.nightly),
    ],
)
def test_python_examples_run(page: str, tmp_path: Path) -> None:
    """Those of docs/use/python.md take longer: `tests/nightly/docs` runs them."""
    run_examples(page, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize(
    'part', ['class Mine(PolicyController)', pytest.param('step([', marks=needs('gymnasium'))]
)
def test_the_policies_of_the_page_print_what_their_comments_say(
    part: str, capsys: pytest.CaptureFixture[str]
) -> None:
    page = 'docs/use/python.md'
    (text,) = (each.text for each in blocks() if each.page == page and part in each.text)
    exec(compile(text, page, 'exec'), {'__name__': 'example'})
    _, _, comment = text.rstrip().rpartition('# ')
    assert capsys.readouterr().out.startswith(comment.removesuffix('...'))


@pytest.mark.parametrize('package', PACKAGES)
def test_the_example_of_a_package_runs_without_ros(
    package: str, capsys: pytest.CaptureFixture[str]
) -> None:
    (example,) = re.findall(r'```python\n(.*?)```', package_page(package), re.DOTALL)
    exec(compile(example, f'{package}/README.md', 'exec'), {})
    assert re.search(r'-?\d+\.\d', capsys.readouterr().out)


def test_the_file_of_a_transfer_function_is_ls7(tmp_path: Path) -> None:
    page = ROOT / 'docs' / 'controllers' / 'pi_and_loop_shaping.md'
    text = page.read_text(encoding='utf-8').split('```yaml\n')[1].split('```')[0]
    path = tmp_path / 'mine.yaml'
    path.write_text(text, encoding='utf-8')
    assert load_designed(str(path)).transfer_function == PRINTED_CONTROLLERS['ls7']


@pytest.mark.parametrize('path', sorted((ROOT / 'docs' / 'examples').glob('robustness_*.yaml')))
def test_the_specifications_of_the_robustness_map_can_be_run(path: Path) -> None:
    campaign = Campaign(read_spec(path))
    settings = campaign.run(campaign.runs - 1).settings
    assert campaign.runs > 1000 and settings.scenario.name == 'thesis'


def test_the_diff_that_adds_a_metric_fits_the_code() -> None:
    """`tests/nightly/docs` tries what it gives."""
    page = (ROOT / 'CONTRIBUTING.md').read_text(encoding='utf-8')
    diff = page.partition('\n### A metric\n')[2].partition('```diff\n')[2].partition('```')[0]
    command = ['git', 'apply', '--check', '-']
    done = subprocess.run(command, input=diff, text=True, cwd=ROOT, check=False)
    assert diff and done.returncode == 0
