# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Scenario that replays the log of a measured car, made from a base scenario."""

import dataclasses
import math
import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ddct_bringup.identification.from_log.delays import residuals_by_name, without_ends
from ddct_bringup.identification.from_log.result import (
    ASSUMED,
    GIVEN,
    MEASURED,
    NO_DAMPING,
    LogFit,
    WheelRadius,
)
from ddct_bringup.identification.from_log.stretch import SPEED_COLUMNS, slip_of
from ddct_bringup.identification.from_log.stretches import KnownLoad, stretches_of
from ddct_bringup.logs.log import MeasuredLog
from ddct_bringup.logs.wheel_radius import measured_radius
from ddct_plant.base.errors import LONGEST_NAME, DdctError
from ddct_plant.base.timebase import PERIOD_S, time_of_step
from ddct_plant.files.output_file import STDOUT, require_new, write_text
from ddct_plant.models.body import RADIUS
from ddct_plant.models.engine import TorqueProfile
from ddct_plant.models.gearbox import AGREE
from ddct_plant.models.load import RoadLoad
from ddct_plant.models.parameters import DrivelineSection
from ddct_plant.scenario.content import flat, scenario_content
from ddct_plant.scenario.csv_profiles import MOST_ROWS
from ddct_plant.scenario.file import scenario_to_yaml
from ddct_plant.scenario.initial_speeds import InitialSection
from ddct_plant.scenario.nouns.composed import files_of_noun
from ddct_plant.scenario.nouns.keys import SCENARIO
from ddct_plant.scenario.nouns.written import beside, texts_by_file
from ddct_plant.scenario.overrides import parsed_override
from ddct_plant.scenario.scenario import Scenario

STEEPEST_RAD = 0.6
"""Largest slope angle in rad of a scenario."""
_LEVEL_RAD = 1e-4
"""Negligible change of the slope angle in rad: 0.1 m in a kilometre."""
_PIECES = 10
"""Number of instants of a period over which C_m is averaged."""
_MOVED = ('driveline.', 'vehicle.mass_kg', 'gear')
"""Beginnings of the lines in `adjusted` about values that the log replaces."""


def require_new_scenario(target: str | None, *, overwrite: bool) -> None:
    """
    Raise DdctError where the `target` of --out, or its car or drive, exists.

    With `overwrite` those are replaced, and no other files.
    """
    if not target or target == STDOUT:
        return
    for noun, path in {SCENARIO: Path(target), **beside(Path(target))}.items():
        if not path.exists():
            continue
        require_new('--out', path, overwrite=overwrite)
        try:
            files_of_noun(noun, str(path.resolve()))
        except DdctError as error:
            raise DdctError(
                f'{path} is no {noun}, and --overwrite replaces only that: choose another --out '
                f'({error})',
                key='--out',
            ) from error


def write_scenario(target: str, scenario: Scenario) -> None:
    """Write a scenario with its car and drive beside it; in one on standard output."""
    if target == STDOUT:
        write_text(STDOUT, scenario_to_yaml(scenario))
        return
    for path, text in texts_by_file(scenario_content(scenario), Path(target)).items():
        write_text(str(path), text)


def radius_of(base: Scenario, overrides: Sequence[str], log: MeasuredLog) -> WheelRadius:
    """Return the wheel radius: that of --set, else that of V_x and w_r, else that of `base`."""
    measured, of_base = measured_radius(log), base.vehicle.wheel_radius_m
    if RADIUS in flat(dict(map(parsed_override, overrides))):
        return WheelRadius(of_base, GIVEN, measured)
    if measured:
        return WheelRadius(measured.value_m, MEASURED, measured)
    return WheelRadius(of_base, ASSUMED, None)


def with_radius(base: Scenario, radius: WheelRadius) -> Scenario:
    """Return `base` with another wheel radius, and a line in `adjusted` if it differs."""
    before, moved = base.vehicle.wheel_radius_m, radius.value_m
    adjusted = [line for line in base.adjusted if not line.startswith(RADIUS)]
    if not math.isclose(before, moved, rel_tol=AGREE):
        adjusted.append(f'{RADIUS} moved from {before:g} to {moved:g}: V_x over w_r of the log')
    vehicle = dataclasses.replace(base.vehicle, wheel_radius_m=moved)
    driveline = dataclasses.replace(base.given_driveline, vehicle_inertia=None)
    return dataclasses.replace(
        base, vehicle=vehicle, given_driveline=driveline, adjusted=tuple(adjusted)
    )


