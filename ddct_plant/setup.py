# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Install the plant: its nodes and the scenarios."""

import sys
from glob import glob
from xml.etree import ElementTree

from setuptools import find_packages, setup

PACKAGE = 'ddct_plant'
VERSION = ElementTree.parse('package.xml').findtext('version')
NODES = [
    'actuator = ddct_plant.nodes.actuator_node:main',
    'clutch = ddct_plant.nodes.clutch_node:main',
    'driveline = ddct_plant.nodes.driveline_node:main',
    'engine = ddct_plant.nodes.engine_node:main',
    'load = ddct_plant.nodes.load_node:main',
]
SCRIPTS = [f'{node.split()[0]} = ddct_plant.program.command_line:main' for node in NODES]
"""The nodes as scripts, whose imports can be interrupted."""
WHEEL = not {'bdist_wheel', 'dist_info', 'editable_wheel'}.isdisjoint(sys.argv)
"""Whether pip builds a wheel, which would put scripts into bin/ that `ros2 run` does not find."""

setup(
    name=PACKAGE,
    version=VERSION,
    packages=find_packages(exclude=['test']),
    package_data={PACKAGE: ['py.typed', 'bag_file/*.json', 'scenario/packaged/*/*.yaml']},
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{PACKAGE}']),
        (f'share/{PACKAGE}', ['package.xml']),
        (f'share/{PACKAGE}/config', sorted(glob('config/*.yaml'))),
    ],
    install_requires=[
        'setuptools',
        'cloudpickle',
        'mcap',
        'numpy',
        'pandas',
        'portalocker[win32]',
        'pyyaml',
        'rich',
        'rosbags',
        'scipy',
        'threadpoolctl',
        'zstandard',
    ],
    extras_require={'test': ['pytest']},
    zip_safe=False,
    maintainer='DDCT team',
    description='The plant: its nodes and the scenarios.',
    license='Apache-2.0',
    classifiers=[
        'Intended Audience :: Science/Research',
        'Operating System :: POSIX :: Linux',
        'Programming Language :: Python :: 3',
        'Topic :: Scientific/Engineering',
        'Typing :: Typed',
    ],
    python_requires='>=3.11',
    entry_points={'console_scripts': [] if WHEEL else SCRIPTS, 'ddct.scripts': NODES},
)
