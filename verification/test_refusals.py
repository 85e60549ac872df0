"""Wrong use of every command: exit code 2, a message that says what is wrong, and no file."""

import re
import shlex

import pytest
from command_line import sandglass

# A command | a text in its message, or several between "&"; indented lines continue a line.
# Commands run in a folder with block.toml, which has no golden.
REFUSED = r"""
"" | a command is missing; known: cases, methods, run
qwertz | 'qwertz' is not a command; known: cases
--verison | '--verison' is not an option; did you mean '--version'?
run | CASE
run column -x | run: '-x' is not an option
run column -o | run: --output needs a value
run column --threads x | run: --threads = x must be an integer
run column --threads 0,5 | run: --threads = 0,5 must be an integer
run column -k 0,1 | did you mean 0.1, with a decimal point?
mesh column | mesh: --output is required
verify --threads -1 | -1 not in range 0 to 1024
cases column | cases: 'column' is one argument too many
score x y --case column | score: 'y' is one argument too many
score x --case column --tolerance 0,1 |
  --tolerance = 0,1 must be a number; did you mean 0.1, with a decimal point?
choose column --tolerance 0,5% | did you mean 0.5%, with a decimal point?
choose column --budget 1,5ms | did you mean 1.5ms, with a decimal point?
choose column --budget 1,5,2 | without a unit it is in s
run colum | did you mean 'column'? & `sandglass cases` lists
verify colum | did you mean 'column'? & `sandglass cases` lists
mesh colum -o m.h5 | did you mean 'column'? & `sandglass cases` lists
run bending | 'bending' has 12 variants; name one of them & 2-nu0.49
run bending-2-nu0.48 | did you mean 'bending-2-nu0.4

run block.toml --method tl-pertubation |
  did you mean 'tl-perturbation'? & nearest of & : tl-perturbation, & `sandglass methods` lists all
run block.toml --kappa=-0.1 | kappa
run block.toml --kappa=nan | kappa
run block.toml --kappa= | kappa
run block.toml --kappa=0.1x | kappa
run block.toml --kappa-modulus bulk | 'bulk' must be 'p-wave' or 'shear'
run block.toml --method tl-full --kappa 0.1 | tl-full & kappa
run block.toml -o none/a.h5 | none/a.h5: cannot be written
run block.toml -o block.toml | --output = 'block.toml' must end in .h5
run block.toml -o result | --output = 'result' must end in .h5
run block.toml -o result.xdmf | --output = 'result.xdmf' must end in .h5
run block.toml -o result.vtu | --output = 'result.vtu' must end in .h5
run block.toml --accuracy 1% | --accuracy: 'tl-perturbation' does not adapt
run block.toml --checkpoint c --checkpoint-every=-1 | --checkpoint-every
run block.toml --checkpoint c --checkpoint-every=nan | --checkpoint-every
run block.toml --checkpoint c --checkpoint-every=often | --checkpoint-every
run block.toml --checkpoint none/c | none/c: cannot be written
run block.toml -o one.h5 --checkpoint one.h5 | must be another file than --output

run column --against truth | --against: needs --accuracy, the largest allowed error
run column --against golden --accuracy 1% | --against: golden not in {truth}
run column --against truth --accuracy 0 | --accuracy = '0' must be a share
run bar-wave --against truth --accuracy 1% | 'bar-wave' is a dynamic case
run column --against truth --accuracy 1% --sleep 1% | leave out --sleep
run column --against truth --accuracy 1% --checkpoint kept | leave out --checkpoint
run two-spheres --against truth --accuracy 1% | --against truth: a refined mesh & [[contact]]
run two-spheres --estimate truth | --estimate truth: a refined mesh & [[contact]]
run column --sleep 0 | --sleep = '0' must be a share in (0, 1]
run column --sleep 1 | --sleep = '1' is ambiguous; for one percent write 1%
run column --sleep 120% | --sleep = '120%' must be a share in (0, 1]
run bar-wave --sleep 1% | --sleep: 'bar-wave' is a dynamic case
run column --sleep 1% --checkpoint kept | leave out --checkpoint

mesh block.toml -o none/a.h5 | none/a.h5: cannot be written
mesh block.toml -o none/a.vtu | none/a.vtu: cannot be written
mesh block.toml -o a.stl | a.stl: format 'stl'; allowed are h5, vtu, xdmf and inp
mesh block.toml -o a.h5 --format msh | a.h5: format 'msh'
mesh block.toml -o a.vtu --deck calculix | a.vtu: a deck for CalculiX ends in .inp
mesh block.toml -o a.inp --deck abaqus | --deck abaqus: known: calculix
mesh block.toml -o none/a.inp --deck calculix | none/a.inp: cannot be written
mesh block.toml -o a.inp --element C3D8R | --element requires --deck
mesh block.toml -o a.inp --hourglass 0.1 | --hourglass requires --deck
mesh block.toml -o a.inp --deck calculix --format inp | excludes

verify block.toml --json none/v.json | v.json: cannot be written
verify block.toml --precision half | --precision = 'half' must be 'double' or 'float'

choose block.toml --tolerance 0 | --tolerance = '0' & (0, 1]
choose block.toml --tolerance 1pc | --tolerance = '1pc' & 1%
choose block.toml --tolerance 200% | --tolerance = '200%'
choose block.toml --budget 1min | --budget = '1min' & 1ms
choose block.toml --budget -1ms | --budget = '-1ms'
choose block.toml --against gold | --against & golden
choose block.toml --against truth | block.h5
choose block.toml --methods tl-nothing | 'tl-nothing' & known
choose block.toml --threads 0 | --threads = 0
choose block.toml --json /dev/null/choice.json | /dev/null/choice.json
choose block.toml --output /dev/null/chosen.toml | /dev/null/chosen.toml
choose block.toml -o block.toml | is an input of this command
choose block.toml -o new.toml --json ./new.toml | would be written twice
kernels tl-none block.toml -o new.c --constants ./new.c | would be written twice

stability block.toml --map lode | 'lode' & did you mean 'load'
stability block.toml --map load,load | --map & two different ones
stability block.toml --map load --values load=-1 | load = '-1' & (0, inf)
stability block.toml --map elements --values elements=1.5 | '1.5' & whole number
stability block.toml --map load --values nu=0.3 | no map has the axis 'nu'
stability block.toml --methods tl-nothing | 'tl-nothing' & known
stability block.toml --folder /dev/null/cells | /dev/null/cells
stability bar-wave | quasi-static

bench colum | did you mean 'column'?
bench --methods tl-ful | --methods: 'tl-ful' is not known; did you mean 'tl-full'?
bench --precision half | --precision = 'half' must be 'double' or 'float'
bench --threads 0 | --threads = 0 must be in [1, 1024]
bench --elements 0 | --elements = 0 must be in [1, 100000000]
bench --elements -8 | --elements = -8 must be in [1, 100000000]
bench --elements many | --elements
bench --rest --elements 8 | --rest
bench --rest --repetitions 8 | --rest
bench --rest --methods tl-ful | did you mean 'tl-full'?
bench --rest bar-wave | bar-wave.toml: a dynamic case has no static equilibrium to time
bench --repetitions 0 | --repetitions = 0 must be in [1, 1000000]
bench --elements 8 --repetitions 1 --methods tl-none --json none/b.json |
  b.json: cannot be written
"""
ROWS = [" ".join(row.split()) for row in re.split(r"\n+(?! )", REFUSED.strip())]


@pytest.mark.parametrize("row", ROWS)
def test_wrong_use_is_refused(block, row):
    command, _, message = row.partition("|")
    words = [word for word in shlex.split(command) if word]
    texts = [text for text in map(str.strip, message.split("&")) if text]
    outcome = sandglass(*words, cwd=block.parent, code=2, message=texts)
    assert outcome.stderr and not outcome.stdout
    assert [file.name for file in block.parent.iterdir()] == ["block.toml"]
