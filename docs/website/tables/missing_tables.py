# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of docs/use/live.md: what follows when a message is missing, and when."""

from collections.abc import Mapping

from ddct_bringup.processes.supervisor import PATIENCE, PAUSED_S
from ddct_bringup.record.recorder_node import PATIENCE_S
from ddct_bringup.record.tick_buffer import GIVE_UP_AFTER_STEPS, LAG_LIMIT_STEPS
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.fail_safe.request_watch import (
    CLUTCH_TIMEOUT_S,
    REQUEST_TIMEOUT_S,
    FailSafeSettings,
)
from ddct_plant.graph.sole_publishers import OPEN_S
from ddct_plant.program.table import TextTable
from ddct_plant.ticks.join import MOST_WAITING
from ddct_plant.ticks.realtime_owner import RECORDER_PATIENCE_S
from ddct_plant.ticks.tick_owner import RESEND_AFTER_S

_RAMP = FailSafeSettings().fail_safe_ramp_n_m_s
HEADERS = ('node', 'what is missing', 'for longer than', 'what it does', 'it ends')


def missing_tables() -> Mapping[str, TextTable]:
    """Return the tables of both modes, and that of what `compare` sees."""
    return {
        'realtime': TextTable('', HEADERS, _realtime()),
        'lockstep': TextTable('', HEADERS, _lockstep()),
        'compare': TextTable(
            '', ('what is missing', 'for longer than', 'what follows'), _compare()
        ),
    }


def _s(value_s: float) -> str:
    return f'{value_s:g} s'


def _realtime() -> list[tuple[str, ...]]:
    period, restart = _s(PERIOD_S), 'when it is started again'
    request, clutch = _s(REQUEST_TIMEOUT_S), _s(CLUTCH_TIMEOUT_S)
    requests = f'{request} (`request_timeout_s`)'
    next_stamp = 'with the next stamp that is complete'
    no_answer = 'does not answer that stamp, and computes nothing for it'
    return [
        (
            *('`load`, `reference`, `controller`, `clutch`, `handover`', 'any input of a stamp'),
            *('one stamp', no_answer, next_stamp),
        ),
        ('`engine`', '`driveline/joint_states`', 'one stamp', no_answer, next_stamp),
        (
            *('`engine` with `two_input`', '`engine/torque_request`', 'one stamp'),
            *('publishes the demand, and no torque for that stamp', next_stamp),
        ),
        (
            *('the same', '`engine/torque_request`', requests),
            *("goes back to the driver's demand, and ignores requests", restart),
        ),
        (
            *('`actuator`', '`clutch/torque_request`', 'one stamp'),
            *('does not answer; the step holds the last request in its filter', next_stamp),
        ),
        (
            *('`actuator`', '`clutch/torque_request`', requests),
            *(f'safe state: opens the clutch at {_RAMP:g} N m/s, and ignores requests', restart),
        ),
        (
            *('`actuator`', '`/clock`, while requests come', requests),
            *('ends with an error, because it could not detect that they stop', restart),
        ),
        (
            *('`driveline`', 'a torque', f'{period}, the deadline'),
            *('holds the last torque, and counts a missed step', 'with the next reply in time'),
        ),
        (
            *('`driveline`', '`clutch/torque`', f'{clutch} (`clutch_timeout_s`)'),
            f'safe state: takes the held torque to zero at {_RAMP:g} N m/s, and ignores it',
            restart,
        ),
        (
            *('`driveline`', 'any torque', '`answer_timeout_s`'),
            *('ends with an error that names topic, stamp and time', restart),
        ),
        (
            *('`driveline`', 'any reply to t_0, the start barrier', _s(RESEND_AFTER_S)),
            *('publishes t_0 again, until all have answered, at most for `answer_timeout_s`', '-'),
        ),
        (
            *('`driveline`', '`recorder/ack` of the last tick', _s(RECORDER_PATIENCE_S)),
            *('ends the run well; the bag may lack the last tick, and the run is not valid', '-'),
        ),
        (
            *('`recorder`', 'a reply to a tick', _s(GIVE_UP_AFTER_STEPS * PERIOD_S)),
            *('writes the tick without it', 'with the next tick'),
        ),
        (
            *('`recorder`', 'a message of `driveline`', _s(LAG_LIMIT_STEPS * PERIOD_S)),
            *('writes the tick without it: every program refuses the bag', 'with the next tick'),
        ),
        (
            *('`recorder`', '`run_info` of a node', _s(PATIENCE_S)),
            *('warns with the names, and goes on waiting; there is no bag without them', '-'),
        ),
        (
            *(
                'all that read a topic',
                'one publisher: there are two',
                f'the proof, and {_s(OPEN_S)}',
            ),
            *('ignore both, so the clutch opens; then the run ends with their names', restart),
        ),
    ]


def _lockstep() -> list[tuple[str, ...]]:
    again = 'publishes the tick again; who has answered repeats its answer'
    return [
        ('`driveline`', 'any reply to a tick', _s(RESEND_AFTER_S), again, 'with the last reply'),
        (
            *('`driveline`', 'any reply to a tick', '`answer_timeout_s`'),
            *('ends with an error that names topic and stamp', 'when the run is started again'),
        ),
        (
            *('every other node', 'an input of a stamp', f'{MOST_WAITING} stamps that wait'),
            *('ends with an error that names its inputs', 'when the run is started again'),
        ),
        (
            *('every other node', 'a whole stamp', 'the next stamp'),
            *('ends with an error: it missed a part of the run', 'when the run is started again'),
        ),
    ]


def _compare() -> list[tuple[str, ...]]:
    return [
        ('a node: it was killed, or ended', 'at once', 'the run ends with its name and last line'),
        (
            *('a beat of a node that has begun: it hangs', _s(PATIENCE.silent_s)),
            'the node ends itself with its stacks in its log, and the run ends with its name',
        ),
        ('the first beat of a node', _s(PATIENCE.start_s), 'the same'),
        (
            *('a node: it is paused (SIGSTOP)', _s(PAUSED_S)),
            'the run ends with its name, and the node is resumed to end in order',
        ),
    ]
