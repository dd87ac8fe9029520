# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Subcommand `thesis figures`: the thesis's figures as pictures with a gallery."""

import argparse
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ddct_bringup.reproduction.figures import gallery
from ddct_bringup.reproduction.figures.h_infinity_figures import H_INFINITY_FIGURES
from ddct_bringup.reproduction.figures.loop_shaping_figures import LOOP_SHAPING_FIGURES
from ddct_bringup.reproduction.figures.run_figures import run_figures
from ddct_bringup.reproduction.figures.scenario_figures import SCENARIO_FIGURES
from ddct_bringup.reproduction.figures.thesis_figure import ThesisFigure, figure_order
from ddct_controllers.design.drawing.chart_style import chart_style, figure_files, save_figure
from ddct_controllers.registry import controller_spec
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.files.input_file import user_text
from ddct_plant.files.output_file import write_text
from ddct_plant.program.command_line import complain

FIGURES = (*LOOP_SHAPING_FIGURES, *H_INFINITY_FIGURES, *SCENARIO_FIGURES)
"""Figures that do not depend on further controllers."""
_PICTURE = 'a photograph or a scheme: nothing to compute'
_DIAGRAM = 'a block diagram: nothing to compute'
NOT_DRAWN: Mapping[str, str] = {
    **dict.fromkeys((f'1.{place}' for place in range(1, 9)), _PICTURE),
    **dict.fromkeys(('1.9', '1.10', '1.11', '1.13', '1.15', '1.16', '1.17'), _DIAGRAM),
    '1.18': _PICTURE,
    '1.19': 'a table that names the driveline parameters without their values',
    **dict.fromkeys(('1.20', '1.21', '1.22', '1.24', '1.25', '1.26'), _DIAGRAM),
    **dict.fromkeys(('2.1', '3.1', '3.2', '3.4'), _DIAGRAM),
    '4.1': 'explains the horizons: nothing to compute',
    '4.2': _DIAGRAM,
}
"""Reasons for every figure that cannot be drawn, by its number, in order."""
_DESCRIPTION = """\
Draw the figures of the thesis that can be computed, as figure_<chapter>_<number>.png and
.svg, with their data in .csv. The page index.html shows them in order. It says what agrees
with the thesis and what does not, and why the other figures are not drawn. With --only the
page shows just those. --controllers draws further controllers into the figures of runs, which
are 2.11 to 2.28, 3.10 to 3.19, 4.3 to 4.8 and 5.1."""
_EXAMPLES = """\
examples:
  ddct thesis figures --out figures
  ddct thesis figures --out figures --only 2.10,3.5 --overwrite
  ddct thesis figures --out figures --only 2.26 --controllers mpc3,mine.yaml --overwrite"""
_PAGE = 'index.html'


def add_parser(subparsers: Any) -> None:
    """Add `figures` to the subcommands of `thesis`."""
    parser = subparsers.add_parser(
        'figures',
        description=_DESCRIPTION,
        epilog=_EXAMPLES,
    )
    parser.add_argument('--out', required=True, metavar='DIR', help='folder, created if absent')
    parser.add_argument('--only', metavar='N,N...', help='numbers such as 2.10,3.5')
    parser.add_argument(
        '--controllers', metavar='A,B,...', help='further controllers, names or files'
    )
    parser.add_argument(
        '--overwrite', action='store_true', help='replace earlier figures in the folder'
    )
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Draw into the folder and return the exit code."""
    figures = collect_figures(_own(options.controllers))
    not_drawn = NOT_DRAWN
    if options.only:
        chosen = _chosen(options.only, {figure.number for figure in figures})
        figures = [figure for figure in figures if figure.number in chosen]
        not_drawn = {}
    folder = Path(options.out)
    files = [
        file
        for figure in figures
        for file in figure_files(folder, gallery.file_name(figure.number))
    ]
    _make_room(folder, [*files, folder / _PAGE], options.overwrite)
    drawn: dict[ThesisFigure, str] = {}
    for count, figure in enumerate(figures, start=1):
        complain('ddct thesis figures', f'{count}/{len(figures)} {figure.heading}')
        with chart_style():
            chart, drawn[figure] = figure.draw()
            save_figure(chart, folder, gallery.file_name(figure.number))
    write_text(str(folder / _PAGE), gallery.gallery_page(drawn, not_drawn))
    print(f'{len(drawn)} figures in {folder}: open {folder / _PAGE}')
    return 0


def collect_figures(own: Sequence[str] = ()) -> list[ThesisFigure]:
    """
    Return every figure that can be drawn, in order.

    `own` are further controllers, names or files, for the figures of runs.
    """
    figures = (*FIGURES, *run_figures(own))
    return sorted(figures, key=lambda figure: figure_order(figure.number))


def _own(controllers: str | None) -> list[str]:
    """Return the controllers to add; raise the errors of `controller_spec` before any work."""
    chosen = [name.strip() for name in (controllers or '').split(',') if name.strip()]
    if controllers is not None and not chosen:
        raise ParameterError('--controllers is empty: name at least one, or leave it out')
    labels = [controller_spec(name).name for name in chosen]
    for label in labels:
        if labels.count(label) > 1:
            raise ParameterError(f'--controllers names {label} twice: name each once')
    return chosen


def _chosen(only: str, numbers: set[str]) -> set[str]:
    chosen = {number.strip() for number in only.split(',')}
    for number in sorted(chosen - numbers):
        require_drawn(number)
        raise ParameterError(f'--only: the thesis has no figure {number!r}; write 2.10,3.5')
    return chosen


def require_drawn(number: str) -> None:
    """Raise ParameterError for a figure of the thesis that cannot be drawn, with the reason."""
    if number in NOT_DRAWN:
        raise ParameterError(f'figure {number} is not drawn: {NOT_DRAWN[number]}')


def _make_room(folder: Path, files: list[Path], overwrite: bool) -> None:
    """Create the folder; raise DdctError when a file in it would be overwritten."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        taken = [path for path in files if path.exists()]
    except OSError as error:
        raise DdctError(f'{folder}: cannot be written ({error.strerror})') from error
    page = folder / _PAGE
    if page.exists() and not _is_own_page(page):
        raise DdctError(f'{page} is not a page of ours: choose another --out')
    if taken and not overwrite:
        raise DdctError(f'{taken[0]} exists: choose another --out or add --overwrite')


def _is_own_page(page: Path) -> bool:
    try:
        return gallery.GENERATOR in user_text(page)
    except DdctError:
        return False
