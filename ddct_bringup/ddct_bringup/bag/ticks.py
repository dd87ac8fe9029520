"""Which ticks of a recording are complete, judged by the stamps of its messages alone."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence

from ddct_bringup.bag.topics import TOPICS, resolved_name
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import stamp_of_step, step_of_stamp, time_of_step
from ddct_plant.ticks.stamp_limit import PLANT_TOPICS

Stamps = Mapping[str, Sequence[int]]
"""Per resolved topic name the stamps in ns of its messages."""


def tick_topics(recorded: Iterable[str], *, lockstep: bool) -> list[str]:
    """
    Return the resolved names of the topics that every tick must have, in writing order.

    In lock-step these are all topics of a tick; in real time replies may be missing. `recorded`
    tells whether `engine/torque_request` is among them.
    """
    present = set(recorded)
    return [
        topic.resolved_name
        for topic in TOPICS
        if topic.every_tick
        and (lockstep or topic.name in PLANT_TOPICS)
        and (not topic.two_input_only or topic.resolved_name in present)
    ]


def complete_ticks(stamps: Stamps, topics: Sequence[str]) -> int:
    """Return how many ticks from t_0 on have a message on each of `topics`, without a gap."""
    present = [set(stamps.get(topic, ())) for topic in topics]
    count = 0
    while all(stamp_of_step(count) in each for each in present):
        count += 1
    return count


def check_ticks(stamps: Stamps, *, lockstep: bool) -> int:
    """
    Return N when the topics that every tick must have hold t_0..t_N, as the joint states do.

    Raise DdctError that names the topic and stamp of a missing, doubled or misplaced message.
    """
    joint_states = resolved_name('driveline/joint_states')
    if not stamps.get(joint_states):
        raise DdctError(f'no message on {joint_states}: not a recording of this project')
    for topic in tick_topics(stamps, lockstep=True):
        _check_single(topic, stamps.get(topic, ()))
    last = step_of_stamp(max(stamps[joint_states]))
    for topic in tick_topics(stamps, lockstep=lockstep):
        held = set(stamps.get(topic, ()))
        if not held:
            raise DdctError(f'no message on {topic}')
        for step in range(last + 1):
            if stamp_of_step(step) not in held:
                raise DdctError(f'{topic} has no message at {_place(step)}')
        if max(held) > stamp_of_step(last):
            raise DdctError(f'{topic} goes on after the last tick at {_place(last)}')
    return last


def _check_single(topic: str, stamps: Sequence[int]) -> None:
    for stamp, count in Counter(stamps).items():
        try:
            step = step_of_stamp(stamp)
        except DdctError as error:
            raise DdctError(f'{topic}: {error}') from error
        if count > 1:
            raise DdctError(f'{topic} has {count} messages at {_place(step)}')


def _place(step: int) -> str:
    return f'step {step} ({time_of_step(step):g} s, stamp {stamp_of_step(step)} ns)'
