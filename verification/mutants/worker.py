"""A copy of HEAD with its own build folder, in which mutants are built and tested."""

import collections
import contextlib
import os
import re
import resource
import signal
import subprocess
import tempfile
import time
from dataclasses import dataclass, replace
from pathlib import Path

from affected import reached
from common.program import ROOT

# Configurations of a copy: for mistakes in headers, and for those in sources only. A precompiled
# header would outlive its mutant, and make each one compile everything. Without such mistakes a
# mutant costs one source and one library: programs link a shared library and stay unchanged, and
# ccache has all other objects from ordinary builds.
FOR_HEADERS = ["--preset", "quick", "-DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON"]
FOR_SOURCES = ["--preset", "developer", "-DBUILD_SHARED_LIBS=ON"]
FOR_SOURCES += ["-DCMAKE_LINK_DEPENDS_NO_SHARED=ON"]
MEMORY = 8 << 30  # bytes per test program, since a mistake may allocate without end
HANGS = 900  # s after which a test program counts as hanging
# Folders of code compiled into the program.
COMPILED = ("solver", "suite", "app")
# Folders of Python tests, with the folders whose modules they use and, if they run the program, its
# folders.
PYTHON_FOLDERS = {
    "bench": ("bench", "common", "exchange", "reference", "results", *COMPILED),
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
    """A failure of a tree. kind: 'killed', 'timeout', 'broken' (does not compile), 'false alarm'.

    by: the test, or the compiler's first error. program: the Program it belongs to.
    """

    kind: str
    by: str
    program: object


@dataclass(frozen=True)
class Program:
    """A group of tests: a GoogleTest program, or a folder of Python tests.

    linked: needs the library. size: of its source, bytes.
    """

    name: str
    is_python: bool
    linked: bool
    size: int = 0


def programs_of(tree):
    """All of them: those of kernels, then those that need the library, small sources first."""
    folder = tree / "verification"
    text = (folder / "CMakeLists.txt").read_text(encoding="utf-8")
    programs = []
    # A library, and the names of tests, each of which is also a program of its own.
    lists = re.findall(r"^add_tests\(\w+ (\w+)\n([^)]*)\)", text, re.MULTILINE)
    own = re.findall(r"^add_own_test\((\w+) (\w+)\)", text, re.MULTILINE)
    for library, names in [*lists, *((library, name) for name, library in own)]:
        for name in names.split():
            size = (folder / f"{name}.cpp").stat().st_size
            programs.append(Program(name, False, library != "sandglass_options", size))
    programs += [Program(folder, True, True) for folder in PYTHON_FOLDERS]
    return sorted(programs, key=lambda one: (one.is_python, one.linked, one.size))


class Worker:
    """Use as a context manager: at its end the copy is deleted and its processes have ended.

    revision: of git, which is copied. stop: threading.Event that ends everything with Stopped.
    jobs: number of parallel compilers. tests: names of programs in the order of their runs; all if
    empty. sources_only: whether no mutant changes a header.
    """

    def __init__(self, revision, stop, jobs=1, tests=(), sources_only=False):
        self._revision, self._stop, self._jobs, self._tests = revision, stop, jobs, tests
        self._sources_only = sources_only
        self._kills, self._passed = collections.Counter(), set()
        self._temporary = tempfile.TemporaryDirectory(prefix="sandglass-mutants.")
        self.folder = Path(self._temporary.name)
        self.tree = self.folder / "tree"
        self.build = self.tree / "build/copy"
        self.cli = self.build / "sandglass"
        # ccache recognizes compilations of earlier runs, in other folders.
        own = {"CCACHE_BASEDIR": str(self.tree), "CCACHE_NOHASHDIR": "1"}
        own |= {"SANDGLASS_BINARY": str(self.cli), "GIT_CEILING_DIRECTORIES": str(self.folder)}
        # Waiting threads must not spin, as there are more threads than processors.
        own |= {"PYTHONDONTWRITEBYTECODE": "1", "OMP_WAIT_POLICY": "passive"}
        self._environment = os.environ | own

    def __enter__(self):
        try:
            self.tree.mkdir()
            archive = self.folder / "tree.tar"
            self._run(["git", "-C", ROOT, "archive", "-o", archive, self._revision])
            self._run(["tar", "-xf", archive, "-C", self.tree])
            configuration = FOR_SOURCES if self._sources_only else FOR_HEADERS
            self._run(["cmake", *configuration, "-B", self.build])
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        self._temporary.cleanup()

    def first_failure(self, patch, seconds):
        """Applies a Patch, then builds and runs tests for at most `seconds` in total.

        Returns the first Failure or None. Programs that noticed most of the earlier mutants of the
        same files come first; those that the patch cannot affect are not run. A test that also
        fails without the patch is a 'false alarm'. Raises OutOfTime. The tree is clean again
        afterwards.
        """
        programs = {one.name: one for one in programs_of(self.tree)}
        programs = [programs[name] for name in self._tests or programs]
        programs = [one for one in programs if self._may_change(one, patch)]
        programs.sort(key=lambda one: -self._kills[patch.files, one.name])
        with self._applied(patch) as since:
            failure = self._failure(patch, programs, since, seconds)
        if failure and failure.kind != "broken":
            if failure.by not in self._passed and not self._passes(failure):
                return replace(failure, kind="false alarm")
            self._kills[patch.files, failure.program.name] += 1
            self._passed.add(failure.by)
        return failure

    def _failure(self, patch, programs, since, seconds):
        scripts = {name.partition("/")[0] for name in patch.files} - set(COMPILED)
        # One call for all that link the changed library: ninja takes longer than most tests.
        parts = [programs] if self._sources_only else [[program] for program in programs]
        for program in programs:
            status, text = self._make(*parts.pop(0)) if parts else (0, "")
            if status:
                error = re.search(r"^.*error: .*$", text, re.MULTILINE)
                return Failure("broken", error[0] if error else text[-300:], program)
            read = scripts & set(PYTHON_FOLDERS.get(program.name, ()))
            if not read and self._built(program) < since:
                continue
            started = time.monotonic()
            found = self._test(program, seconds)
            if found:
                return found
            seconds -= time.monotonic() - started
        return None

    def _may_change(self, program, patch):
        """Whether a patch can change what a program does."""
        if not program.is_python and not program.linked:
            source = f"verification/{program.name}.cpp"
            return not {source, *reached(self.tree, source)}.isdisjoint(patch.files)
        sources = PYTHON_FOLDERS.get(program.name, (*COMPILED, "verification"))
        return any(name.partition("/")[0] in sources for name in patch.files)

    def _make(self, *programs):
        targets = {"sandglass_cli" if one.is_python else one.name: None for one in programs}
        command = ["ninja", "-C", self.build, f"-j{self._jobs}", *targets]
        return self._run(command, check=False)

    def _passes(self, failure):
        """Whether the test of a Failure passes in the unchanged tree."""
        status, _ = self._make(failure.program)
        try:
            return (
                not status
                and not self._run(
                    self._command(failure.program, failure.by), limit=HANGS, check=False
                )[0]
            )
        except OutOfTime:
            return False

    def _built(self, program):
        """The time when a program, or a shared library that it may link, was last built."""
        files = [self._binary(program)]
        if program.linked:
            files += self.build.glob("solver/*.so")
        return max(file.stat().st_mtime for file in files)

    def _binary(self, program):
        return self.cli if program.is_python else self.build / "verification" / program.name

    def _test(self, program, left):
        """Runs a program for at most `left` seconds until its first failure, which is returned."""
        try:
            status, text = self._run(self._command(program), limit=min(HANGS, left), check=False)
        except OutOfTime:
            if left < HANGS:
                raise
            text = (self.folder / "output.txt").read_text(errors="replace")
            return Failure("timeout", _running(text, program), program)
        if not status:
            return None
        names = _failed_names(text)
        return Failure("killed", names[0] if names else _running(text, program), program)

    def _command(self, program, test=""):
        """The command for all tests of a program until one fails, or for one that failed."""
        if program.is_python:
            # Whether patches apply cannot be tested in a tree with one of them.
            command = [PYTHON, "-m", "pytest", "-x", "-q", "-rfE", "-p", "no:cacheprovider"]
            command += [f"--ignore={self.tree}/verification/test_mutants.py"]
            return command + [self.tree / (test.partition("[")[0] or program.name)]
        chosen = [f"--gtest_filter={test}"] if test not in ("", program.name) else []
        return [self._binary(program), "--gtest_brief=0", "--gtest_break_on_failure", *chosen]

    @contextlib.contextmanager
    def _applied(self, patch):
        """The tree with a patch; yields the time after which files belong to the mutant."""
        content = {self.tree / name: (self.tree / name).read_bytes() for name in patch.files}
        time.sleep(0.05)  # file systems have coarse clocks
        since = time.time() - 0.02
        try:
            self._run(["git", "apply", patch.path])
            yield since
        finally:
            # Newer than what was built from the mutant, which is built again.
            for path, before in content.items():
                path.write_bytes(before)

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
            pass  # already ended
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


def _failed_names(text):
    """The failed tests in a program's output, in order, each once."""
    names = re.findall(r"^\[  FAILED  \] ([^\s,]+/?[^\s,]*)(?:,| \()", text, re.MULTILINE)
    names += re.findall(r"^(?:FAILED|ERROR) (\S+)", text, re.MULTILINE)
    return list(dict.fromkeys(names))


def _running(text, program):
    """The test that was running when the output broke off."""
    names = re.findall(r"^\[ RUN      \] (\S+)", text, re.MULTILINE)
    return names[-1] if names else program.name
