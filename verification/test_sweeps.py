"""The workflow of all sweeps: its plan, what it repeats, what a killed job loses."""

import json
import os
import re
import shutil
import subprocess

import pytest
from command_line import (
    BARE,
    BINARY,
    BLOCK,
    LIMIT,
    PATIENCE,
    ROOT,
    methods,
    sandglass,
    write_golden,
)

pytestmark = pytest.mark.skipif(
    not shutil.which("snakemake"), reason="Snakemake is not installed: ci/setup sweeps"
)

SWEEPS = ROOT / "verification/sweeps"
NOTHING = "Nothing to be done"
# Runs the program; the first run that verifies a case is killed with its shell and noted.
KILLED_ONCE = f"""#!/bin/bash
if [ "$1" = verify ] && mkdir "$KILLED" 2>/dev/null; then
  touch "$KILLED/$2"
  "{BINARY}" "$@" &
  kill -9 $!
  kill -9 "${{VICTIM:-$$}}"
fi
exec "{BINARY}" "$@"
"""
# In place of Slurm: jobs are processes, each in its own session as on its own node.
SBATCH = """#!/bin/bash
id=$$
echo "$@" >>"$SLURM_STUB/submitted"
(
  setsid bash "${@: -1}"
  echo $? >"$SLURM_STUB/$id.part"
  mv "$SLURM_STUB/$id.part" "$SLURM_STUB/$id"
) >/dev/null 2>&1 &
echo $id
"""
SCONTROL = """#!/bin/bash
end=$SLURM_STUB/${@: -1} state=RUNNING
if [ -e "$end" ]; then [ "$(cat "$end")" = 0 ] && state=COMPLETED || state=FAILED; fi
echo "JobId=${@: -1} JobState=$state Reason=None"
"""


def snakemake(folder, *arguments, profile="local", **environment):
    """Runs the workflow in a folder; the outcome, with all output as its stdout."""
    command = ["snakemake", "-s", SWEEPS / "Snakefile", "--profile", SWEEPS / "profiles" / profile]
    command += ["--directory", folder, *arguments]
    environment = {"SANDGLASS_BINARY": BINARY, "XDG_CACHE_HOME": str(folder)} | environment
    return subprocess.run(
        list(map(str, command)),
        env=os.environ | environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=200 * PATIENCE,
    )


def script(path, text):
    """Writes a program."""
    path.write_text(text)
    path.chmod(0o755)
    return path


def jobs(text, rule):
    """The outputs of a rule's jobs, in order."""
    found = re.findall(r"^(?:local)?rule (\w+):\n((?:    .*\n)*)", text, re.MULTILINE)
    return [re.search(r"output: (.*)", about)[1] for name, about in found if name == rule]


def wildcards(text, rule, place):
    """The wildcards of a rule's jobs: matches of a pattern with their whole outputs."""
    return [re.fullmatch(place, output)[1] for output in jobs(text, rule)]


@pytest.fixture
def sweeps(tmp_path):
    """Runs the workflow in a folder of its own, with three small cases: a, b and c."""
    cases = tmp_path / "cases"
    cases.mkdir()
    for name in "abc":
        (cases / f"{name}.toml").write_text(BARE.replace('"block"', f'"{name}"'))

    def run(*arguments, **options):
        return snakemake(tmp_path, *arguments, **{"SANDGLASS_CASES": str(cases)} | options)

    return run


def verdicts(folder):
    """The cases that have verdicts."""
    return sorted(file.stem for file in folder.glob("build/sweeps/verdicts/*.json"))


def without_times(file):
    """A file of `sandglass verify --json` without what differs between runs."""
    document = json.loads(file.read_text())
    seconds = ("ns_", "check_ns", "seconds_per", "equilibrium_sec", "motion_sec")
    keep = {
        "records": [{k: r[k] for k in r if not k.startswith(seconds)} for r in document["records"]]
    }
    return document | keep


