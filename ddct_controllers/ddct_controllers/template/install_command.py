"""How a folder with a controller is installed into the environment that runs these programs."""

import sys
import sysconfig
from pathlib import Path


def install_command(folder: str) -> str:
    """
    Return the line that installs `folder` linked, so that an edited file runs at once.

    Nothing is fetched: the build uses the environment's own setuptools. On the wheel path uv is in
    the environment; Ubuntu's Python wants to be told that it may be added to.
    """
    uv = Path(sys.prefix) / 'bin' / 'uv'
    if uv.exists():
        return f'{uv} pip install --python {sys.executable} --no-build-isolation -e {folder}'
    managed = Path(sysconfig.get_path('stdlib')) / 'EXTERNALLY-MANAGED'
    allowed = '--break-system-packages ' if managed.exists() else ''
    return f'{sys.executable} -m pip install {allowed}--no-build-isolation -e {folder}'
