# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Install the programs that run, record, score and compare engagements."""

import sys
from glob import glob
from xml.etree import ElementTree

from setuptools import find_packages, setup

PACKAGE = 'ddct_bringup'
PROGRAMS = [
    'benchmark = ddct_bringup.programs.benchmark:main',
    'bringup = ddct_bringup.programs.bringup:main',
    'campaign = ddct_bringup.programs.campaign:main',
    'compare = ddct_bringup.programs.compare:main',
    'limit = ddct_bringup.programs.limit:main',
    'live = ddct_bringup.programs.live:main',
    'recorder = ddct_bringup.record.recorder_node:main',
    'reproduce = ddct_bringup.programs.reproduce:main',
    'report = ddct_bringup.programs.report:main',
    'score = ddct_bringup.programs.score:main',
    'sweep = ddct_bringup.programs.sweep:main',
    'verify = ddct_bringup.programs.verify:main',
]
DDCT = 'ddct = ddct_bringup.programs.ddct:main'
WHEEL = not {'bdist_wheel', 'dist_info', 'editable_wheel'}.isdisjoint(sys.argv)
"""
Whether pip builds a wheel. A wheel puts scripts into bin/, so that `ddct` is its only one.

colcon puts all scripts into lib/<package>/, where `ros2 run` finds them, and bin/ddct is a file.
"""

setup(
    name=PACKAGE,
    version=ElementTree.parse('package.xml').findtext('version'),
    packages=find_packages(exclude=['test']),
    package_data={
        f'{PACKAGE}.bag.file': ['*.yaml'],
        f'{PACKAGE}.benchmark': ['packaged/*'],
        f'{PACKAGE}.benchmark.report': ['*.j2', '*.css', '*.js'],
        f'{PACKAGE}.campaign_report': ['*.j2', '*.css', '*.js'],
        f'{PACKAGE}.report': ['*.j2', '*.css', '*.js'],
        f'{PACKAGE}.thesis': ['admissible_scenarios/*'],
        f'{PACKAGE}.verdict': ['*.yaml'],
        f'{PACKAGE}.reproduction.numbers': ['chapters/*.yaml'],
    },
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{PACKAGE}']),
        (f'share/{PACKAGE}', ['package.xml']),
        (f'share/{PACKAGE}/config', sorted(glob('config/*.yaml'))),
        (f'share/{PACKAGE}/foxglove', sorted(glob('foxglove/*.json'))),
        *([] if WHEEL else [('bin', ['bin/ddct'])]),
    ],
    install_requires=[
        'setuptools',
        'bokeh',
        'jinja2',
        'markupsafe',
        'matplotlib',
        'mcap',
        'mcap-ros2-support',
        'numpy',
        'pyarrow',
        'rich',
        'scipy',
        'zstandard',
    ],
    extras_require={
        'dask': ['distributed'],
        'live': ['foxglove-sdk'],
        'pandas': ['pandas'],
        'test': ['pytest'],
    },
    zip_safe=False,
    maintainer='DDCT team',
    maintainer_email='maintainers@ddct.invalid',
    description='The programs that run, record, score and compare engagements.',
    license='Apache-2.0',
    entry_points={
        'console_scripts': [DDCT] if WHEEL else [DDCT, *PROGRAMS],
        'ddct.programs': PROGRAMS,
    },
)
