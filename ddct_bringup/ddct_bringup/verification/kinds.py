# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Kinds of folders that can be verified.

A new kind is a name in its `digests.json`, and a function here that repeats what the folder has.
"""

from collections.abc import Callable, Iterator, Mapping

from ddct_bringup.digests.digest_file import BENCHMARK, CAMPAIGN, RUNS, TUNING
from ddct_bringup.verification.benchmark import verified_benchmark
from ddct_bringup.verification.campaign import verified_campaign
from ddct_bringup.verification.request import VerificationRequest
from ddct_bringup.verification.result import RepetitionResult
from ddct_bringup.verification.runs import verified_runs
from ddct_bringup.verification.tuning import verified_tuning

KINDS: Mapping[str, Callable[[VerificationRequest], Iterator[RepetitionResult]]] = {
    RUNS: verified_runs,
    CAMPAIGN: verified_campaign,
    BENCHMARK: verified_benchmark,
    TUNING: verified_tuning,
}
"""Functions that repeat the runs of a folder and yield their results, by the folder's kind."""
