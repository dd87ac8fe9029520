# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What the product imports is what package.xml, setup.py and the way with apt tell to install."""

import ast
import re
import sys
import tomllib
import xml.etree.ElementTree as ElementTree
from functools import cache

import pytest
from support.declared import PACKAGES, ROOT, ROS, declared_to_pip, setup_of
from syntax import tree_of

pytestmark = pytest.mark.slow

FROM_PYPI = {
    'asammdf': ('asammdf', None),
    'bokeh': ('bokeh', 'python3-bokeh-pip'),
    'cffi': ('cffi', 'python3-cffi'),
    'clarabel': ('clarabel', None),
    'cloudpickle': ('cloudpickle', None),
    'control': ('control', 'python-control-pip'),
    'daqp': ('daqp', None),
    'distributed': ('distributed', None),
    'fmpy': ('fmpy', None),
    'foxglove': ('foxglove-sdk', None),
    'gymnasium': ('gymnasium', None),
    'jinja2': ('jinja2', 'python3-jinja2'),
    'markupsafe': ('markupsafe', None),
    'matplotlib': ('matplotlib', 'python3-matplotlib'),
    'mcap': ('mcap', None),
    'numpy': ('numpy', 'python3-numpy'),
    'optuna': ('optuna', None),
    'osqp': ('osqp', None),
    'pandas': ('pandas', 'python3-pandas'),
    'portalocker': ('portalocker', None),
    'pyarrow': ('pyarrow', None),
    'rich': ('rich', 'python3-rich'),
    'rosbags': ('rosbags', None),
    'scipy': ('scipy', 'python3-scipy'),
    'threadpoolctl': ('threadpoolctl', None),
    'yaml': ('pyyaml', 'python3-yaml'),
    'zstandard': ('zstandard', None),
}
"""By module its name on PyPI, and its key in ros/rosdistro's rosdep/python.yaml if it has one."""
BY_USERS = {'asammdf'}
"""Under the LGPL: users install it, and no lock of theirs has it."""
NOT_IMPORTED = {'ddct_reference': {'rclpy'}}
"""Modules that a package declares and does not import: not yet, or only by another's class."""


@cache
def imported(package: str) -> set[str]:
    """
    Return the top-level modules that a package's code imports, other than Python's own.

    `solver_package` imports the solver of quadratic programs that it is asked for.
    """
    modules = {package}
    for file in (ROOT / package / package).rglob('*.py'):
        for node in ast.walk(tree_of(file)):
            if isinstance(node, ast.Import):
                modules |= {alias.name.partition('.')[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
                modules.add(node.module.partition('.')[0])
            elif isinstance(node, ast.Call) and getattr(node.func, 'id', '') == 'solver_package':
                modules.add(ast.literal_eval(node.args[0]))
    return modules - {package} - set(sys.stdlib_module_names)


def declared_to_ros(package: str) -> set[str]:
    """Return what a package's package.xml needs at run time."""
    tree = ElementTree.parse(ROOT / package / 'package.xml')
    return {element.text for element in tree.iter('exec_depend') if element.text}


def test_every_module_that_is_imported_is_in_one_of_the_tables() -> None:
    modules = {module for package in PACKAGES for module in imported(package)}
    assert modules <= {*PACKAGES, *ROS, *FROM_PYPI}


@pytest.mark.parametrize('package', PACKAGES)
def test_package_xml_names_exactly_what_is_imported_and_has_a_key(package: str) -> None:
    expected = set()
    for module in imported(package) | NOT_IMPORTED.get(package, set()):
        key = FROM_PYPI[module][1] if module in FROM_PYPI else module
        expected |= {key} if key else set()
    assert declared_to_ros(package) == expected | implied_by_ros(package)


def implied_by_ros(package: str) -> set[str]:
    """Return what is imported by a name that is made when the program runs."""
    # `ros_class` imports the package of each topic's type.
    if package not in ('ddct_plant', 'ddct_bringup'):
        return set()
    from ddct_plant.signals.topics import TOPICS

    return {topic.type.partition('/')[0] for topic in TOPICS} | {'builtin_interfaces'}


@pytest.mark.parametrize('package', PACKAGES)
def test_setup_py_requires_exactly_what_is_imported(package: str) -> None:
    """Our own packages are required in the very same version."""
    version = setup_of(package)['version']
    modules = imported(package) | NOT_IMPORTED.get(package, set())
    own = {f'{each}=={version}' for each in modules if each in PACKAGES}
    required, extras = declared_to_pip(package)
    assert required | extras == own | {FROM_PYPI[each][0] for each in modules if each in FROM_PYPI}
    assert not required & extras


def test_the_container_of_the_way_with_apt_installs_from_pip_what_rosdep_cannot() -> None:
    """Ubuntu refuses packages of pip beside those of apt, unless the variable allows them."""
    container = (ROOT / 'containers' / 'apt.Dockerfile').read_text(encoding='utf-8')
    before, _, _ = container.partition('rosdep install')
    assert '\nENV PIP_BREAK_SYSTEM_PACKAGES=1\n' in before.partition('pip install')[0]
    (installed,) = re.findall(r'pip install ([^\\\n]+)', before)
    modules = {module for package in PACKAGES for module in imported(package)}
    needed = {name for module in modules for name in without_key(module)}
    required = {name for package in PACKAGES for name in declared_to_pip(package)[0]}
    with_others = {'markupsafe', 'zstandard'}
    assert set(installed.split()) == needed & required - with_others


def without_key(module: str) -> set[str]:
    name, key = FROM_PYPI.get(module, (module, module))
    return set() if key else {name}


def test_the_groups_of_the_wheel_path_name_all_of_it() -> None:
    names = {name for group in ('workspace', 'fmu', 'gym', 'tune') for name in in_group(group)}
    assert {name for name, _ in FROM_PYPI.values()} - BY_USERS <= names
    assert not names & BY_USERS


def test_each_group_has_a_lock_that_holds_all_of_it() -> None:
    locks = {file.stem: file.read_text(encoding='utf-8') for file in (ROOT / 'locks').iterdir()}
    assert set(locks) == set(groups())
    for group, text in locks.items():
        assert in_group(group) <= set(re.findall(r'^([\w.-]+)==', text, re.MULTILINE)), group


@cache
def groups() -> dict[str, list[str]]:
    """Return the requirements of each group of pyproject.toml."""
    text = (ROOT / 'pyproject.toml').read_text(encoding='utf-8')
    found: dict[str, list[str]] = tomllib.loads(text)['dependency-groups']
    return found


def in_group(group: str) -> set[str]:
    """Return the names of the packages that a group requires."""
    return {re.split(r'[\[<=]', each, maxsplit=1)[0] for each in groups()[group]}
