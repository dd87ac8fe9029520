# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Reports of nodes about themselves and about a run: pairs of key and text, and their reader.

`run_info` says what a node is, and is equal in the graph and in headless runs. Counts, safe
states and update times exist in graphs only. No ROS is needed here.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from ddct_plant.base.errors import ParameterError, require_number
from ddct_plant.fail_safe.request_watch import (
    CLUTCH_TIMEOUT_S,
    REQUEST_TIMEOUT_S,
    FailSafeSettings,
)
from ddct_plant.program.command_line import package_version
from ddct_plant.scenario.settings import KnownSettings
from ddct_plant.shift.roles import OFF_GOING, ON_COMING
from ddct_plant.signals.topics import CONTROLLER_TIMING

Pairs = dict[str, str]
"""Texts by key."""
CONTROLLER, STEPS, TWO_INPUT = 'controller', 'steps', 'two_input'
"""Keys on `run_info`: name of the controller, N, and whether a node has the request of C_m."""
KNOWN, CASE = 'known', 'case'
"""
Keys on `run_settings`: JSON of the known settings of a run, and of all its true ones.

The latter is there only where the recorder was started by hand.
"""
CONTROL_NODES = ('/controller', '/reference', '/handover')
"""Full names within the graph of the nodes that have the known settings alone."""
ROLE = 'role'
"""Key on `run_info` of a clutch and an actuator in a gear shift: the side on which they are."""
PARTS = 'torque_parts'
"""Key on `run_info` of `controller`: true where it publishes `controller/torque_parts`."""
TICKS = ': ticks'
"""Ending, after the driveline's name, of the name of the status with its counts."""
SAFE_STATE = ': safe state'
"""Ending, after the node's name, of the name of the status of a node in its safe state."""
_SINCE = 'since_ns'
_UPDATE_TIMES = 'update_times_us'
_LATENESS_SAMPLES, _LATENCY_SAMPLES = 'tick_lateness_us', 'latency_us'


ABOUT = {
    'engine': 'torque that the engine delivers',
    'load': 'resistance of the road at the wheels',
    'clutch': 'torque between the plates of a clutch',
    'driveline': 'shafts, wheels and car; owns time',
    'actuator': 'hydraulic actuator of a clutch',
    'reference': 'slip speed that the controller follows',
    'controller': 'torque that is requested of the clutch',
    'handover': 'share of the torque of each clutch in a gear shift',
    'recorder': 'writes the bag',
}
"""What each of our nodes is or computes, by its name."""


def run_info_pairs(name: str, own: Mapping[str, str] | None = None) -> Pairs:
    """Return the `run_info` of the node of this name: what it is, its version, `own` pairs."""
    return {'about': ABOUT[name], 'version': package_version(), **(own or {})}


def engine_info(two_input: bool, request_timeout_s: float = REQUEST_TIMEOUT_S) -> Pairs:
    """Return the engine's own pairs: two inputs or not, and timeout of requests in s."""
    return {TWO_INPUT: flag(two_input), 'request_timeout_s': repr(request_timeout_s)}


def role_info(known: KnownSettings, role: str) -> Pairs:
    """Return the own pair of a clutch or an actuator in a gear shift, its role; else none."""
    return {ROLE: role} if known.shift else {}


def actuator_info(fail_safe: FailSafeSettings | None = None) -> Pairs:
    """Return the actuator's own pairs: timeout of requests in s, rate of its ramp in N m/s."""
    fail_safe = fail_safe or FailSafeSettings()
    return {'request_timeout_s': repr(fail_safe.request_timeout_s), **_ramp(fail_safe)}


def driveline_info(steps: int, fail_safe: FailSafeSettings | None = None) -> Pairs:
    """Return the driveline's own pairs: N, timeout in s and rate of its fail-safe in N m/s."""
    fail_safe = fail_safe or FailSafeSettings(CLUTCH_TIMEOUT_S)
    timeout = {'clutch_timeout_s': repr(fail_safe.request_timeout_s)}
    return {STEPS: str(steps), **timeout, **_ramp(fail_safe)}


def handover_info(known: KnownSettings) -> Pairs:
    """Return the handover's own pair, the name of its law."""
    return {'handover': known.handover_name}


def reference_info(preview_steps: int) -> Pairs:
    """Return the reference's own pair: the number of periods of its preview."""
    return {'preview_steps': str(preview_steps)}


def controller_info(controller: Mapping[str, str]) -> Pairs:
    """Return the own pairs of the controller's node; `controller` are those of its controller."""
    return {**controller, PARTS: flag(True)}


