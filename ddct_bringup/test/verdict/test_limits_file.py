# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A limits file is read completely, or refused in one line with file, line and key."""

import re
from importlib.resources import files

import pytest
from refusals import refused

from ddct_bringup.metrics.catalogue import METRICS
from ddct_bringup.metrics.plant import JudgedPlant
from ddct_bringup.verdict.limits import limits_of_text, load_limits, packaged_limits
from ddct_plant.base.errors import DdctError
from ddct_plant.scenario.file import load_scenario

TEXT = (files('ddct_bringup.verdict') / 'limits.yaml').read_text(encoding='utf-8')
PLANT = JudgedPlant.of(load_scenario('thesis'))
OF_SLIP = """\
  - metric: judder_rpm
    value: 3.0
    unit: rpm
    applies_to: [launch, tip_in]
"""


def line_of(text, part):
    return next(n for n, line in enumerate(text.splitlines(), start=1) if part in line)


def test_the_packaged_file_is_read_and_every_limit_cites_a_clause():
    limits = packaged_limits()
    assert limits.rules.engaged_slip == 50.0
    assert {limit.metric for limit in limits.limits} <= set(METRICS)
    for limit in limits.limits:
        assert limit.source.startswith('convention: ') == limit.convention
        assert limit.convention or ', ' in limit.source
    conventions = {limit.metric for limit in limits.limits if limit.convention}
    assert conventions == {'releases', 'friction_work_over_least', 'judder_rpm'}


def test_a_limit_of_some_scenarios_applies_to_no_other():
    limits = packaged_limits()
    assert limits.of('launch_gentle', PLANT)['mean_negative_jerk_m_s3'][0] == 5.0
    assert 'mean_negative_jerk_m_s3' not in limits.of('launch', PLANT)
    assert limits.of('anything', PLANT)['weighted_acceleration_m_s2'][0] == 0.315


def test_the_strictest_of_several_limits_applies():
    convention = f'{OF_SLIP}    convention: true\n    reason: mine\n'
    limits = limits_of_text(TEXT + convention + convention.replace('3.0', '2.0'), 'mine.yaml')
    value, limit = limits.of('launch', PLANT)['judder_rpm']
    assert (value, limit.source) == (2.0, 'convention: mine')
    assert limits.of('thesis', PLANT)['judder_rpm'][0] == 6.0
    assert limits.of('launch', None)['judder_rpm'][0] == 2.0


def test_the_limit_of_events_that_must_not_occur_is_zero():
    assert packaged_limits().of('launch', None)['releases'][0] == 0.0


def test_a_file_without_a_version_is_of_the_present_one():
    assert limits_of_text(TEXT.replace('schema_version: 3\n', ''), 'x') == packaged_limits()


