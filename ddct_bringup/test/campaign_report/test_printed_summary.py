# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A campaign ends with its tables in the terminal, and with the paths of its files."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest
from in_this_process import in_this_process
from made_campaign import leave_out_figure
from made_results import made_results

from ddct_bringup.campaign_report.document import campaign_document
from ddct_bringup.documents.document import Block, Document, Remarks, Section, Table
from ddct_bringup.documents.terminal import print_document, printed_blocks
from ddct_bringup.evaluation.summarise import summary_of
from ddct_bringup.programs.campaign import main

SPEC = """\
controllers: [pi, ls8]
grid: {wear_gain: [0.8, 1.0], duration_s: [0.7]}
"""


def test_the_summary_is_printed_at_the_end_and_the_paths_last(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    leave_out_figure(monkeypatch)
    (tmp_path / 'spec.yaml').write_text(SPEC, encoding='utf-8')
    out = tmp_path / 'out'
    with in_this_process():
        assert main([str(tmp_path / 'spec.yaml'), '--out', str(out)]) == 0
    printed = capsys.readouterr().out
    *_, results, page = printed.splitlines()
    assert (results, page) == (str(out / 'results.parquet'), str(out / 'report.html'))
    assert main(['show', str(out)]) == 0
    tables = capsys.readouterr().out.rpartition('The bag of a run')[0]
    assert tables
    assert printed.startswith(tables)
    assert 'How often engagement fails' in tables


def tables_in(blocks: Sequence[Block], title: str = '') -> Iterator[str]:
    """Yield the titles of all tables, or those of their sections."""
    for block in blocks:
        if isinstance(block, Section):
            yield from tables_in(block.content, block.title)
        elif isinstance(block, Table):
            yield block.title or title


def test_each_table_has_a_title_of_its_own() -> None:
    results = made_results(
        ['engaged'] * 3,
        {'wear_gain': [1.0] * 3},
        {'peak_jerk_m_s3': [1.0, 2.0, 3.0], 'judder_rpm': [4.0, 5.0, 6.0]},
        controllers=['pi', 'ls8', 'mpc1'],
    )
    document = campaign_document(summary_of(results), 'again INDEX')
    titles = [*tables_in(document.content)]
    assert len(titles) == len({*titles}) == 8
    (title,) = (each for each in titles if each.startswith('Engaged runs, further metrics'))
    assert document.table(title).rows[0][0].value == 'judder'


def few_failures(random: Sequence[str]) -> Document:
    wear = [0.8, 0.9, 1.0]
    results = made_results(['stalled', *['engaged'] * 2], {'wear_gain': wear}, random=random)
    return campaign_document(summary_of(results), 'again INDEX')


def test_keys_without_evidence_have_a_reason_and_no_section() -> None:
    document = few_failures(random=['wear_gain'])
    (remarks,) = (each for each in document.content if isinstance(each, Remarks))
    assert remarks.lines[0].startswith('pi: 1 of 3 valid runs failed: too few')
    sections = [each.title for each in document.content if isinstance(each, Section)]
    assert sections == ['How often engagement fails', 'How bad it becomes']


def test_that_a_grid_is_no_random_sample_is_said_once(capsys: pytest.CaptureFixture[str]) -> None:
    print_document(few_failures(random=[]))
    assert capsys.readouterr().out.count('no random sample') == 1


def test_words_are_aligned_to_the_left_and_numbers_to_the_right() -> None:
    results = made_results(
        ['engaged'] * 4,
        {'wear_gain': [0.8, 1.0] * 2},
        {'peak_jerk_m_s3': [1.0, 2.0, 1.5, 2.5]},
        controllers=['pi', 'pi', 'ls8', 'ls8'],
    )
    document = campaign_document(summary_of(results), 'again INDEX')
    aligned = {
        table.title: [column.title for column in table.columns if column.number]
        for table in printed_blocks(document.content)
        if isinstance(table, Table)
    }
    assert aligned['How often engagement fails'] == [
        *('failed', '95 % interval', 'runs', 'engaged', 'failed', 'invalid'),
    ]
    assert aligned['Engaged runs: quantiles with sign, CVaR and worst by magnitude'] == [
        *('n', 'P5', 'P50', 'P95', 'CVaR', 'worst engaged', 'run', 'worst failed', 'run'),
    ]
    assert aligned['Differences on the same cases, where both engaged'] == [
        *('cases', 'P5', 'P50', 'P95', '95 % interval of P50'),
    ]
