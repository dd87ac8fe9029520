# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Install the programs that run, record, score and compare engagements."""

import sys
from glob import glob
from xml.etree import ElementTree

from setuptools import find_packages, setup

PACKAGE = 'ddct_bringup'
VERSION = ElementTree.parse('package.xml').findtext('version')
OF_BOTH = [
    'live = ddct_bringup.programs.live:main',
    'score = ddct_bringup.programs.score:main',
]
PROGRAMS = [
    *OF_BOTH,
    'benchmark = ddct_bringup.programs.benchmark:main',
    'campaign = ddct_bringup.programs.campaign:main',
    'compare = ddct_bringup.programs.compare:main',
    'identify = ddct_bringup.identification.identify:main',
    'limit = ddct_bringup.programs.limit:main',
    'node = ddct_bringup.programs.node:main',
    'report = ddct_bringup.programs.report:main',
    'sweep = ddct_bringup.programs.sweep:main',
    'thesis = ddct_bringup.programs.thesis:main',
    'tune = ddct_bringup.programs.tune:main',
    'verify = ddct_bringup.programs.verify:main',
]
"""What `ddct` starts by its first word."""
DDCT = 'ddct = ddct_bringup.programs.ddct:main'
OF_ROS2_RUN = [
    *OF_BOTH,
    'bringup = ddct_bringup.programs.bringup:main',
    'recorder = ddct_bringup.record.recorder_node:main',
]
SCRIPTS = [f'{each.split()[0]} = ddct_plant.program.command_line:main' for each in OF_ROS2_RUN]
"""What `ros2 run` starts, as scripts whose imports can be interrupted."""
WHEEL = not {'bdist_wheel', 'dist_info', 'editable_wheel'}.isdisjoint(sys.argv)
"""
Whether pip builds a wheel. A wheel puts scripts into bin/, so that `ddct` is its only one.

colcon puts all scripts into lib/<package>/, where `ros2 run` finds them, and bin/ddct is a file.
"""

setup(
    name=PACKAGE,
    version=VERSION,
    packages=find_packages(exclude=['test']),
    package_data={
        PACKAGE: ['py.typed'],
        f'{PACKAGE}.benchmark': ['packaged/*'],
        f'{PACKAGE}.campaign_report': ['*.j2', '*.css', '*.js'],
        f'{PACKAGE}.documents': ['*.j2', '*.css', '*.js'],
        f'{PACKAGE}.report': ['*.j2', '*.css', '*.js'],
        f'{PACKAGE}.tuning': ['packaged/*'],
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
        f'ddct_plant=={VERSION}',
        f'ddct_reference=={VERSION}',
        f'ddct_controllers=={VERSION}',
        'setuptools',
        'bokeh',
        'daqp',
        'jinja2',
        'markupsafe',
        'matplotlib',
        'mcap',
        'numpy',
        'pandas',
        'pyarrow',
        'rich',
        'scipy',
    ],
    extras_require={
        'dask': ['distributed'],
        'gym': ['gymnasium'],
        'live': ['foxglove-sdk'],
        'mdf': ['asammdf'],
        'test': ['pytest'],
        'tune': ['optuna'],
    },
    zip_safe=False,
    maintainer='DDCT team',
    description='The programs that run, record, score and compare engagements.',
    license='Apache-2.0',
    classifiers=[
        'Intended Audience :: Science/Research',
        'Operating System :: POSIX :: Linux',
        'Programming Language :: Python :: 3',
        'Topic :: Scientific/Engineering',
        'Typing :: Typed',
    ],
    python_requires='>=3.11',
    entry_points={
        'console_scripts': [DDCT] if WHEEL else [DDCT, *SCRIPTS],
        'ddct.programs': PROGRAMS,
        'ddct.scripts': OF_ROS2_RUN,
    },
)
