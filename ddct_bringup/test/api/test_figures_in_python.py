# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Figures of the thesis and of campaigns in Python are those of the programs."""

from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from made_campaign import leave_out_figure

from ddct_bringup.api import (
    DdctError,
    ParameterError,
    campaign,
    campaign_figure,
    document,
    thesis_figure,
)
from ddct_bringup.documents.chart import Chart, legend

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SPEC = {'controllers': ['pi', 'ls8'], 'grid': {'wear_gain': [0.9, 1.0, 1.1]}}


def curves(figure: 'Figure') -> set[str]:
    return {str(line.get_label()) for axes in figure.axes for line in axes.get_lines()}


def test_a_figure_of_the_thesis_comes_with_what_agrees() -> None:
    figure, remark = thesis_figure('2.10')
    assert figure.get_suptitle() == 'Figure 2.10: Step response with G_c2(s)'
    assert 'the thesis prints 0.52 s' in remark


@pytest.mark.parametrize(
    ('number', 'why'), [('1.9', 'a block diagram'), ('9.9', 'figure of the thesis')]
)
def test_a_figure_that_cannot_be_drawn_or_does_not_exist_is_refused(number: str, why: str) -> None:
    with pytest.raises(ParameterError, match=why):
        thesis_figure(number)


@pytest.mark.slow
def test_the_figure_of_a_campaign_has_a_curve_of_each_controller(tmp_path: Path) -> None:
    with pytest.MonkeyPatch.context() as patch:
        leave_out_figure(patch)
        campaign(SPEC, tmp_path / 'out', workers=1)
    assert {'pi', 'ls8'} <= curves(campaign_figure(tmp_path / 'out'))
    shown = document(tmp_path / 'out').figure('Distributions').draw()
    assert isinstance(shown, Chart)  # which a notebook shows as a picture
    assert {'pi', 'ls8'} <= {key.label for key in legend(shown)}


def test_the_figure_of_a_folder_without_a_campaign_is_refused(tmp_path: Path) -> None:
    with pytest.raises(DdctError):
        campaign_figure(tmp_path)