def test_all_sweeps_are_planned(tmp_path):
    """A job for each case, method, patch and program, from independent lists."""
    programs = "programs=calculix=ccx febio:native=bin/febio4"
    plan = snakemake(tmp_path, "-n", "-c", 3, "--forceall", "--config", programs)
    assert plan.returncode == 0, plan.stdout[-2000:]
    text = plan.stdout
    cases = {line.split()[0]: line.split()[1] for line in sandglass("cases").stdout.splitlines()}
    verified = wildcards(text, "verify_case", "build/sweeps/verdicts/(.*).json")
    assert len(set(verified)) == len(verified)
    for name in set(cases) - set(verified):
        assert cases[name] == "dynamic" and sandglass("verify", name).returncode == 2
    assert set(verified) < set(cases) and {"column", "plucked-beam"} < set(verified)
    drawn = [file.name for file in (ROOT / "reports/figures").glob("stability.*.png")]
    drawn = {re.fullmatch(r"stability\.(.*)\.[a-z-]+\.png", name)[1] for name in drawn}
    mapped = wildcards(text, "map_figures", "build/sweeps/maps-of-(.*)")
    assert drawn <= set(mapped)
    parts = wildcards(text, "map_method", "build/stability/parts/(.*).json")
    assert sorted(parts) == sorted(f"{case}.{method}" for case in mapped for method in methods())
    patches = [file.stem for file in (ROOT / "verification/mutants").glob("*.patch")]
    mutants = wildcards(text, "mutant", f"{ROOT}/build/mutant-results/(.*).json")
    assert sorted(mutants) == sorted(patches)
    assert set(wildcards(text, "curve_case", "build/sweeps/curves-of-(.*)")) < set(cases)
    peers = wildcards(text, "peer", "build/peers/(.*).json")
    ours = ("column", "ellipsoid-indentation")
    assert set(peers) == {
        f"{case}.{name}" for case in ours for name in ("calculix", "febio:native")
    }
    # Jobs that are timed have the machine to themselves.
    for rule in ("curve_case", "peer"):
        found = re.findall(rf"^rule {rule}:\n(?:    .*\n)*?    threads: (.*)", text, re.MULTILINE)
        assert set(found) == {"3"}
    assert not jobs(snakemake(tmp_path, "-n", "peers").stdout, "peer")


def test_kinds_and_their_cases_can_be_chosen(tmp_path):
    """A variant with a dot in its name; file names also have one between case and method."""
    chosen = ("maps=column bending-2-nu0.49", "mutants=017")
    plan = snakemake(tmp_path, "-n", "maps", "mutants", "--forceall", "--config", *chosen)
    parts = wildcards(plan.stdout, "map_method", "build/stability/parts/(.*).json")
    names = ("column", "bending-2-nu0.49")
    assert sorted(parts) == sorted(f"{case}.{method}" for case in names for method in methods())
    assert jobs(plan.stdout, "mutant")[0].startswith(f"{ROOT}/build/mutant-results/017-")
    assert len(jobs(plan.stdout, "mutant")) == 1
    assert not jobs(plan.stdout, "verify_case")
    wrong = snakemake(tmp_path, "-n", "maps", "--config", "maps=colum")
    assert wrong.returncode == 1
    assert "'colum' is not known; did you mean 'column'?" in wrong.stdout


def test_finished_jobs_are_not_repeated(sweeps, tmp_path):
    part = "build/stability/parts/a.tl-full.json"
    first = sweeps("-c", 2, "verify", part)
    assert first.returncode == 0, first.stdout
    assert verdicts(tmp_path) == ["a", "b", "c"]
    assert {m["name"] for m in json.loads((tmp_path / part).read_text())["maps"]} > {"load-nu"}
    whole = tmp_path / "whole.json"
    cases = tmp_path / "cases"
    files = [cases / f"{name}.toml" for name in "abc"]
    assert sandglass("verify", *files, "--json", whole).returncode == 0
    assert without_times(tmp_path / "build/verdicts.json") == without_times(whole)
    for name in ("a.tl-full.h5", "c.t4.h5"):
        assert (tmp_path / "build/verify" / name).exists()
    assert NOTHING in sweeps("-c", 2, "verify", part).stdout
    # A newer file with the same case changes nothing, another case does.
    files[0].touch()
    assert NOTHING in sweeps("-c", 2, "verify", part).stdout
    files[1].write_text(files[1].read_text().replace("0.02,", "0.01,"))
    again = sweeps("-c", 2, "verify", part)
    assert jobs(again.stdout, "verify_case") == ["build/sweeps/verdicts/b.json"], again.stdout
    assert len(jobs(again.stdout, "verdicts")) == 1 and not jobs(again.stdout, "map_method")


