"""Clocking a program from its start to its end, alone on a processor where that is asked for."""

import os
import subprocess
import tempfile
import time
from dataclasses import dataclass

from common.errors import InputError


@dataclass(frozen=True)
class Clocked:
    """What a program did: exit code, what it printed, seconds of wall clock and on a processor."""

    code: int
    output: str
    errors: str
    seconds: float
    processor_seconds: float


def run(command, folder=None, environment=None, processor=None):
    """Run a command and clock it: Clocked.

    folder, environment: where and with what it runs; None: here, as here. processor: the number of
    the one that it keeps to, with all its threads; None: any. Raises InputError when it cannot be
    started.
    """
    pinned = (lambda: os.sched_setaffinity(0, {processor})) if processor is not None else None
    with tempfile.TemporaryFile("w+") as output, tempfile.TemporaryFile("w+") as errors:
        started = time.perf_counter()
        try:
            process = subprocess.Popen(
                [str(word) for word in command],
                cwd=folder,
                env=environment,
                stdout=output,
                stderr=errors,
                preexec_fn=pinned,
            )
        except OSError as error:
            raise InputError(f"{command[0]}: cannot run: {error.strerror}") from error
        _, status, used = os.wait4(process.pid, 0)
        seconds = time.perf_counter() - started
        process.returncode = os.waitstatus_to_exitcode(status)
        output.seek(0)
        errors.seek(0)
        return Clocked(
            process.returncode,
            output.read(),
            errors.read(),
            seconds,
            used.ru_utime + used.ru_stime,
        )
