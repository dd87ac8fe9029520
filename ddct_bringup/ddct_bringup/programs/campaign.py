# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `campaign`: run controllers over many plants; `replay` makes any run again."""

import argparse
import sys
from functools import partial
from pathlib import Path

from ddct_bringup.api import shell
from ddct_bringup.programs import campaign_folder
from ddct_bringup.programs.options.of_runs import add_limits_option, add_workers_option
from ddct_plant.program.command_line import ProgramParser, complain, run_program
from ddct_plant.program.signals import stop_signals

PROGRAM = 'ddct campaign'
_COMMANDS = ('replay', 'show')
"""Subcommands for the folder of a campaign."""

_EPILOG = """\
examples:
  ddct campaign wear.yaml --out campaigns/wear             on all cores
  ddct campaign wear.yaml --out campaigns/wear --resume    go on with what is missing
  ddct campaign wear.yaml --out campaigns/wear --scheduler tcp://10.0.0.5:8786
  ddct campaign show campaigns/wear                        what came out, as tables
  ddct campaign replay campaigns/wear --index 17 --out runs/again

Prints what came out, and writes it as DIR/report.html and DIR/summary.json, beside
DIR/results.parquet, a row per run, and DIR/manifest.json. Shards of it are written while it runs;
after an interruption --resume computes what is missing, with the same result. The exit code is 1
where every run is invalid. SPEC.yaml is described in docs/use/campaigns.md.
"""


def main(argv: list[str] | None = None) -> int:
    """Run the program and return its exit code."""
    given = sys.argv[1:] if argv is None else argv
    if given and given[0] in _COMMANDS:
        parser = ProgramParser(prog=PROGRAM, description='What else can be done with a campaign.')
        campaign_folder.add_parsers(parser.add_subparsers(required=True, metavar='WHAT'))
        return run_program(PROGRAM, partial(_folder, parser), argv)
    return run_program(PROGRAM, _campaign, argv)


def _folder(parser: ProgramParser, argv: list[str]) -> int:
    options = parser.parse_args(argv)
    return options.run(options)


def _campaign(argv: list[str]) -> int:
    options = _parser().parse_args(argv)
    campaign = shell.Campaign(shell.read_spec(options.spec))
    with stop_signals() as stops:
        done = shell.carry_out_campaign(
            campaign,
            shell.load_limits(options.limits),
            options.out,
            workers=options.workers,
            scheduler=options.scheduler,
            resume=options.resume,
            stopped=lambda: bool(stops),
        )
    shell.print_campaign(done.summary, options.out)
    print(done.rows)
    print(done.page, flush=True)
    summary = done.summary
    if summary.invalid < summary.runs:
        return 0
    found = summary.groups[0].reasons[0]
    complain(PROGRAM, f'every run is invalid, such as run {found.index}: {found.reason}')
    return 1


def _parser() -> argparse.ArgumentParser:
    parser = ProgramParser(
        prog=PROGRAM,
        usage='%(prog)s SPEC.yaml --out DIR [options]\n       %(prog)s replay|show DIR ...',
        description='Run controllers over a grid and random samples of plants, headless.',
        epilog=_EPILOG,
    )
    parser.add_argument('spec', metavar='SPEC.yaml', type=Path, help='what varies')
    parser.add_argument('--out', type=Path, metavar='DIR', required=True, help='folder for it')
    parser.add_argument('--resume', action='store_true', help='go on with the campaign in DIR')
    where = parser.add_mutually_exclusive_group()
    add_workers_option(where)
    where.add_argument('--scheduler', metavar='ADDRESS', help='compute on this Dask cluster')
    add_limits_option(parser)
    return parser


if __name__ == '__main__':
    raise SystemExit(main())
