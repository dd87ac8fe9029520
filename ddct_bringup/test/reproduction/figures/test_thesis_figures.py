# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Figures of the thesis that need no run: the data of their lines, and the command's files."""

import csv
import re
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

from ddct_bringup.programs import thesis
from ddct_bringup.reproduction.figures.command import collect_figures
from ddct_bringup.reproduction.figures.gallery import gallery_page
from ddct_bringup.reproduction.figures.h_infinity_figures import H_INFINITY_FIGURES
from ddct_bringup.reproduction.figures.loop_shaping_figures import LOOP_SHAPING_FIGURES
from ddct_bringup.reproduction.figures.thesis_figure import ThesisFigure
from ddct_bringup.reproduction.study_run import thesis_run
from ddct_controllers.design.analysis.loop_curve import LoopCurve
from ddct_controllers.design.analysis.loops import continuous_loop
from ddct_controllers.design.analysis.step_response import step_response
from ddct_controllers.design.drawing.chart_style import typeset
from ddct_controllers.design.drawing.nichols import nichols_curve
from ddct_controllers.design.loop_shaping.specifications import rise_time_crossover_product
from ddct_controllers.printed import PRINTED_CONTROLLERS
from ddct_controllers.registry import controller_spec
from ddct_plant.linear.lti import FactoredTransferFunction

if TYPE_CHECKING:
    from matplotlib.figure import Figure

pytestmark = pytest.mark.slow

TRANSFER_FUNCTION = Path(__file__).parents[4] / 'docs' / 'templates' / 'transfer_function.yaml'
WITHOUT_RUN = (*LOOP_SHAPING_FIGURES, *H_INFINITY_FIGURES)


def drawing(number: str) -> 'tuple[Figure, str]':
    """Return the chart of a figure and the remark on it."""
    return next(figure for figure in WITHOUT_RUN if figure.number == number).draw()


def line(figure: 'Figure', label: str, panel: int = 0) -> np.ndarray:
    """Return x and y of the line with this label, (2, n)."""
    lines = {found.get_label(): found for found in figure.axes[panel].get_lines()}
    return np.array(lines[label].get_data())


def labels(figure: 'Figure', panel: int = 0) -> tuple[str, str]:
    return figure.axes[panel].get_xlabel(), figure.axes[panel].get_ylabel()


def test_rise_time_figure_is_the_prototypes_curve_with_a_remark_on_2_02():
    chart, remark = drawing('2.2')
    damping, product = line(chart, 'second-order prototype')
    expected = [rise_time_crossover_product(value) for value in damping]
    np.testing.assert_allclose(product, expected, rtol=1e-12)
    assert labels(chart) == ('Damping ratio ζ', 't_r ω_c, rad')
    assert 'ζ = 0.63' in remark


@pytest.mark.parametrize(('number', 'gain', 'unstable'), [('2.3', 1.0, 1), ('2.4', -1.0, 2)])
def test_nyquist_figure_contains_the_loop_and_has_the_thesis_s_encirclements(
    number, gain, unstable
):
    chart, remark = drawing(number)
    real, imaginary = line(chart, 'ω > 0', panel=1)
    loop = continuous_loop(FactoredTransferFunction(gain, (), (0.0,)))
    for omega in (0.5, 5.0, 20.0):
        value = loop.response(np.array(omega))
        distance = np.abs(real + 1j * imaginary - value).min()
        assert distance < 2e-3 * abs(value)
    assert f'P_cl = {unstable};' in remark
    assert labels(chart, panel=1) == ('Re L', 'Im L')


@pytest.mark.parametrize(
    ('number', 'label', 'change'), [('2.5', 'm_d = 16', 1.0), ('2.6', 'm_i = 16', -1.0)]
)
def test_network_of_ratio_16_changes_the_gain_by_24_db_and_the_phase_by_62_degrees(
    number, label, change
):
    figure = drawing(number)[0]
    magnitude, phase = (line(figure, label, panel)[1] for panel in (0, 1))
    assert magnitude[-1] == pytest.approx(change * 20.0 * np.log10(16.0), abs=0.01)
    assert change * phase[np.argmax(np.abs(phase))] == pytest.approx(61.93, abs=0.01)
    assert [labels(figure, panel)[1] for panel in (0, 1)] == ['Magnitude, dB', 'Phase, °']