@pytest.mark.parametrize(
    ('old', 'new', 'at', 'complaint'),
    [
        ('schema_version: 3', 'schema_version: 4', 'schema_version', 'schema_version is 4, this'),
        ('schema_version: 3', 'schema_version: no', 'schema_version', "schema_version is 'no'"),
        (
            'metric: mean_negative_jerk_m_s3',
            'metric: jerkiness',
            'jerkiness',
            'limits\\[3\\].metric: ',
        ),
        (
            'metric: mean_negative_jerk_m_s3',
            'metric: [jerk]',
            '[jerk]',
            'limits\\[3\\].metric: ',
        ),
        (
            'unit: m/s^3',
            'unit: g/s',
            'unit: g/s',
            "limits\\[3\\].unit: it is 'g/s': give .* 'm/s\\^3'",
        ),
        ('unit: rpm\n', 'unit: rad/s\n', 'unit: rad/s', "rules.engaged_slip.unit: it is 'rad/s'"),
        ('value: 50.0', 'value: 0', 'value: 0', 'rules.engaged_slip.value: .*above 0'),
        (
            'value: 0.315',
            'value: low',
            'value: low',
            "limits\\[0\\].value: it is 'low': give a number",
        ),
        ('value: 300.0', 'value: -9.1', 'value: -9.1', 'limits\\[1\\].value: .*at least 0'),
        ('value: 300.0', 'value: .nan', 'value: .nan', 'limits\\[1\\].value: .*finite'),
        (
            'applies_to: all',
            'applies_to: few',
            'applies_to: few',
            'limits\\[0\\].applies_to: give',
        ),
        ('applies_to: all', 'applies_to: []', 'applies_to: []', 'limits\\[0\\].applies_to: give'),
        (
            '  settled_time:',
            '  settling:',
            '  settling:',
            'unknown key rules.settling: did you mean rules.settled_time',
        ),
        ('rules:', 'rule:', 'rule:', 'unknown key rule: did you mean rules'),
        (
            '    source: Pisaturo and Senatore, Applied Thermal Engineering 93, 2016\n',
            '',
            'peak_temp',
            'limits\\[1\\]: source is missing: c',
        ),
        (
            '    clause: annex',
            '    page: annex',
            'page: annex',
            'unknown key limits\\[0\\].page: known: ',
        ),
        (
            '    source: Pisaturo and Senatore, Applied Thermal Engineering 93, 2016',
            "    source: ''",
            "source: ''",
            'limits\\[1\\].source: ',
        ),
        ('    unit: degC\n', '', 'peak_temperature', 'limits\\[1\\]: the key unit is missing'),
        (
            '    reason: an engagement ends',
            '    clause: an engagement ends',
            'metric: releases',
            'limits\\[4\\]: reason is missing: say why',
        ),
        (
            '    clause: abstract',
            '    reason: abstract',
            'reason: abstract',
            'limits\\[1\\].reason: only a convention',
        ),
        ('  driven_share:', '  share:', '  share:', 'unknown key traction.share: known: fr'),
        ('    value: 1.0\n', '    value: -0.7\n', 'value: -0.7', 'traction.friction.value: '),
        ('limits:\n', 'limits: 3\nmore:\n', 'more:', 'unknown key more: known: rules, limits'),
    ],
)
def test_an_error_is_reported_with_file_line_and_key(old, new, at, complaint):
    assert old in TEXT
    text = TEXT.replace(old, new, 1)
    with pytest.raises(DdctError) as caught:
        limits_of_text(text, 'mine.yaml')
    message = str(caught.value)
    assert message.startswith(f'limits mine.yaml: line {line_of(text, at)}: ')
    assert re.search(complaint, message), message
    assert '\n' not in message


def test_a_missing_rule_is_named():
    text = re.sub(r'  settled_time:\n(    .*\n)+', '', TEXT)
    with refused(DdctError, 'settled_time', place='limits mine.yaml: line 4'):
        limits_of_text(text, 'mine.yaml')


@pytest.mark.parametrize('text', ['', '[]', 'a', 'limits: []', '{rules: 1, limits: []}'])
def test_a_file_of_something_else_is_refused(text):
    with pytest.raises(DdctError, match=r'^limits mine.yaml: line 1: '):
        limits_of_text(text, 'mine.yaml')


@pytest.mark.parametrize('word', ['true', 'yes', '1'])
def test_only_the_boolean_true_makes_a_limit_a_convention(word):
    text = f'{TEXT}{OF_SLIP}    convention: {word}\n    reason: mine\n'
    if word == 'true':
        assert limits_of_text(text, 'x').of('tip_in', PLANT)['judder_rpm'][1].convention
        return
    with refused(
        DdctError, 'limits[7].convention', place=f'limits x: line {len(TEXT.splitlines()) + 5}'
    ):
        limits_of_text(text, 'x')


