# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The text of --help keeps within the terminal, and its commands can be copied."""

import shlex

from ddct_plant.program.help_text import filled

COMMAND = 'ddct compare --controllers pi,ls8 --set load.slope_rad=0.05 --out runs/uphill'


def test_a_paragraph_is_filled_and_other_lines_keep_their_places():
    text = f'One sentence that\ngoes on.\n\nexamples:\n  ddct compare\n\n{"long words " * 9}'
    assert filled(text, 40).splitlines() == [
        'One sentence that goes on.',
        '',
        'examples:',
        '  ddct compare',
        '',
        'long words long words long words long',
        'words long words long words long words',
        'long words long words',
    ]


def test_a_long_command_continues_after_a_backslash_with_its_remark_below():
    lines = filled(f'  {COMMAND}    a road up a hill', 40).splitlines()
    assert max(map(len, lines)) <= 40
    assert lines[-1] == '      a road up a hill'
    assert shlex.split('\n'.join(lines[:-1]).replace('\\\n', '')) == shlex.split(COMMAND)


def test_a_list_keeps_its_second_column():
    text = '  load  the resistance of the road at the wheel'
    assert filled(text, 30).splitlines() == [
        '  load  the resistance of the',
        '        road at the wheel',
    ]
