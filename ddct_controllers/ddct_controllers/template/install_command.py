"""How a folder with a controller is installed into the environment that runs these programs."""

import sys
import sysconfig
from importlib.util import find_spec
from pathlib import Path


def install_command(folder: str) -> str:
    """
    Return the line that installs `folder` linked, so that an edited file runs at once.

    Nothing is fetched: the build uses the environment's own setuptools. uv is taken where it is in
    the environment, as on the wheel path, or where that has no pip; Ubuntu's Python wants to be
    told that it may be added to.
    """
    linked = f'--no-build-isolation -e {folder}'
    uv = Path(sys.prefix) / 'bin' / 'uv'
    if uv.exists() or find_spec('pip') is None:
        program = uv if uv.exists() else 'uv'
        return f'{program} pip install --python {sys.executable} {linked}'
    managed = Path(sysconfig.get_path('stdlib')) / 'EXTERNALLY-MANAGED'
    allowed = '--break-system-packages ' if managed.exists() else ''
    return f'{sys.executable} -m pip install {allowed}{linked}'
