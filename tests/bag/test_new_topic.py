# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A new entry in the table of topics is recorded, read and tabulated without another change."""

import csv
import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from message_counts import message_counts
from refusals import refused
from support.runs import expected, plan

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.run.headless import run_headless, run_loop
from ddct_bringup.scores.csv_text import signals_csv
from ddct_controllers.loop import ClosedLoop, ObservedStep, Request
from ddct_controllers.registry import make_controller
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import step_of_stamp
from ddct_plant.plant import PlantReply
from ddct_plant.signals import topics
from ddct_plant.signals.message_kind import Number, Numbers, stamp_ns
from ddct_plant.signals.topic import RunKind, Signal, Topic

RUN = plan('pi', 'single-process', duration_s=0.3)


def _stick_slip(run: RunKind) -> bool:
    return run.clutch == 'stick_slip'


def entry(**options: Any) -> Topic:
    kind = Numbers('geometry_msgs/msg/WrenchStamped', 'wrench.torque', (Number('x'),))
    signal = Signal('made_up_torque', 'N m', 'made up')
    return Topic('load/made_up', kind, 'load', (signal,), **options)


def value_at(step: int) -> float:
    return step / 3.0


@pytest.fixture
def add(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return a function that adds an entry to the table, right behind that of the load."""

    def to_table(topic: Topic) -> Topic:
        at = topics.TOPICS.index(topics.LOAD_TORQUE) + 1
        monkeypatch.setattr(topics, 'TOPICS', (*topics.TOPICS[:at], topic, *topics.TOPICS[at:]))
        return topic

    return to_table


@pytest.fixture
def add_to_graph(add: Any, monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return `add` for a test with a recorder node, whose module has the table by its name."""
    pytest.importorskip('rclpy', reason='a graph')

    def to_tables(topic: Topic) -> Topic:
        add(topic)
        monkeypatch.setattr('ddct_bringup.record.recorder_node.TOPICS', topics.TOPICS)
        return topic

    return to_tables


class LoopWithMore(ClosedLoop):
    """Closed loop whose load also gives the made-up torque."""

    def answer(self, observed: ObservedStep, request: Request) -> PlantReply:
        reply = super().answer(observed, request)
        reply.signals['made_up_torque'] = value_at(observed.observation.tick.step)
        return reply


def headless_run() -> Trajectory:
    loop = LoopWithMore(RUN.settings, make_controller('pi', RUN.settings.known))
    return run_loop(loop, RUN.settings.scenario.steps)


def with_more(trajectory: Trajectory) -> Trajectory:
    values = [value_at(step) for step in range(trajectory.steps + 1)]
    return Trajectory.of_columns({**trajectory.signals, 'made_up_torque': values})


def csv_columns(text: str) -> dict[str, tuple[str, ...]]:
    header, *rows = csv.reader(io.StringIO(text))
    return dict(zip(header, zip(*rows, strict=True), strict=True))


def test_a_bag_of_the_headless_loop_has_it(add: Any, bags: Any) -> None:
    without = expected(RUN)
    before = signals_csv(read_bag(bags.write(without, folder='before')))
    add(entry())
    run = headless_run()
    bag = bags.write(run)
    recording = read_bag(bag)
    assert message_counts(bag)['/load/made_up'] == run.steps + 1
    assert recording.trajectory.sha256() == run.sha256() != without.sha256()
    columns = csv_columns(signals_csv(recording))
    made_up = columns.pop('made_up_torque_n_m')
    assert [float(text) for text in made_up] == [value_at(k) for k in range(run.steps + 1)]
    assert columns == csv_columns(before)


def test_a_run_whose_loop_does_not_compute_it_is_refused(add: Any) -> None:
    add(entry())
    with refused(DdctError, 'made_up_torque'):
        run_headless(RUN.settings, 'pi')


def test_the_recorder_waits_for_it_at_every_tick(add_to_graph: Any, tmp_path: Path) -> None:
    from rclpy.node import Node
    from support.in_process_graph import InProcessGraph

    from ddct_plant.graph.output import Output

    topic = add_to_graph(entry())

    class MoreOfTheLoad(Node):
        def __init__(self, **options: Any) -> None:
            super().__init__('more_of_the_load', **options)
            self._output = Output(self, topic)
            kind, name = topics.VEHICLE_SPEED.message_class, topics.VEHICLE_SPEED.name
            self.create_subscription(kind, name, self._answer, 10)

        def _answer(self, message: Any) -> None:
            stamp = stamp_ns(message)
            self._output.fill(stamp, value_at(step_of_stamp(stamp))).publish()

    with InProcessGraph(RUN, tmp_path / 'pi') as graph:
        graph.add_all()
        owner = graph.driveline.owner
        graph.spin_until(lambda: owner.missing() == ['recorder/ack'], 'the replies to t_0')
        graph.add_other(MoreOfTheLoad(context=graph.context))
        graph.run()
    assert read_bag(tmp_path / 'pi').trajectory.sha256() == headless_run().sha256()


def test_a_bag_that_lacks_it_is_refused(add: Any, bags: Any, trajectory: Trajectory) -> None:
    bag = bags.write(trajectory)
    add(entry())
    with refused(DdctError, '/load/made_up', place='pi_0.mcap'):
        read_bag(bag)


def test_only_runs_that_fulfil_its_condition_have_it(
    add: Any, bags: Any, trajectory: Trajectory, make_trajectory: Any
) -> None:
    topic = add(entry(when=_stick_slip))
    assert topic not in topics.recorded_topics(RunKind())
    assert topic in topics.recorded_topics(RunKind(clutch='stick_slip'))
    linear = read_bag(bags.write(trajectory, folder='linear'))
    assert linear.trajectory.sha256() == trajectory.sha256()
    run = with_more(make_trajectory(60, clutch='stick_slip'))
    stick_slip = bags.write(run, folder='stick_slip', clutch='stick_slip')
    assert np.array_equal(
        read_bag(stick_slip).trajectory.signals['made_up_torque'], run.made_up_torque
    )
    assert 'made_up_torque_n_m' in csv_columns(signals_csv(read_bag(stick_slip)))
    assert 'made_up_torque_n_m' not in csv_columns(signals_csv(linear))
    lacking = bags.rewrite(
        stick_slip, 'lacking', lambda messages: [m for m in messages if m[0] != '/load/made_up']
    )
    with refused(DdctError, '/load/made_up', place='lacking_0.mcap'):
        read_bag(lacking)


def test_the_recorder_expects_the_topic_where_its_condition_holds(
    add_to_graph: Any, tmp_path: Path
) -> None:
    from support.in_process_graph import InProcessGraph

    add_to_graph(entry(when=_stick_slip))
    with InProcessGraph(RUN, tmp_path / 'pi') as graph:
        graph.add_all()
        graph.run()
    assert read_bag(tmp_path / 'pi').trajectory.sha256() == expected(RUN).sha256()