def test_the_origin_is_the_name_without_folders_and_a_digest_that_distinguishes_files():
    mine = limits_of_text(TEXT, 'far/away/mine.yaml').origin
    assert list(mine) == ['name', 'digest', 'schema_version']
    assert (mine['name'], mine['schema_version']) == ('mine.yaml', 3)
    assert packaged_limits().origin == {**mine, 'name': 'packaged'}
    other = limits_of_text(TEXT.replace('value: 300.0', 'value: 301.0'), 'mine.yaml').origin
    assert other['digest'] != mine['digest']


def test_a_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(DdctError, match=r'limits .*none.yaml: cannot be read \(No such file'):
        load_limits(tmp_path / 'none.yaml')
    (tmp_path / 'mine.yaml').write_text(TEXT, encoding='utf-8')
    assert load_limits(tmp_path / 'mine.yaml') == packaged_limits() == load_limits(None)


def test_values_stand_beside_the_limits_of_the_scenario_whatever_their_size():
    metrics = {**dict.fromkeys(METRICS), 'judder_rpm': 7.0, 'mean_negative_jerk_m_s3': -6.0}
    beside = packaged_limits().beside(metrics, 'launch_gentle', PLANT)
    assert [each.name for each in beside] == [
        *('weighted_acceleration_m_s2', 'releases', 'friction_work_over_least'),
        *('peak_temperature_degc', 'driving_acceleration_m_s2', 'mean_acceleration_m_s2'),
        *('mean_negative_jerk_m_s3', 'judder_rpm'),
    ]
    judder = beside[-1]
    assert (judder.value, judder.limit, judder.unit) == (7.0, 6.0, 'rpm')
    assert judder.convention and judder.source.startswith('convention: at the natural frequency')
    assert beside[-2].value == -6.0
    assert beside[0].value is None
    names = [each.name for each in packaged_limits().beside(metrics, 'launch', PLANT)]
    assert 'driving_acceleration_m_s2' in names
    assert 'mean_negative_jerk_m_s3' not in names


def test_the_packaged_traction_is_that_of_a_car_with_front_wheel_drive():
    # mu (m g s - m a h/L) = m a
    traction = packaged_limits().traction
    assert traction is not None
    limit = traction.limit(PLANT)
    load = 9.81 * PLANT.driven_share - limit * PLANT.height_over_wheelbase
    assert limit == pytest.approx(traction.friction * load)
    assert limit == pytest.approx(4.905)


def test_a_limit_follows_from_the_car_that_is_judged():
    limits = packaged_limits()
    found = {
        (name, car): {
            metric: value
            for metric, (value, limit) in limits.of(
                name, JudgedPlant.of(load_scenario(drive=name, car=car))
            ).items()
            if limit.value is None
        }
        for name in ('launch', 'tip_in')
        for car in ('c635', 'city7')
    }
    works = {key: each['friction_work_over_least'] for key, each in found.items()}
    assert works == {key: 30.0 if key[1] == 'c635' else 38.0 for key in found}
    judders = {key: each['judder_rpm'] for key, each in found.items()}
    assert judders['tip_in', 'c635'] == judders['tip_in', 'city7'] == 6.0  # in second gear
    assert judders['launch', 'c635'] == judders['launch', 'city7'] == 3.0


def test_a_file_may_give_numbers_in_place_of_those_of_the_car():
    text = TEXT.replace(
        '  driven_share: of_car', "  driven_share: {value: 0.5, unit: '1', reason: mine}"
    )
    text = text.replace('value: of_car\n    unit: rpm', 'value: 6.0\n    unit: rpm')
    limits = limits_of_text(text, 'mine.yaml')
    assert limits.of('launch', None)['judder_rpm'][0] == 6.0
    assert limits.of('launch', PLANT)['driving_acceleration_m_s2'][0] == pytest.approx(
        9.81 * 0.5 / 1.2
    )


def test_only_some_limits_follow_from_the_car():
    with refused(DdctError, 'limits[0].value'):
        limits_of_text(TEXT.replace('value: 0.315', 'value: of_car'), 'mine.yaml')