def load_of(base: Scenario) -> KnownLoad:
    """Return the drag of the base scenario as the known part of C_load; the rest is fitted."""
    road = RoadLoad(base.load, base.vehicle)
    constant = road.torque(-base.load.wind_speed_m_s)

    def drag(wheel_speed: np.ndarray) -> np.ndarray:
        speeds = wheel_speed * base.vehicle.wheel_radius_m
        return np.array([road.torque(each) for each in speeds.tolist()]) - constant

    return drag


def name_of(log: Path) -> str:
    """Return the scenario name for a log: that of its file, with allowed characters only."""
    plain = re.sub(r'[^A-Za-z0-9._-]', '_', log.stem).lstrip('.-')
    return plain[:LONGEST_NAME] or 'log'


def replay_of(base: Scenario, name: str, fit: LogFit, log: MeasuredLog) -> Scenario:
    """
    Return `base` with the driveline of the fit and the drive of the log, from its first row on.

    The log gives C_m, the speeds at the start and the duration. `base` has the wheel radius of the
    log, and the mass is J_v / r_w^2. The slope is set so that rolling resistance and slope give
    the fitted C_load; it stays where C_load was measured. Moved values have lines in `adjusted`.
    Raise DdctError for a C_load that no slope gives, and for a log that is too short.
    """
    start_s, steps = _span(log, fit)
    moved = _with_car(base, fit)
    moved = _with_window(moved, time_of_step(steps))
    profile, adjusted = _torque(moved, fit, log, start_s, steps)
    return dataclasses.replace(
        moved,
        name=name,
        description=(
            f'driveline and drive of {log.path.name} (SHA-256 {log.digest}...) from '
            f'{start_s:.6g} s on: fitted {", ".join(fit.std)}; all else as in the scenario '
            f'{base.name}'
        ),
        duration_s=time_of_step(steps),
        given_initial=_initial(base, fit, log, start_s),
        engine=profile,
        adjusted=adjusted,
    )


def _span(log: MeasuredLog, fit: LogFit) -> tuple[float, int]:
    """Return the first time in s with all signals, and the number of whole periods from there."""
    stretches = stretches_of(log, lambda speeds: np.zeros(len(speeds)))
    first, last = stretches[0].time_s[0], stretches[-1].time_s[-1]
    steps = int(math.floor((last - first) / PERIOD_S + 1e-6))
    return float(first), steps


