"""A copy of the tree with its own build folder, in which mutants are built and tested."""

import contextlib
import fcntl
import os
import re
import resource
import shutil
import signal
import subprocess
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from common.program import ROOT

PRESET = "quick"
MEMORY = 8 << 30  # bytes that a test program may use: a mistake may allocate without end
# Sources that compile slowly have large object files: seconds per file, and per megabyte.
SECONDS_TO_COMPILE = (3, 5)
SLOWER = 20  # a program that takes this many times longer than on the clean tree hangs
SHORTEST_LIMIT = 120  # s
# Folders of what is compiled into the program.
COMPILED = ("solver", "suite", "app")
# Folders of Python tests, with the folders whose modules they use and, where they run it, those of
# the program.
PYTHON_FOLDERS = {
    "bench": ("bench", "common", "exchange", "reference", *COMPILED),
    "common": ("common",),
    "exchange": ("common", "exchange", *COMPILED),
    "packaging": ("packaging",),
    "reference": ("common", "reference", *COMPILED),
    "reports": ("common", "reports", "results"),
    "results": ("common", "exchange", "results", *COMPILED),
    "verification": ("common", "docs", "verification", *COMPILED),
}
PYTHON = "/usr/bin/python3"


class Stopped(Exception):
    """The run was interrupted."""


class OutOfTime(Exception):
    """A command exceeded its time limit."""


@dataclass(frozen=True)
class Failure:
    """Where a tree fails. kind: 'killed', 'timeout' or 'broken' (it does not compile).

    by: the test, or the compiler's first error. program: what it belongs to.
    """

    kind: str
    by: str
    program: str


@dataclass
class Program:
    """Something that tests: a program of GoogleTest, or a folder of Python tests.

    linked: needs the library. size: of its object file, bytes. seconds: on the clean tree.
    kills: how many mutants it has killed so far.
    """

    name: str
    is_python: bool
    linked: bool
    size: int = 0
    seconds: float = 0.0
    kills: int = 0

    def cost(self):
        """Sorts kernels before what needs the library, then by what a kill costs: about the
        seconds to compile and to run over the mutants that are killed by it."""
        any_file, megabyte = SECONDS_TO_COMPILE
        compiled = any_file + megabyte * self.size / 2**20
        return (self.is_python, self.linked, (compiled + self.seconds) / (1 + self.kills))


def programs_of(tree):
    """All of them, in the order of the files that list them."""
    text = (tree / "verification" / "CMakeLists.txt").read_text(encoding="utf-8")
    programs = []
    # A library, the target whose precompiled headers are shared, and the programs.
    for library, names in re.findall(r"^add_tests\((\w+) \w+\n([^)]*)\)", text, re.MULTILINE):
        programs += [Program(n, False, library != "sandglass_options") for n in names.split()]
    return programs + [Program(folder, True, True) for folder in PYTHON_FOLDERS]