@pytest.mark.parametrize(
    ('number', 'label', 'controller'),
    [('2.8', 'G_c1', 'ls2'), ('2.9', 'G_c2', 'ls7'), ('3.9', 'G_c = H∞1', 'hinf1')],
)
def test_nichols_figure_contains_the_loop_of_the_printed_controller(number, label, controller):
    chart, remark = drawing(number)
    expected = nichols_curve(LoopCurve(continuous_loop(PRINTED_CONTROLLERS[controller])).values)
    phase, magnitude = line(chart, f'L with {label}')
    np.testing.assert_array_equal(phase, expected.phase_deg)
    np.testing.assert_array_equal(magnitude, expected.magnitude_db)
    assert labels(chart) == ('Open-loop phase arg L, °', 'Open-loop magnitude |L|, dB')
    assert 'enters the T curve' in remark


def test_nichols_bounds_lie_on_the_constant_s_and_t_curves():
    figure = drawing('2.9')[0]
    for label, function in (
        ('|S| = S_p = 1.43', lambda loop: 1.0 / (1.0 + loop)),
        ('|T| = T_p = 1.11', lambda loop: loop / (1.0 + loop)),
    ):
        phase, magnitude = line(figure, label)
        loop = 10.0 ** (magnitude / 20.0) * np.exp(1j * np.radians(phase))
        size = np.abs(function(loop[np.isfinite(loop)]))
        np.testing.assert_allclose(size, float(label.split()[-1]), atol=0.005)


def test_step_figure_contains_the_step_response():
    chart, remark = drawing('2.10')
    legend = [text.get_text() for text in chart.axes[0].get_legend().get_texts()]
    time, output = line(chart, legend[0])
    expected = step_response(continuous_loop(PRINTED_CONTROLLERS['ls7']), time[-1])
    np.testing.assert_array_equal((time, output), expected)
    assert legend == ['G_c2: t_r = 0.54 s, overshoot 13.2 %', 'reference']
    assert labels(chart) == ('Time, s', 'w_d / reference')
    assert 't_r = 0.54 s and overshoot 13 %; the thesis prints 0.52 s and 13 %' in remark


@pytest.mark.parametrize(('number', 'function'), [('3.5', 'S_n'), ('3.6', 'T_n'), ('3.7', 'T_n')])
def test_bound_figure_contains_s_and_t_of_the_printed_hinf1(number, function):
    figure = drawing(number)[0]
    omega, magnitude = line(figure, f'|{function}|, G_c = H∞1')
    loop = continuous_loop(PRINTED_CONTROLLERS['hinf1']).response(omega)
    values = 1.0 / (1.0 + loop) if function == 'S_n' else 1.0 - 1.0 / (1.0 + loop)
    np.testing.assert_allclose(magnitude, 20.0 * np.log10(np.abs(values)), atol=1e-6)
    assert labels(figure) == ('Frequency, rad/s', 'Magnitude, dB')


def test_bound_figures_show_the_gain_that_gives_two_of_the_printed_norms():
    remarks = [drawing(number)[1] for number in ('3.5', '3.6', '3.7')]
    norms = [float(remark.rstrip('.').split()[-1]) for remark in remarks]
    assert norms == pytest.approx([0.97, 1.047, 0.32], abs=0.006)
    assert '|S_n|, G_c = 2.45 H∞1' in [
        line.get_label() for line in drawing('3.5')[0].axes[0].get_lines()
    ]


def test_bounds_have_the_values_of_section_3_2():
    omega, sensitivity = line(drawing('3.5')[0], '|W_s^-1|')
    assert sensitivity[0] == pytest.approx(20.0 * np.log10(0.15 * omega[0] ** 2), abs=0.01)
    assert sensitivity[-1] == pytest.approx(20.0 * np.log10(1.33), abs=0.01)
    omega, complementary = line(drawing('3.6')[0], '|W_t^-1|')
    assert complementary[0] == pytest.approx(20.0 * np.log10(1.02), abs=0.01)
    at_corner = np.interp(28.0, omega, complementary)
    assert at_corner == pytest.approx(complementary[0] - 10.0 * np.log10(2.0), abs=0.01)


