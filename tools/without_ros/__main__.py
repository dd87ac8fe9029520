# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Install the packages by pip into an empty environment, and use them there, on any system.

It needs Python alone: `python tools/without_ros`. It ends with an error at what does not work.
"""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import venv
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ('ddct_plant', 'ddct_reference', 'ddct_controllers', 'ddct_bringup')
IGNORED = shutil.ignore_patterns('test', '__pycache__', '*.egg-info', 'build')
CONTROLLER = """\
from ddct_bringup.api import Command, Controller


class Squared(Controller):
    def reset(self):
        pass

    def update(self, measurement):
        slip = measurement.slip_error_rpm
        return Command(-1e-3 * slip * abs(slip))
"""
CAMPAIGN = """\
controllers: [squared.py, pi]
scenario: thesis
grid: {wear_gain: [0.9, 1.1]}
"""
LOCKED = """\
import subprocess, sys
from pathlib import Path
from ddct_bringup.run.output_folder import locked_folders
with locked_folders(Path('runs')):
    done = subprocess.run(sys.argv[1:], capture_output=True, text=True)
print(done.stderr.strip())
sys.exit(done.returncode != 1)
"""
"""Program that starts another one while it has locked the folder `runs`."""
COMPARE = ('compare', '--headless', '--controllers', 'pi,ls8', '--out', 'runs', '--overwrite')
COMMANDS = (
    COMPARE,
    ('score', 'runs'),
    ('identify', '--from', 'runs/pi', '--hold-out', '0.3', '--out', 'mycar'),
    ('campaign', 'wear.yaml', '--out', 'wear', '--workers', '2'),
    ('verify', 'runs'),
)


def main() -> int:
    """Try the packages in a temporary folder; return the exit code."""
    argparse.ArgumentParser(prog='python tools/without_ros', description=__doc__).parse_args()
    with tempfile.TemporaryDirectory(prefix='ddct_without_ros_') as made:
        try:
            for line in tried(Path(made)):
                print(line, flush=True)
        except subprocess.CalledProcessError as error:
            print(f'{error}:\n{error.stdout}{error.stderr}', file=sys.stderr)
            return 1
    return 0


def tried(folder: Path) -> Iterator[str]:
    """Yield a line for each use; raise CalledProcessError for the first that fails."""
    for package in PACKAGES:  # a build leaves files beside its sources
        shutil.copytree(ROOT / package, folder / package, ignore=IGNORED)
    venv.create(folder / 'venv', with_pip=True)
    programs = folder / 'venv' / ('Scripts' if os.name == 'nt' else 'bin')
    python, ddct = programs / 'python', programs / 'ddct'
    run(folder, python, '-m', 'pip', 'install', '--quiet', *(f'./{each}' for each in PACKAGES))
    yield f'installed by {sys.version.split()[0]} on {sys.platform}'
    (folder / 'squared.py').write_text(CONTROLLER, encoding='utf-8')
    (folder / 'wear.yaml').write_text(CAMPAIGN, encoding='utf-8')
    for command in COMMANDS:
        run(folder, ddct, *command)
        yield f'ddct {" ".join(command)}'
    refused = run(folder, python, '-c', LOCKED, str(ddct), *COMPARE)
    yield f'a second program in the folder of another: {refused.strip()}'


def run(folder: Path, *command: str | Path) -> str:
    """Return what a command prints that runs in a folder, without the environment of another."""
    environment = {
        name: value for name, value in os.environ.items() if not name.startswith('PYTHON')
    }
    done = subprocess.run(
        [*map(str, command)],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        encoding='utf-8',
        errors='replace',
        check=True,
    )
    return done.stdout


if __name__ == '__main__':
    sys.exit(main())
