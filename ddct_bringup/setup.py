"""Install the programs that run, record, score and compare engagements."""

from glob import glob

from setuptools import find_packages, setup

PACKAGE = 'ddct_bringup'
MPC_STUDIES = {
    'admissible_scenarios': ['admissible_scenarios', 'prediction_ranges', 'worn_ranges'],
    'clutch_torque_limit': ['clutch_torque_limit'],
    'engine_authority': ['engine_authority'],
    'mpc4_readings': ['mpc4_readings'],
    'readings': ['readings'],
    'score_windows': ['score_windows'],
    'state_of_art': ['state_of_art', 'pedal_positions'],
    'torque_level': ['torque_level'],
    'torsion_weight': ['torsion_weight'],
    'two_input_wear': ['two_input_wear'],
    'wear': ['wear', 'wear_feedforward'],
    'wear_estimate': ['wear_estimate'],
}
"""Functions by module, all below studies/."""

setup(
    name=PACKAGE,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    package_data={
        f'{PACKAGE}.report_page': ['*.j2', '*.css', '*.js'],
        f'{PACKAGE}.calibration': ['admissible_scenarios/*'],
    },
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{PACKAGE}']),
        (f'share/{PACKAGE}', ['package.xml']),
        (f'share/{PACKAGE}/config', sorted(glob('config/*.yaml'))),
        (f'share/{PACKAGE}/foxglove', sorted(glob('foxglove/*.json'))),
    ],
    install_requires=[
        'setuptools',
        'bokeh',
        'jinja2',
        'markupsafe',
        'mcap',
        'mcap-ros2-support',
        'numpy',
        'rich',
        'scipy',
        'zstandard',
    ],
    extras_require={'live': ['foxglove-sdk'], 'test': ['pytest']},
    zip_safe=False,
    maintainer='DDCT team',
    maintainer_email='maintainers@ddct.invalid',
    description='The programs that run, record, score and compare engagements.',
    license='Apache-2.0',
    entry_points={
        'console_scripts': [
            'bringup = ddct_bringup.bringup:main',
            'calibrate = ddct_bringup.calibrate:main',
            'compare = ddct_bringup.compare:main',
            'live = ddct_bringup.live:main',
            'recorder = ddct_bringup.recorder_node:main',
            'report = ddct_bringup.report:main',
            'score = ddct_bringup.score:main',
        ],
        'ddct.mpc_studies': [
            f'{name} = ddct_bringup.studies.{module}:{name}'
            for module, names in MPC_STUDIES.items()
            for name in names
        ],
        'ddct.thesis_numbers': [
            'closed_loop = ddct_bringup.thesis.values:closed_loop_values',
        ],
        'ddct.thesis_figures': [
            'runs = ddct_bringup.thesis.run_figures:FIGURES',
            'scenario = ddct_bringup.thesis.scenario_figures:FIGURES',
        ],
    },
)
