# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A handover of a third party, in a package or a file; what is wrong in it is named."""

import importlib.metadata
from dataclasses import replace
from pathlib import Path
from textwrap import dedent

import pytest
from shifts import shift_settings

from ddct_controllers import plugins
from ddct_controllers.handover.interface import Handover, HandoverCommand, HandoverMeasurement
from ddct_controllers.handover.laws import TimedHandover, make_handover
from ddct_plant.base.errors import DdctError

NOW = HandoverMeasurement(40, 100.0, 277.0, 116.0, 0.0, 5.5)


def in_file(tmp_path: Path, body: str) -> Handover:
    """Return the handover of a file whose method `update` has this body."""
    file = tmp_path / 'mine.py'
    text = f"""\
    from ddct_controllers.handover.interface import Handover, HandoverCommand

    class Mine(Handover):
        def update(self, measurement):
            {body}
    """
    file.write_text(dedent(text))
    settings = replace(shift_settings('upshift').known, handover=str(file))
    assert settings.handover_name == 'mine'
    return make_handover(settings)


def test_a_file_of_python_is_a_handover(tmp_path):
    handover = in_file(tmp_path, 'return HandoverCommand(1, measurement.demand, 0.0)')
    assert handover.update(NOW) == HandoverCommand(1.0, 100.0, 0.0)


@pytest.mark.parametrize(
    ('body', 'wrong'),
    [
        ('return HandoverCommand(1.5, 0.0, 0.0)', 'share'),
        ("return HandoverCommand(0.5, float('nan'), 0.0)", 'off_going_request'),
        ('return HandoverCommand(0.5, 0.0, -1.0)', 'torque_cut'),
        ('return 0.5', 'return a HandoverCommand'),
        ('return 1 / 0', 'ZeroDivisionError'),
    ],
)
def test_a_bad_command_names_the_handover_and_the_step(tmp_path, body, wrong):
    with pytest.raises(DdctError) as caught:
        in_file(tmp_path, body).update(NOW)
    text = str(caught.value)
    assert wrong in text and '40' in text
    assert text.startswith("handover 'mine.py'"), 'a repetition elsewhere has another reason'
    assert '\n' not in text


def test_a_file_with_the_name_of_another_handover_is_refused_before_it_runs(tmp_path):
    file = tmp_path / 'timed.py'
    file.write_text('raise SystemExit("it has run")\n')
    with pytest.raises(DdctError, match='timed is the name of another handover: rename'):
        make_handover(replace(shift_settings('upshift').known, handover=str(file)))


def test_a_package_adds_one_by_an_entry_point(monkeypatch):
    points = importlib.metadata.EntryPoints(
        importlib.metadata.EntryPoint(name, value, plugins.HANDOVERS.group)
        for name, value in (
            ('theirs', 'ddct_controllers.handover.laws:TimedHandover'),
            ('broken', 'no_such_module:Law'),
            ('foreign', 'ddct_controllers.handover.interface:HandoverCommand'),
        )
    )
    monkeypatch.setattr(plugins, '_installed', lambda _: points)
    settings = shift_settings('upshift')
    theirs = make_handover(replace(settings.known, handover='theirs'))
    assert theirs.update(NOW) == TimedHandover(settings.known).update(NOW)
    for name, wrong in (('broken', 'cannot be loaded'), ('foreign', 'cannot be made')):
        with pytest.raises(DdctError, match=wrong):
            make_handover(replace(settings.known, handover=name))
    with pytest.raises(DdctError, match='timed, slip, model, adaptive, broken, foreign, theirs'):
        make_handover(replace(settings.known, handover='none'))
