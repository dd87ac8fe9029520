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
    verdict: str
    """Agreement of the computed figures with the claim."""
    wear_gains: tuple[float, ...] = (1.0,)
    compared: tuple[str, ...] = ()
    """Registry names of runs that are scored for comparison and not drawn."""


_OSCILLATING = 'w_d good, but oscillations in w_sr and A_x'
_NOT_GOOD = 'not good with this reference either'
_FEW_GOOD = 'few controllers with good results'

FIGURE_GROUPS = (
    FigureGroup(
        *(('2.11', '2.13', '2.14'), 'feedforward', _FIRST_THREE, _OSCILLATING),
        verdict='Ours agree, except that w_d is near the reference with LS3 only',
    ),
    FigureGroup(
        *(('2.12', '2.15', '2.16'), 'feedforward', _LAST_SIX, _OSCILLATING),
        verdict='The oscillations agree; w_d lags behind the reference, less with more gain',
    ),
    FigureGroup(
        *(('2.17', '2.18', '2.19'), 'feedforward_tanh', _FIRST_THREE, _NOT_GOOD),
        verdict='Ours agree: the reference changes little',
    ),
    FigureGroup(
        *(('2.20', '2.21', '2.22'), 'feedforward_tanh', _LAST_SIX, _NOT_GOOD),
        verdict='Ours agree: A_x varies more than with the reference of CRF',
    ),
    FigureGroup(
        *(('2.23', '2.24', '2.25'), 'detailed', (*_FIRST_THREE, 'pi'), _FEW_GOOD),
        verdict='Ours agree: LS1 goes far below zero, LS2 and LS3 oscillate more than the PI',
    ),
    FigureGroup(
        *(('2.26', '2.27', '2.28'), 'detailed', (*_LAST_SIX, 'pi'), _FEW_GOOD),
        verdict='Ours agree: LS8 and LS9 are faster than the PI, at the cost of w_sr',
    ),
    FigureGroup(
        *(('3.10',), 'base', ('hinf2',), 'the only one that tracks the reference here'),
        verdict='Ours agree: it tracks',
    ),
    FigureGroup(
        *(('3.11', '3.12', '3.13'), 'feedforward', _H_INFINITY),
        thesis_claim='the faster to zero, the larger the oscillations',
        verdict='Ours agree',
    ),
    FigureGroup(
        *(('3.14', '3.15', '3.16'), 'feedforward_tanh', _H_INFINITY),
        thesis_claim='no better with this reference',
        verdict='Ours agree for H∞1 and H∞3; H∞2 oscillates half as much in w_sr',
    ),
    FigureGroup(
        *(('3.17', '3.18', '3.19'), 'detailed', (*_H_INFINITY, 'pi')),
        thesis_claim='oscillations reduced, only H∞2 very bad in w_sr and A_x',
        verdict='Ours agree',
    ),
    FigureGroup(
        *(('4.3', '4.4', '4.5'), 'detailed', ('mpc1', 'mpc2', 'mpc3')),
        thesis_claim='oscillations smaller than in the previous chapters',
        verdict='Ours do not agree: w_d is nearer to the reference, and the oscillations are '
        'larger; in Table 5.1 itself MPC3 oscillates more than H∞1',
        compared=('ls8', 'hinf1'),
    ),
    FigureGroup(
        *(('4.6', '4.7', '4.8'), 'detailed', ('mpc4',)),
        thesis_claim='excellent, no oscillations in w_sr and A_x',
        verdict='Ours agree: oscillations nearly vanish. w_d is within 10 rpm of zero after '
        '0.46 s, but stays above it, so t_a is not defined',
        compared=('mpc3',),
    ),
    FigureGroup(
        *(('5.1',), 'feedforward', ('hinf2',), 'good response whatever the wear'),
        verdict='Ours agree: w_d goes to zero at both ends',
        wear_gains=(0.7, 1.3),
    ),
)
"""Groups for Figures 2.11 to 2.28, 3.10 to 3.19, 4.3 to 4.8 and 5.1."""