def test_wear_error_is_0_3_and_w_u_falls_short_of_it_at_high_frequency():
    chart, remark = drawing('3.3')
    for wear in (0.7, 1.3):
        _, error = line(chart, f'error, K_usura = {wear:g}')
        np.testing.assert_allclose(error, 0.3, rtol=1e-12)
    _, weight = line(chart, '|W_u|')
    assert weight[0] == pytest.approx(3913.0 / 13030.0, rel=1e-6)
    assert weight[-1] == pytest.approx(0.2987, rel=1e-4)
    assert '0.4 % short of inequality (3.3)' in remark


def test_every_figure_has_a_heading_labelled_axes_and_a_remark():
    for figure in WITHOUT_RUN:
        chart, remark = figure.draw()
        assert figure.heading in [text.get_text() for text in chart.texts]
        assert all(text for panel in range(len(chart.axes)) for text in labels(chart, panel)), (
            figure.number
        )
        assert remark.endswith('.')


def test_symbols_with_an_index_are_typeset():
    assert typeset('w_sr, rpm') == '$w_{sr}$, rpm'
    assert typeset('W_s^-1') == '$W_{s}^{-1}$'
    assert typeset('a_file_name.png and $x_1$') == 'a_file_name.png and $x_1$'


def run_command(*arguments: object) -> int:
    return thesis.main(['figures', *map(str, arguments)])


@pytest.fixture
def refusal(capsys: pytest.CaptureFixture[str]) -> Callable[..., str]:
    """Return a function that runs the command and returns its one line of complaint."""

    def run(*arguments: object) -> str:
        capsys.readouterr()
        assert run_command(*arguments) == 1
        (line,) = capsys.readouterr().err.splitlines()
        assert line.startswith('ddct thesis: ')
        return line

    return run


def test_command_writes_pictures_and_a_page_that_links_them(tmp_path, capsys):
    assert run_command('--out', tmp_path / 'new', '--only', '2.10,2.2') == 0
    page = (tmp_path / 'new' / 'index.html').read_text(encoding='utf-8')
    pictures = re.findall(r'<img src="([^"]+)"', page)
    assert pictures == ['figure_2_2.png', 'figure_2_10.png']
    files = {'index.html'}
    for picture in pictures:
        assert (tmp_path / 'new' / picture).read_bytes().startswith(b'\x89PNG')
        files |= {picture, picture.replace('.png', '.svg'), picture.replace('.png', '.csv')}
    assert {path.name for path in (tmp_path / 'new').iterdir()} == files
    assert 'thesis figures: 2/2 Figure 2.10: ' in capsys.readouterr().err


def test_command_draws_a_controller_of_ones_own_into_the_figures_of_runs(tmp_path, capsys):
    own = tmp_path / 'gentle.yaml'
    own.write_text(TRANSFER_FUNCTION.read_text(encoding='utf-8'), encoding='utf-8')
    name = controller_spec(str(own)).name
    chosen = ('--only', '4.8', '--controllers', f'{own},pi')
    assert run_command('--out', tmp_path / 'new', *chosen) == 0
    rows = list(csv.reader((tmp_path / 'new' / 'figure_4_8.csv').read_text().splitlines()))
    columns = dict(zip(rows[0], np.array(rows[1:], dtype=float).T, strict=True))
    assert list(columns) == ['Time, s', *(f'{each}: A_x, m/s²' for each in ('MPC4', name, 'pi'))]
    for shown, controller in (('MPC4', 'mpc4'), (name, str(own)), ('pi', 'pi')):
        run = thesis_run(controller, 'detailed', 1.0).trajectory
        np.testing.assert_allclose(
            columns[f'{shown}: A_x, m/s²'], run.vehicle_accel[50:], rtol=1e-8, atol=1e-12
        )
    assert f'{name} ' in (tmp_path / 'new' / 'index.html').read_text(encoding='utf-8')


@pytest.mark.parametrize(
    ('controllers', 'complaint'),
    [
        ('', '--controllers is empty'),
        ('nobody', "unknown controller 'nobody'"),
        ('pi,pi', '--controllers names pi twice'),
    ],
)
def test_command_refuses_controllers_that_cannot_be_drawn(
    tmp_path, refusal, controllers, complaint
):
    assert complaint in refusal('--out', tmp_path, '--only', '4.8', '--controllers', controllers)
    assert not list(tmp_path.iterdir())


