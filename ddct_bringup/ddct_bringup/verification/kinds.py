# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Kinds of folders that can be verified.

A new kind is a name in its `digests.json`, and a function here that repeats what the folder has.
"""

from collections.abc import Callable, Iterator, Mapping

from ddct_bringup.digests.digest_file import BENCHMARK, CAMPAIGN, RUNS
from ddct_bringup.verification.benchmark import verified_benchmark
from ddct_bringup.verification.campaign import verified_campaign
from ddct_bringup.verification.request import VerificationRequest
from ddct_bringup.verification.result import RepetitionResult
from ddct_bringup.verification.runs import verified_runs

KINDS: Mapping[str, Callable[[VerificationRequest], Iterator[RepetitionResult]]] = {
    RUNS: verified_runs,
    CAMPAIGN: verified_campaign,
    BENCHMARK: verified_benchmark,
}
"""Functions that repeat the runs of a folder and yield their results, by the folder's kind."""
