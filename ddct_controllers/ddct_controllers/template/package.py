# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Write an installable package with a controller to start from, as `check --new` does."""

import keyword
import shlex
import sys
import sysconfig
from importlib.util import find_spec
from pathlib import Path
from string import Template

from ddct_controllers.from_file.controller_file import require_name
from ddct_controllers.registry import controller_names
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.files.output_file import write_text

TEMPLATES = Path(__file__).parent / 'files'
FILES = {
    'pyproject.toml': 'pyproject.toml.in',
    'README.md': 'README.md.in',
    'src/{name}.py': 'controller.py.in',
    'test_{name}.py': 'test_controller.py.in',
}
"""Templates by the name of the file that is written."""


def write_new(name: str, out: Path | None) -> str:
    """
    Write the package of a new controller to `out`, or to a folder with its name.

    Return what to do next, in lines. Raise ParameterError for a name that cannot be used,
    DdctError for a folder that is taken.
    """
    require_free_name(name)
    folder = (out or Path(name)).absolute()
    write_package(name, folder)
    return (
        f'{folder} is written. Next:\n'
        f'  {install_command(str(folder))}\n'
        f'  ddct check {name}\n'
        f'  ddct compare --controllers pi,{name} --headless --out runs/{name}'
    )


def require_free_name(name: str) -> None:
    """Raise ParameterError unless a new controller, and its module, can be called `name`."""
    require_name(name)
    if name in controller_names():
        raise ParameterError(f'{name} is the name of another controller: choose another', key=name)
    if keyword.iskeyword(name) or name in sys.builtin_module_names or _is_module(name):
        raise ParameterError(
            f'{name} is a module or word of Python already: choose another', key=name
        )


def _is_module(name: str) -> bool:
    """Return whether Python finds a module of that name, other than a mere folder."""
    found = find_spec(name)
    return found is not None and found.origin is not None


def install_command(folder: str) -> str:
    """
    Return the line that installs `folder` linked, so that an edited file runs at once.

    Nothing is fetched: the build uses the environment's own setuptools. uv is used where it is in
    the environment, as on the wheel path, or where that has no pip; pip needs an option to install
    into Ubuntu's Python.
    """
    linked = f'--no-build-isolation -e {shlex.quote(folder)}'
    python = shlex.quote(sys.executable)
    uv = Path(sys.prefix) / 'bin' / 'uv'
    if uv.exists() or find_spec('pip') is None:
        program = shlex.quote(str(uv)) if uv.exists() else 'uv'
        return f'{program} pip install --python {python} {linked}'
    managed = Path(sysconfig.get_path('stdlib')) / 'EXTERNALLY-MANAGED'
    allowed = '--break-system-packages ' if managed.exists() else ''
    return f'{python} -m pip install {allowed}{linked}'


def write_package(name: str, folder: Path) -> None:
    """Write the files of the controller `name` into the new `folder`; DdctError if it is taken."""
    try:
        folder.mkdir(parents=True)
        (folder / 'src').mkdir()
    except FileExistsError as error:
        raise DdctError(f'{folder} exists already: choose another --out') from error
    except OSError as error:
        raise DdctError(f'--out {folder}: cannot be made ({error.strerror})') from error
    values = {
        'name': name,
        'class_name': ''.join(word.capitalize() for word in name.split('_')),
        'distribution': name.strip('_').replace('_', '-'),
        'test_command': shlex.join([sys.executable, '-m', 'pytest', str(folder)]),
        'install_command': install_command(str(folder)),
    }
    for file, template in FILES.items():
        text = Template((TEMPLATES / template).read_text(encoding='utf-8')).substitute(values)
        write_text(str(folder / file.format(name=name)), text, 'give another --out')