def _torque(
    base: Scenario, fit: LogFit, log: MeasuredLog, start_s: float, steps: int
) -> tuple[TorqueProfile, tuple[str, ...]]:
    """
    Return the profile of C_m, its means over whole periods, and the lines in `adjusted`.

    An engine holds its torque over a period, so the mean has the same effect on the car.
    """
    every = -(-steps // MOST_ROWS)
    periods = np.arange(0, steps, every)
    pieces = (np.arange(_PIECES) + 0.5) / _PIECES
    times = (periods[:, None] + pieces) * PERIOD_S + start_s + fit.delays['engine_torque']
    means = log.at('engine_torque', times).mean(axis=1)
    adjusted = list(base.adjusted)
    if means.min() < 0.0:
        adjusted.append(
            f'engine.torque_n_m is 0 where the log has less, down to {means.min():.4g} N m: a '
            'profile has no engine braking'
        )
    if every > 1:
        adjusted.append(
            f'engine.torque_n_m has a point every {every * PERIOD_S:g} s: a profile has at most '
            f'{MOST_ROWS} points'
        )
    profile = TorqueProfile(
        tuple(time_of_step(int(each)) for each in periods),
        tuple(np.maximum(means, 0.0).tolist()),
    )
    return profile, tuple(adjusted)


def _initial(base: Scenario, fit: LogFit, log: MeasuredLog, start_s: float) -> InitialSection:
    """Return the fitted speeds of both plates at the start, equal if the slip is within noise."""
    values = fit.values | fit.delays | fit.bends
    (first, *_) = without_ends(stretches_of(log, load_of(base)), values)
    left = residuals_by_name(values, first)[0]
    speeds = first.speeds - left
    at = [
        float(np.interp(start_s + fit.delays[name], first.time_s, speeds[:, SPEED_COLUMNS[name]]))
        for name in ('engine_speed', 'shaft_speed')
    ]
    engine, shaft = (max(each, 0.0) for each in at)
    if abs(engine - shaft) <= float(np.std(slip_of(left))):
        engine = shaft = (engine + shaft) / 2.0
    return InitialSection(engine_speed_rad_s=engine, shaft_speed_rad_s=shaft)


def _with_car(base: Scenario, fit: LogFit) -> Scenario:
    """Return the base with the parameters of the fit, and a line in `adjusted` per moved value."""
    driveline, radius = fit.parameters, base.vehicle.wheel_radius_m
    mass = driveline.vehicle_inertia / radius**2
    lines = [line for line in base.adjusted if not line.startswith(_MOVED)]
    if not math.isclose(mass, base.vehicle.mass_kg, rel_tol=AGREE):
        lines.append(
            f'vehicle.mass_kg moved from {base.vehicle.mass_kg:g} to {mass:g}: J_v = m_v r_w^2, '
            f'with vehicle.wheel_radius_m {radius:g} and driveline.vehicle_inertia '
            f'{driveline.vehicle_inertia:g} of the log'
        )
    gearbox, gear = base.gearbox.with_measured(driveline.gear)
    if gear != base.gear or gearbox.gears != base.gearbox.gears:
        lines.append(
            f'gear moved from {base.gear} to {gear} of {gearbox.gears}: the log has the total '
            f'ratio {driveline.gear}'
        )
    for name, value in fit.values.items():
        if value < -NO_DAMPING:
            lines.append(f'driveline.{name} is 0: the log gave {value:.4g}')
    moved = dataclasses.replace(
        base,
        vehicle=dataclasses.replace(base.vehicle, mass_kg=mass),
        given_driveline=DrivelineSection.of(driveline),
        gearbox=gearbox,
        gear=gear,
    )
    if fit.load_torque is not None and not base.slope.given:
        slope = _slope(moved, fit.load_torque)
        if not math.isclose(slope, base.load.slope_rad, abs_tol=_LEVEL_RAD):
            lines.append(
                f'load.slope_rad moved from {base.load.slope_rad:g} to {slope:.4g}: the log has a '
                f'C_load of {fit.load_torque:.4g} N m besides drag'
            )
        moved = dataclasses.replace(moved, load=dataclasses.replace(base.load, slope_rad=slope))
    return dataclasses.replace(moved, adjusted=tuple(lines))


def _with_window(scenario: Scenario, duration_s: float) -> Scenario:
    """Return the scenario with a score window that ends with the log at the latest."""
    first, last = scenario.score_window_s
    if duration_s <= first:
        raise DdctError(
            f'the log lasts {duration_s:g} s, and score_window_s starts at {first:g} s: give an '
            'earlier one, such as --set control_start_s=0.1 --set score_window_s=[0.1,0.5]'
        )
    if last <= duration_s:
        return scenario
    line = f'score_window_s moved from {[first, last]} to {[first, duration_s]} s: the log ends'
    return dataclasses.replace(
        scenario, score_window_s=(first, duration_s), adjusted=(*scenario.adjusted, line)
    )


def _slope(scenario: Scenario, load_torque: float) -> float:
    """Return the slope a in rad with m g (mu cos a + sin a) r_w = `load_torque`."""
    vehicle, rolling = scenario.vehicle, scenario.load.rolling_coefficient
    weight_torque = vehicle.mass_kg * vehicle.gravity_m_s2 * vehicle.wheel_radius_m
    share = load_torque / weight_torque / math.hypot(1.0, rolling)
    slope = math.asin(share) - math.atan(rolling) if abs(share) <= 1.0 else math.inf
    if abs(slope) > STEEPEST_RAD:
        raise DdctError(
            f'the fitted C_load of {load_torque:.4g} N m at the wheels is no road for a car of '
            f'{vehicle.mass_kg:.4g} kg: check units and signs of the torques'
        )
    return slope
