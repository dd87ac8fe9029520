# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Controllers in C out of a line of source: one that counts its calls, one that harms itself."""

from pathlib import Path

from ddct_controllers.from_file.c_library.library import HEADER, TEMPLATE
from support.exported_mpc import compile_c

SOURCE = (TEMPLATE / 'my_controller.c').read_text(encoding='utf-8')
COUNTS = 'static double calls = 0.0; calls += 1.0; command->clutch_torque = 1e-3 * calls;'
"""Body of an update that no second run in one process would repeat."""
HARMS = (
    'if (m->step == 65 && (int)fault == 1) exit(0);'
    'if (m->step == 65 && (int)fault == 2) abort();'
    'if (m->step == 65 && (int)fault == 3) raise(SIGSEGV);'
    'while (m->step == 65 && (int)fault == 4) {}'
)
"""Body of an update that ends or stops its process, by the option `fault`; 0 does not."""
ENDS = {
    1: 'it ended with exit code 0',
    2: 'it crashed (SIGABRT)',
    3: 'it crashed (SIGSEGV)',
    4: 'it gave no answer within 1 s',
}
"""Reason of the run by the value of `fault`, with a time limit of 1 s."""


def with_update(source: str) -> str:
    """Return the template with `source` as the body of update."""
    head, _, _ = SOURCE.partition('    const double slip =')
    return f'{head}    {source} return 0;\n}}\n'


def compile_library(folder: Path, source: str, *flags: str) -> Path:
    """Compile a controller in C in a folder; return the path of its library."""
    folder.mkdir(exist_ok=True)
    (folder / HEADER).write_bytes((TEMPLATE / HEADER).read_bytes())
    (folder / 'my_controller.c').write_text(source, encoding='utf-8')
    compile_c(folder, '-shared', '-fPIC', *flags, 'my_controller.c', '-o', 'my_controller.so')
    return folder / 'my_controller.so'


def counting(folder: Path, name: str = 'counting') -> str:
    """Return the file of a controller that counts its calls in a static variable."""
    return _file(folder, name, with_update(COUNTS))


def harmful(folder: Path, name: str = 'harmful') -> str:
    """Return the file of a PI controller that harms itself by `fault`, a key of ENDS."""
    before = '#include <signal.h>\n#include <stdlib.h>\ndouble fault = 0.0;\n'
    body = '    const double slip ='
    source = before + SOURCE.replace(body, f'    {HARMS}\n{body}')
    return _file(folder, name, source, ', parameters: {fault: 0.0}')


def failing(folder: Path, name: str = 'failing') -> str:
    """Return the file of a controller whose update returns -3 at step 65."""
    return _file(
        folder, name, with_update('if (m->step == 65) return -3; command->clutch_torque = 0.0;')
    )


def harmed_on_a_hill(folder: Path, name: str = 'harmed') -> str:
    """Return the file of a PI controller that crashes where the road load is that of a hill."""
    body = '    const double slip ='
    harm = '    if (m->step == 65 && m->load_torque > 200.0) raise(SIGSEGV);'
    source = '#include <signal.h>\n' + SOURCE.replace(body, f'{harm}\n{body}')
    return _file(folder, name, source)


def _file(folder: Path, name: str, source: str, more: str = '') -> str:
    library = compile_library(folder / name, source, '-w')
    file = folder / f'{name}.yaml'
    file.write_text(f'name: {name}\nc_library: {{file: {library}{more}}}\n', encoding='utf-8')
    return str(file)