def test_a_killed_job_is_lost_alone(sweeps, tmp_path):
    program = script(tmp_path / "killed-once", KILLED_ONCE)
    options = {"SANDGLASS_BINARY": str(program), "KILLED": str(tmp_path / "killed")}
    first = sweeps("-c", 1, "verify", **options)
    assert first.returncode == 1 and "Error in rule verify_case" in first.stdout
    assert len(jobs(first.stdout, "verify_case")) == 3  # two of them after the kill
    (killed,) = [file.name for file in (tmp_path / "killed").iterdir()]
    assert verdicts(tmp_path) == [name for name in "abc" if name != killed]
    assert not (tmp_path / "build/verdicts.json").exists()
    second = sweeps("-c", 1, "verify", **options)
    assert second.returncode == 0, second.stdout
    assert jobs(second.stdout, "verify_case") == [f"build/sweeps/verdicts/{killed}.json"]
    assert verdicts(tmp_path) == ["a", "b", "c"] and (tmp_path / "build/verdicts.json").exists()
    assert NOTHING in sweeps("-c", 1, "verify", **options).stdout


def test_a_job_that_is_killed_with_all_it_runs_on_slurm_is_submitted_again(sweeps, tmp_path):
    """Such a job cannot report its end to Snakemake: the profile asks Slurm."""
    stub = tmp_path / "slurm"
    stub.mkdir()
    for name, text in (("sbatch", SBATCH), ("scontrol", SCONTROL)):
        script(stub / name, text)
    options = {
        "SANDGLASS_BINARY": str(script(tmp_path / "killed-once", KILLED_ONCE)),
        "KILLED": str(tmp_path / "killed"),
        "VICTIM": "0",  # all processes of the session
        "SLURM_STUB": str(stub),
        "PATH": f"{stub}:{os.environ['PATH']}",
        "CI": "true",  # Snakemake checks every second
    }
    done = sweeps("verify", profile="slurm", **options)
    assert done.returncode == 0, done.stdout
    assert verdicts(tmp_path) == ["a", "b", "c"]
    submitted = (stub / "submitted").read_text().splitlines()
    names = [re.search(r"--job-name=sweep-(\w+)", line)[1] for line in submitted]
    assert names.count("verify_case") == 4 and names.count("verdicts") == 1
    for line in submitted:
        assert "--parsable" in line and "--mem=2000 " in line and "--exclusive" not in line
        assert "--time=240 " in line
    assert NOTHING in sweeps("verify", profile="slurm", **options).stdout
    # Jobs that are timed have a node to themselves; this one fails because it has no golden.
    assert sweeps("build/sweeps/curves-of-a", profile="slurm", **options).returncode == 1
    line = (stub / "submitted").read_text().splitlines()[-1]
    assert "--job-name=sweep-curve_case" in line and "--exclusive" in line
    assert "--cpus-per-task=1 " in line


def test_broken_limits_fail_the_run_and_keep_the_answers(sweeps, tmp_path):
    case = tmp_path / "cases/c.toml"
    limit = LIMIT.format(method="tl-perturbation", below=1e-12)
    case.write_text(BLOCK.replace('"block"', '"c"') + limit)
    write_golden(case)
    for ran in (3, 0):
        done = sweeps("-c", 2, "verify")
        assert done.returncode == 1
        assert "BROKEN c tl-perturbation kappa auto: max_relative_error, golden" in done.stdout
        assert len(jobs(done.stdout, "verify_case")) == ran
        assert len(json.loads((tmp_path / "build/verdicts.json").read_text())["limits"]) == 1


def test_verdicts_of_another_program_are_not_joined(tmp_path):
    document = {"revision": "one", "records": [1], "limits": []}
    files = [tmp_path / name for name in ("a.json", "b.json")]
    for file, revision in zip(files, ("one", "two"), strict=True):
        file.write_text(json.dumps(document | {"revision": revision}))
    command = ["/usr/bin/python3", SWEEPS / "verdicts.py", *files, "-o", tmp_path / "whole.json"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 2 and not (tmp_path / "whole.json").exists()
    assert f"b.json: revision = 'two' must be 'one', as in {files[0]}" in done.stderr