def test_command_replaces_figures_only_with_the_option(tmp_path, refusal):
    arguments = ('--out', tmp_path, '--only', '2.2')
    (tmp_path / 'figure_2_2.png').touch()
    assert re.search(r'figure_2_2.png exists: .* add --overwrite', refusal(*arguments))
    assert run_command(*arguments, '--overwrite') == 0


def test_command_never_replaces_a_page_that_is_not_its_own(tmp_path, refusal):
    page = tmp_path / 'index.html'
    for content in (b'<p>mine</p>', b'\xff\xfe'):
        page.write_bytes(content)
        complaint = refusal('--out', tmp_path, '--only', '2.2', '--overwrite')
        assert 'index.html is not a page of ours' in complaint
        assert page.read_bytes() == content


@pytest.mark.parametrize(
    ('number', 'complaint'),
    [
        ('1.24', 'figure 1.24 is not drawn: a block diagram'),
        ('6.1', "the thesis has no figure '6.1'"),
        ('', "the thesis has no figure ''"),
    ],
)
def test_command_reports_why_a_figure_cannot_be_drawn(tmp_path, refusal, number, complaint):
    assert complaint in refusal('--out', tmp_path, '--only', f'2.2,{number}')
    assert not list(tmp_path.iterdir())


def test_command_refuses_a_folder_that_is_a_file(tmp_path, refusal):
    (tmp_path / 'file').write_text('', encoding='utf-8')
    complaint = refusal('--out', tmp_path / 'file', '--only', '2.2')
    assert 'file: cannot be written' in complaint


def test_figures_are_collected_once_and_in_order():
    numbers = [figure.number for figure in collect_figures()]
    assert len(numbers) == len(set(numbers))
    assert numbers.index('2.9') < numbers.index('2.10')


def gallery(drawn: list[str], not_drawn: dict[str, str]) -> str:
    figures = [ThesisFigure(number, 'w_d & <A_x>', str) for number in drawn]
    return gallery_page(dict.fromkeys(figures, 'W_s^-1 agrees.'), not_drawn)


def test_gallery_has_drawn_and_other_figures_in_order_by_chapter():
    reasons = {'1.1': 'a scheme', '1.2': 'a scheme', '1.10': 'a table', '2.1': 'a scheme'}
    page = gallery(['1.4', '2.3', '2.20'], {**reasons, '1.9': 'a scheme'})
    found = re.findall(r'id="((?:chapter|figure)-[\d.]+)"|class="absent">(.*?)</p>', page)
    assert [identity or text for identity, text in found] == [
        'chapter-1',
        '<b>Figures 1.1 to 1.2:</b> a scheme.',
        'figure-1.4',
        '<b>Figure 1.9:</b> a scheme.',
        '<b>Figure 1.10:</b> a table.',
        'chapter-2',
        '<b>Figure 2.1:</b> a scheme.',
        'figure-2.3',
        'figure-2.20',
    ]
    assert '3 of 8 figures are drawn' in page
    assert re.findall(r'href="#(chapter-\d)"', page) == ['chapter-1', 'chapter-2']


def test_gallery_typesets_symbols_and_escapes_text():
    page = gallery(['2.3'], {})
    assert '<i>w</i><sub>d</sub> &amp; &lt;<i>A</i><sub>x</sub>&gt;' in page
    assert '<i>W</i><sub>s</sub><sup>-1</sup> agrees.' in page
    assert 'alt="Figure 2.3: w_d &amp; &lt;A_x&gt;"' in page


def test_gallery_needs_nothing_but_the_pictures_beside_it():
    page = gallery(['2.3'], {'2.4': 'a scheme'})
    assert set(re.findall(r'(?:src|href)="([^#"]+)"', page)) == {
        f'figure_2_3.{ending}' for ending in ('png', 'svg', 'csv')
    }
    assert not re.search(r'https?:|<script|@import|url\(', page)
    for query in ('prefers-color-scheme: dark', 'print', 'min-width'):
        assert f'@media {query}' in page or f'@media ({query}' in page
