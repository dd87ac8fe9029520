# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
What the programs of this package call: the steps behind `ddct_bringup.api`, which they share.

Unlike the names of `ddct_bringup.api` these may change. They are imported late, as those are.
"""

from typing import TYPE_CHECKING

from ddct_plant.base.late_names import late_names

if TYPE_CHECKING:
    from ddct_bringup.api.arguments import planned, run_settings
    from ddct_bringup.api.shell.campaigns import carry_out_campaign, replay_row, show_campaign
    from ddct_bringup.api.shell.comparison import FILES, Comparer, NoValidRunError, compare_into
    from ddct_bringup.api.shell.judging import judge_into, judged_of
    from ddct_bringup.api.shell.kept_run import keep_run
    from ddct_bringup.api.shell.least import least_values
    from ddct_bringup.api.shell.pages import report, require_chart_library
    from ddct_bringup.api.shell.scored_bags import BagScorer, ScoreFiles, score_bags
    from ddct_bringup.api.shell.sweeps import metrics_called, planned_sweep
    from ddct_bringup.api.shell.tunings import tune_into
    from ddct_bringup.bag.recording import Recording
    from ddct_bringup.benchmark.cases import Cases
    from ddct_bringup.benchmark.judged import Judged
    from ddct_bringup.benchmark.report.document import benchmark_document
    from ddct_bringup.benchmark.report.folder import document_of
    from ddct_bringup.benchmark.report.packaged import (
        packaged_document,
        packaged_tables,
        packaged_written,
    )
    from ddct_bringup.benchmark.result_types import Result
    from ddct_bringup.benchmark.update_times import read_update_times
    from ddct_bringup.campaign.arrow_columns import table_csv
    from ddct_bringup.campaign.campaign import Campaign
    from ddct_bringup.campaign.spec import read_spec
    from ddct_bringup.campaign_report.distributions_chart import distributions_chart
    from ddct_bringup.campaign_report.folder import print_campaign
    from ddct_bringup.campaign_report.texts import RULES
    from ddct_bringup.documents.chart_files import write_chart
    from ddct_bringup.documents.terminal import print_document
    from ddct_bringup.floor.front_chart import front_chart
    from ddct_bringup.live.live_node import LiveNode
    from ddct_bringup.processes.fork_server import start_server
    from ddct_bringup.processes.graph_names import GraphNames
    from ddct_bringup.processes.live_process import live_view
    from ddct_bringup.report.page import report_page
    from ddct_bringup.reproduction.figures import command as figures_command
    from ddct_bringup.reproduction.numbers import command as numbers_command
    from ddct_bringup.reproduction.studies import command as studies_command
    from ddct_bringup.run.execution import print_kept_logs, run_with_progress
    from ddct_bringup.run.options import (
        metrics_of,
        print_choices,
    )
    from ddct_bringup.run.output_folder import PARTIAL
    from ddct_bringup.run.plan import RunPlan, require_headless
    from ddct_bringup.run.run_base import changes_of
    from ddct_bringup.scores.comparison_table import print_comparison
    from ddct_bringup.scores.document import scores_document
    from ddct_bringup.scores.floors import with_least
    from ddct_bringup.scores.run_notes import slow_notes
    from ddct_bringup.scores.run_table import figure_columns, identifying_columns, print_runs
    from ddct_bringup.scores.scored_recording import ScoredRecording
    from ddct_bringup.scores.scored_run import ScoredRun
    from ddct_bringup.scores.validity import realtime_summary
    from ddct_bringup.sweep.as_campaign import specification_of
    from ddct_bringup.sweep.axis import axis_of
    from ddct_bringup.sweep.shown import sweep_shown
    from ddct_bringup.sweep.sweep import sweep_document
    from ddct_bringup.sweep.sweep_chart import sweep_chart
    from ddct_bringup.tuning.report.document import tuning_document
    from ddct_bringup.tuning.study import require_optuna
    from ddct_bringup.verdict.limits import Limits, load_limits
    from ddct_controllers.registry import (
        controller_label,
        controller_names,
        controllers_of,
        working_controllers,
    )
    from ddct_controllers.workflows.evidence import frequency_evidence
    from ddct_plant.files.json_records import write_json
    from ddct_plant.files.yaml_text import dump_yaml
    from ddct_plant.graph.spin import run_node
    from ddct_plant.program.progress import with_progress
    from ddct_plant.scenario.case import case_values
    from ddct_plant.scenario.chosen import print_adjusted
    from ddct_plant.scenario.differences import scenario_title
    from ddct_plant.scenario.settings import RunSettings
    from ddct_plant.signals.gain_changes import changes_note
else:
    __getattr__, __dir__, __all__ = late_names(__name__)