def node_info(
    known: KnownSettings, controller: Mapping[str, str], preview_steps: int, steps: int
) -> dict[str, Pairs]:
    """
    Return the `run_info` of each node of a graph with default timeouts, by the node's path.

    `controller` are the own pairs of the controller, from `Controller.info`.
    """
    own: dict[str, Mapping[str, str]] = {
        'engine': engine_info(controller[TWO_INPUT] == flag(True)),
        'load': {},
        'clutch': role_info(known, ON_COMING),
        'driveline': driveline_info(steps),
        'actuator': {**role_info(known, ON_COMING), **actuator_info()},
        'reference': reference_info(preview_steps),
        'controller': controller_info(controller),
        'recorder': {},
    }
    if known.shift:
        role = role_info(known, OFF_GOING)
        own |= {
            'handover': handover_info(known),
            f'{OFF_GOING}/clutch': role,
            f'{OFF_GOING}/actuator': {**role, **actuator_info()},
        }
    return {node: run_info_pairs(node.rpartition('/')[2], pairs) for node, pairs in own.items()}


def flag(value: bool) -> str:
    """Return the text of a flag: true or false."""
    return str(value).lower()


def _ramp(fail_safe: FailSafeSettings) -> Pairs:
    return {'fail_safe_ramp_n_m_s': repr(fail_safe.fail_safe_ramp_n_m_s)}


@dataclass(frozen=True)
class TickCounts:
    """The driveline's counts of a run, the content of its status `TICKS`."""

    steps: int
    """Step of the counts."""
    resends: int
    """Number of ticks that were sent again."""
    missed_steps: int
    """Number of steps that held the last torque because a reply was missing."""
    late_messages: int
    """Number of replies to a tick that was over."""
    missed_replies: Mapping[str, int] = field(default_factory=dict)
    """Number of missing replies by topic; empty in lock-step."""
    lateness_us: Sequence[float] = field(default_factory=list)
    """Lateness of each step since the counts before, us; empty in lock-step."""
    latency_us: Sequence[float] = field(default_factory=list)
    """Latency of each torque of a clutch since the counts before, us; empty in lock-step."""

    def pairs(self) -> list[tuple[str, str]]:
        """Return the pairs of the status."""
        counts = {key: getattr(self, key) for key in _COUNTS}
        counts |= {f'missed {topic}': count for topic, count in self.missed_replies.items()}
        pairs = [(key, str(count)) for key, count in counts.items()]
        samples = {_LATENESS_SAMPLES: self.lateness_us, _LATENCY_SAMPLES: self.latency_us}
        pairs += [(key, _samples_text(times)) for key, times in samples.items() if times]
        return pairs

    @classmethod
    def of(cls, pairs: Mapping[str, str]) -> 'TickCounts':
        """Return the counts in the pairs of a status; raise KeyError or ValueError."""
        steps, resends, missed_steps, late_messages = (_count(pairs, key) for key in _COUNTS)
        return cls(
            *(steps, resends, missed_steps, late_messages),
            lateness_us=_samples('ticks', pairs, _LATENESS_SAMPLES),
            latency_us=_samples('ticks', pairs, _LATENCY_SAMPLES),
        )


_COUNTS = ('steps', 'resends', 'missed_steps', 'late_messages')


def safe_state_pairs(since_ns: int, why: str) -> list[tuple[str, str]]:
    """Return the pairs of a safe state that began at a stamp in ns."""
    return [(_SINCE, str(since_ns)), ('why', why)]


def safe_state_since(pairs: Mapping[str, str]) -> int:
    """Return the stamp in ns at which a safe state began; raise KeyError or ValueError."""
    return _count(pairs, _SINCE)


def _count(pairs: Mapping[str, str], key: str) -> int:
    """Return a count, or a stamp in ns; raise KeyError or ValueError."""
    value = int(pairs[key])
    if not 0 <= value < 2**63:
        raise ValueError(f'{key} is {value}')
    return value


def timing_pairs(update_times_us: Iterable[float]) -> list[tuple[str, str]]:
    """Return the pairs of `controller/timing`, for update times in us."""
    return [(_UPDATE_TIMES, _samples_text(update_times_us))]


def update_times(pairs: Mapping[str, str]) -> list[float]:
    """
    Return the update times in us in the pairs of `controller/timing`.

    Raise ParameterError for one that is no number, not finite or below zero.
    """
    return _samples(CONTROLLER_TIMING.name, pairs, _UPDATE_TIMES)


def _samples_text(times_us: Iterable[float]) -> str:
    return ' '.join(f'{time:.3f}' for time in times_us)


def _samples(source: str, pairs: Mapping[str, str], key: str) -> list[float]:
    """Return times in us; raise ParameterError for one that is no number, or below zero."""
    name = f'{source} {key}'
    times = []
    for text in pairs.get(key, '').split():
        try:
            time = float(text)
        except ValueError:
            raise ParameterError(f'{name} has {text!r}: give numbers in us', key=name) from None
        times.append(require_number(name, time, unit='us', at_least=0.0))
    return times
