# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Install the controllers and their node."""

import sys
from glob import glob
from xml.etree import ElementTree

from setuptools import find_packages, setup

PACKAGE = 'ddct_controllers'
VERSION = ElementTree.parse('package.xml').findtext('version')
NODES = [
    'controller = ddct_controllers.controller_node:main',
    'handover = ddct_controllers.handover.handover_node:main',
]
PROGRAMS = [
    'check = ddct_controllers.check.program:main',
    'design = ddct_controllers.workflows.design_program:main',
]
SCRIPTS = [f'{node.split()[0]} = ddct_plant.program.command_line:main' for node in NODES]
"""The nodes as scripts, whose imports can be interrupted."""
WHEEL = not {'bdist_wheel', 'dist_info', 'editable_wheel'}.isdisjoint(sys.argv)
"""Whether pip builds a wheel, which would put scripts into bin/ that `ros2 run` does not find."""

setup(
    name=PACKAGE,
    version=VERSION,
    packages=find_packages(exclude=['test']),
    package_data={
        PACKAGE: [
            'py.typed',
            *('mpc/export/c/*.c', 'mpc/export/c/*.h'),
            'template/files/*.in',
            *(f'from_file/c_library/template/*.{end}' for end in ('c', 'h', 'yaml')),
        ]
    },
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{PACKAGE}']),
        (f'share/{PACKAGE}', ['package.xml']),
        (f'share/{PACKAGE}/config', sorted(glob('config/*.yaml'))),
    ],
    install_requires=[
        f'ddct_plant=={VERSION}',
        f'ddct_reference=={VERSION}',
        'setuptools',
        'cffi',
        'control',
        'daqp',
        'matplotlib',
        'numpy',
        'osqp',
        'scipy',
    ],
    extras_require={'test': ['pytest'], 'lmi': ['clarabel'], 'fmu': ['fmpy']},
    zip_safe=False,
    maintainer='DDCT team',
    description='The controllers and their node.',
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
        'console_scripts': [] if WHEEL else SCRIPTS,
        'ddct.programs': PROGRAMS,
        'ddct.scripts': NODES,
    },
)
