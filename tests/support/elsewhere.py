# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Python where our packages find no more of a system than Windows has.

Modules of ours get `os`, `signal` and the like without what Linux adds, a platform that is called
win32, and no file below /proc. Python itself and other libraries keep what they need here. Text
files without a stated encoding are read as ASCII.
"""

import os
import subprocess
import sys
from pathlib import Path

from waiting import WITHIN_S

SITE = """
import builtins, sys, types

ABSENT = {'fcntl', 'grp', 'posix', 'pwd', 'resource', 'termios'}
HIDDEN = {
    'os': {
        'fork', 'forkpty', 'getgid', 'geteuid', 'getuid', 'getpgid', 'getpgrp', 'setsid', 'killpg',
        'memfd_create', 'mkfifo', 'nice', 'pidfd_open', 'pread', 'pwrite', 'register_at_fork',
        'sched_getaffinity', 'sched_setaffinity', 'sched_setscheduler', 'sysconf', 'times',
        'uname', 'wait', 'wait3', 'wait4', 'waitid', 'WNOHANG', 'EX_OK', 'EX_USAGE', 'chown',
        'O_CLOEXEC', 'O_DIRECTORY', 'O_NOFOLLOW', 'O_NONBLOCK',
    },
    'signal': {
        'SIGALRM', 'SIGCHLD', 'SIGCONT', 'SIGHUP', 'SIGKILL', 'SIGPIPE', 'SIGQUIT', 'SIGSTOP',
        'SIGUSR1', 'SIGUSR2', 'ITIMER_REAL', 'alarm', 'pause', 'pthread_kill', 'pthread_sigmask',
        'setitimer', 'sigwait', 'SIG_BLOCK', 'SIG_SETMASK', 'SIG_UNBLOCK',
    },
    'select': {'poll', 'epoll'},
    'socket': {'AF_UNIX', 'socketpair'},
    'time': {'clock_gettime', 'clock_nanosleep', 'CLOCK_MONOTONIC'},
}


def only_spawn(method=None):
    if method != 'spawn':
        raise ValueError(f'cannot find context for {method!r}')
    import multiprocessing
    return multiprocessing.get_context(method)


def no_program(name, *others):
    if name is None:
        raise TypeError('LoadLibrary() argument 1 must be str, not None')
    import ctypes
    return ctypes.CDLL(name, *others)


OTHER = {
    'sys': {'platform': 'win32'},
    'multiprocessing': {'get_context': only_spawn},
    'ctypes': {'CDLL': no_program},
}
imported, made = builtins.__import__, {}


def seen(module):
    name = module.__name__
    if name not in made:
        made[name] = View(name)
    return made[name]


class View(types.ModuleType):
    def __getattribute__(self, key):
        name = super().__getattribute__('__name__')
        if key in HIDDEN.get(name, ()):
            raise AttributeError(f'module {name!r} has no attribute {key!r}', name=key)
        others = OTHER.get(name, {})
        return others[key] if key in others else getattr(sys.modules[name], key)

    def __setattr__(self, key, value):
        setattr(sys.modules[self.__name__], key, value)


def import_(name, globals=None, locals=None, fromlist=(), level=0):
    if str((globals or {}).get('__name__')).startswith('ddct_') and not level:
        if name.partition('.')[0] in ABSENT:
            raise ModuleNotFoundError(f'No module named {name!r}', name=name)
        found = imported(name, globals, locals, fromlist, level)
        return seen(found) if found.__name__ in {*HIDDEN, *OTHER} else found
    return imported(name, globals, locals, fromlist, level)


def on_event(event, arguments):
    if event == 'open' and str(arguments[0]).startswith(('/proc/', '/dev/shm', '/sys/')):
        caller = sys._getframe(1)
        while caller.f_back and caller.f_globals.get('__name__') in ('pathlib',):
            caller = caller.f_back
        if str(caller.f_globals.get('__name__')).startswith('ddct_'):
            raise FileNotFoundError(2, 'No such file or directory', arguments[0])


builtins.__import__ = import_
sys.addaudithook(on_event)
"""
"""The module that Python imports at its start, in worker processes too."""


def elsewhere(folder: Path) -> Path:
    """Make a folder for `PYTHONPATH` out of an existing one, and return it."""
    (folder / 'sitecustomize.py').write_text(SITE, encoding='utf-8')
    return folder


def python_elsewhere(
    site: Path, place: Path, *arguments: str, within_s: float = WITHIN_S
) -> 'subprocess.CompletedProcess[str]':
    """Run Python in a folder `place` where `site` is that of `elsewhere`."""
    environment = {
        **os.environ,
        'PYTHONPATH': os.pathsep.join([str(site), *sys.path]),
        # The encoding of text files is then ASCII, as that of Windows is not UTF-8 either.
        **{'LC_ALL': 'C', 'PYTHONCOERCECLOCALE': '0', 'PYTHONUTF8': '0'},
    }
    return subprocess.run(
        [sys.executable, *arguments],
        cwd=place,
        env=environment,
        capture_output=True,
        encoding='utf-8',
        errors='replace',
        timeout=within_s,
        check=False,
    )
