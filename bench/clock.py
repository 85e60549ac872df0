"""Times a program from start to end, bound to a processor if requested."""

import os
import subprocess
import tempfile
import time
from dataclasses import dataclass

from common.errors import InputError


@dataclass(frozen=True)
class Clocked:
    """The outcome of a program: exit code, output, seconds of wall time and of processor time."""

    code: int
    output: str
    errors: str
    seconds: float
    processor_seconds: float


def run(command, folder=None, environment=None, processor=None):
    """Runs a command and times it: Clocked.

    folder, environment: of the process; None means the current ones. processor: the number of the
    one to which it is bound with all its threads; None means any. Raises InputError if it cannot be
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
