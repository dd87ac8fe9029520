# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Groups of controllers that the thesis shows together: the loop, and the thesis's claims."""

from dataclasses import dataclass

_FIRST_THREE = ('ls1', 'ls2', 'ls3')
_LAST_SIX = ('ls4', 'ls5', 'ls6', 'ls7', 'ls8', 'ls9')
_H_INFINITY = ('hinf1', 'hinf2', 'hinf3')


@dataclass(frozen=True)
class FigureGroup:
    """Figures of the same runs."""

    numbers: tuple[str, ...]
    """Numbers of the figures of w_d, w_sr and A_x, or of w_d alone."""
    architecture: str
    controllers: tuple[str, ...]
    """Registry names of the controllers."""
    thesis_claim: str
    """Claim of the thesis about these figures."""
    listed: tuple[str, ...] = ()
    """Ids in FIGURE_CLAIMS of what the list of numbers judges of the claim."""
    remark: str = ''
    """What the computed figures show beside that."""
    wear_gains: tuple[float, ...] = (1.0,)
    compared: tuple[str, ...] = ()
    """Registry names of runs that are scored for comparison and not drawn."""


_OSCILLATING = 'w_d good, but oscillations in w_sr and A_x'
_NOT_GOOD = 'not good with this reference either'
_FEW_GOOD = 'few controllers with good results'

FIGURE_GROUPS = (
    FigureGroup(
        *(('2.11', '2.13', '2.14'), 'feedforward', _FIRST_THREE, _OSCILLATING),
        *(('2.4 feedforward',), 'w_d is near the reference with LS3 only'),
    ),
    FigureGroup(
        *(('2.12', '2.15', '2.16'), 'feedforward', _LAST_SIX, _OSCILLATING),
        *(('2.4 feedforward',), 'w_d lags behind the reference, less with more gain'),
    ),
    FigureGroup(
        *(('2.17', '2.18', '2.19'), 'feedforward_tanh', _FIRST_THREE, _NOT_GOOD),
        listed=('2.5 tanh',),
    ),
    FigureGroup(
        *(('2.20', '2.21', '2.22'), 'feedforward_tanh', _LAST_SIX, _NOT_GOOD),
        *(('2.5 tanh',), 'A_x varies more than with the reference of CRF'),
    ),
    FigureGroup(
        *(('2.23', '2.24', '2.25'), 'detailed', (*_FIRST_THREE, 'pi'), _FEW_GOOD),
        remark='LS1 goes far below zero, LS2 and LS3 oscillate more than the PI',
    ),
    FigureGroup(
        *(('2.26', '2.27', '2.28'), 'detailed', (*_LAST_SIX, 'pi'), _FEW_GOOD),
        remark='LS8 and LS9 are faster than the PI, and have more w_sr',
    ),
    FigureGroup(
        *(('3.10',), 'base', ('hinf2',), 'only this one tracks the reference, with a huge w_sr'),
        listed=('3.3 tracks', '3.3 cost'),
    ),
    FigureGroup(
        *(('3.11', '3.12', '3.13'), 'feedforward', _H_INFINITY),
        thesis_claim='the faster to zero, the larger the oscillations',
        listed=('3.4 faster',),
    ),
    FigureGroup(
        *(('3.14', '3.15', '3.16'), 'feedforward_tanh', _H_INFINITY),
        thesis_claim='no better with this reference',
        listed=('3.5 tanh',),
        remark='H∞2 oscillates half as much in w_sr as with the ramp',
    ),
    FigureGroup(
        *(('3.17', '3.18', '3.19'), 'detailed', (*_H_INFINITY, 'pi')),
        thesis_claim='oscillations reduced, only H∞2 very bad in w_sr and A_x',
        listed=('3.6 reduced', '3.6 bad'),
    ),
    FigureGroup(
        *(('4.3', '4.4', '4.5'), 'detailed', ('mpc1', 'mpc2', 'mpc3')),
        thesis_claim='oscillations smaller than in the previous chapters',
        listed=('4.2 runs',),
        remark='w_d is nearer to the reference than with LS8 and H∞1, and the oscillations are '
        'larger; in Table 5.1 itself MPC3 oscillates more than H∞1',
        compared=('ls8', 'hinf1'),
    ),
    FigureGroup(
        *(('4.6', '4.7', '4.8'), 'detailed', ('mpc4',)),
        thesis_claim='excellent, no oscillations in w_sr and A_x',
        listed=('4.3 none',),
        remark='w_d is within 10 rpm of zero after 0.46 s, but stays above it, so t_a is not '
        'defined',
        compared=('mpc3',),
    ),
    FigureGroup(
        *(('5.1',), 'feedforward', ('hinf2',), 'good response whatever the wear'),
        *(('5.1 robust',), 'w_d goes to zero at both ends'),
        wear_gains=(0.7, 1.3),
    ),
)
"""Groups for Figures 2.11 to 2.28, 3.10 to 3.19, 4.3 to 4.8 and 5.1."""
