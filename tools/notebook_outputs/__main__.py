# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Execute the notebooks and write them with their outputs, minutes.

    tools/run notebook_outputs
"""

import sys

from ddct_plant.base.errors import DdctError
from notebook_outputs.outputs import write_notebooks

if __name__ == '__main__':
    try:
        for page in write_notebooks():
            print(f'{page} has changed')
    except DdctError as error:
        sys.exit(f'tools/run notebook_outputs: {error}')