class Worker:
    """Use as a context manager: the copy is gone afterwards, and what ran in it has ended.

    revision: of git, which is copied. stop: threading.Event that ends everything with Stopped.
    """

    def __init__(self, revision, stop):
        self._revision, self._stop = revision, stop
        self.folder, self._lock = _free_folder()
        self.tree = self.folder / "tree"
        self.build = self.tree / "build" / PRESET
        self.cli = self.build / "sandglass"
        # The same paths in every run, so that ccache recognizes earlier compilations.
        own = {"CCACHE_BASEDIR": str(self.tree), "CCACHE_NOHASHDIR": "1"}
        own |= {"SANDGLASS_BINARY": str(self.cli), "GIT_CEILING_DIRECTORIES": str(self.folder)}
        # Waiting threads must not spin, as there are more of them than processors.
        own |= {"PYTHONDONTWRITEBYTECODE": "1", "OMP_WAIT_POLICY": "passive"}
        self._environment = os.environ | own

    def __enter__(self):
        try:
            self.tree.mkdir()
            archive = self.folder / "tree.tar"
            self._run(["git", "-C", ROOT, "archive", "-o", archive, self._revision])
            self._run(["tar", "-xf", archive, "-C", self.tree])
            # A precompiled header would outlive its mutant, and make each one compile everything.
            self._run(["cmake", "--preset", PRESET, "-DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON"])
            self._run(["ninja", "-C", self.build, "-j1"])
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        shutil.rmtree(self.folder, ignore_errors=True)
        self._lock.close()

    def programs(self):
        """The test programs here, with the sizes of their objects."""
        programs = programs_of(self.tree)
        for program in programs:
            if not program.is_python:
                objects = self.build / f"verification/CMakeFiles/{program.name}.dir"
                program.size = (objects / f"{program.name}.cpp.o").stat().st_size
        return programs

    def failures(self, program):
        """The names of all tests of a program that fail, and the seconds it took."""
        started = time.monotonic()
        status, text = self._run(self._command(program), check=False)
        names = _failed_names(text)
        if status and not names:
            names = [f"{program.name}: exit code {status}"]
        return names, time.monotonic() - started

    def first_failure(self, patch, programs, seconds):
        """Applies a Patch, builds and tests program after program for at most so many seconds.

        Returns the first Failure or None. What the patch does not touch is not run: it is what it
        was. Raises OutOfTime. The tree is clean again afterwards.
        """
        deadline = time.monotonic() + seconds
        changed = {name.partition("/")[0] for name in patch.files}
        with self._applied(patch) as since:
            for program in programs:
                if not self._may_change(program, changed):
                    continue
                left = deadline - time.monotonic()
                command = ["ninja", "-C", self.build, "-j1", self._target(program)]
                status, text = self._run(command, limit=left, check=False)
                if status:
                    error = re.search(r"^.*error: .*$", text, re.MULTILINE)
                    return Failure("broken", error[0] if error else text[-300:], program.name)
                scripts = changed & set(PYTHON_FOLDERS.get(program.name, ())) - set(COMPILED)
                if not scripts and self._binary(program).stat().st_mtime < since:
                    continue
                found = self._test(program, deadline - time.monotonic())
                if found:
                    return found
        return None

    @staticmethod
    def _may_change(program, changed):
        """Whether a patch of these folders can change what a program does."""
        sources = PYTHON_FOLDERS.get(program.name, (*COMPILED, "verification"))
        return not changed.isdisjoint(sources)

    @staticmethod
    def _target(program):
        return "sandglass_cli" if program.is_python else program.name

    def _binary(self, program):
        return self.cli if program.is_python else self.build / "verification" / program.name

    def _test(self, program, left):
        """Runs a program for at most `left` seconds until its first failure, which is returned."""
        limit = max(SHORTEST_LIMIT, SLOWER * program.seconds)
        output = self.folder / "output.txt"
        try:
            command = self._command(program, first_only=True)
            status, text = self._run(command, limit=min(limit, left), check=False)
        except OutOfTime:
            if left < limit:
                raise
            return Failure(
                "timeout", _running(output.read_text(errors="replace"), program), program.name
            )
        if not status:
            return None
        names = _failed_names(text)
        return Failure("killed", names[0] if names else _running(text, program), program.name)

    def _command(self, program, first_only=False):
        if program.is_python:
            # Whether patches apply is no question to a tree with one of them.
            command = [PYTHON, "-m", "pytest", "-q", "-rfE", "-p", "no:cacheprovider"]
            command += [f"--ignore={self.tree}/verification/test_mutants.py"]
            return command + ["-x"] * first_only + [self.tree / program.name]
        path = self.build / "verification" / program.name
        return [path, "--gtest_brief=0"] + ["--gtest_break_on_failure"] * first_only

    @contextlib.contextmanager
    def _applied(self, patch):
        """The tree with a patch; yields the time after which files are the mutant's."""
        before = {self.tree / name: (self.tree / name).stat() for name in patch.files}
        content = {path: path.read_bytes() for path in before}
        time.sleep(0.05)  # clocks of file systems tick slowly
        since = time.time() - 0.02
        try:
            self._run(["git", "apply", patch.path])
            yield since
        finally:
            for path, status in before.items():
                path.write_bytes(content[path])
                os.utime(path, ns=(status.st_atime_ns, status.st_mtime_ns))
            self._remove_built(since)

    def _remove_built(self, since):
        """Removes the files built from a mutant; all others are up to date and stay."""
        for path in self.build.rglob("*"):
            is_built = path.suffix in (".o", ".a") or (not path.suffix and os.access(path, os.X_OK))
            if is_built and path.is_file() and path.stat().st_mtime >= since:
                path.unlink()

    def _run(self, command, limit=None, check=True):
        """Runs a command in the tree: (exit status, text). Raises OutOfTime after `limit` s."""
        output = self.folder / "output.txt"
        started = time.monotonic()
        with open(output, "wb") as file:
            process = subprocess.Popen(
                [str(part) for part in command],
                cwd=self.tree,
                env=self._environment,
                stdin=subprocess.DEVNULL,
                stdout=file,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )
        try:
            resource.prlimit(process.pid, resource.RLIMIT_CORE, (0, 0))
            if Path(str(command[0])).parent == self.build / "verification":
                resource.prlimit(process.pid, resource.RLIMIT_AS, (MEMORY, MEMORY))
        except ProcessLookupError:
            pass  # it has ended already
        try:
            while True:
                with contextlib.suppress(subprocess.TimeoutExpired):
                    process.wait(0.1)
                    break
                if self._stop.is_set():
                    raise Stopped
                if limit is not None and time.monotonic() - started > limit:
                    raise OutOfTime(f"{Path(str(command[0])).name} ran longer than {limit:.0f} s")
        finally:
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()
        text = output.read_text(errors="replace")
        if check and process.returncode:
            raise RuntimeError(f"{' '.join(map(str, command))} failed:\n{text[-3000:]}")
        return process.returncode, text


def _free_folder():
    """A folder that no other run uses, and its open lock."""
    base = Path(tempfile.gettempdir()) / f"sandglass-mutants-{os.getuid()}"
    base.mkdir(mode=0o700, exist_ok=True)
    for number in range(1000):
        lock = open(base / f"{number}.lock", "w")
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            lock.close()
            continue
        folder = base / str(number)
        shutil.rmtree(folder, ignore_errors=True)  # of a run that was killed
        folder.mkdir()
        return folder, lock
    raise RuntimeError(f"{base}: all folders are in use")


def _failed_names(text):
    """The failed tests in a program's output, in order, each once."""
    names = re.findall(r"^\[  FAILED  \] ([^\s,]+/?[^\s,]*)(?:,| \()", text, re.MULTILINE)
    names += re.findall(r"^(?:FAILED|ERROR) (\S+)", text, re.MULTILINE)
    return list(dict.fromkeys(names))


def _running(text, program):
    """The test that was running when the output broke off."""
    names = re.findall(r"^\[ RUN      \] (\S+)", text, re.MULTILINE)
    return names[-1] if names else program.name
