"""`sandglass kernels`: the text of every dialect, run where a compiler is at hand.

written_test.cpp compares the text in C with the solver's kernels. Here OpenCL must give the bits of
C, and CUDA C++ must compile.
"""

import ctypes
import re
import shutil

import numpy as np
import pytest
from command_line import methods, ran, sandglass

REAL = {"double": (np.float64, ctypes.c_double), "float": (np.float32, ctypes.c_float)}
COUNT = 100


def written(dialect, precision, *more, method="tl-perturbation", case="column"):
    """The text of a kernel."""
    options = "--dialect", dialect, "--precision", precision, *more
    return sandglass("kernels", method, case, *options, code=0).stdout


def arrays_for(text, precision):
    """Random arrays for a kernel with a motion of 1 %, as its comment describes them."""
    random = np.random.default_rng(1)
    sizes = [int(n) for n in re.findall(r"^//   \w+ \((\d+) numbers\)", text, re.MULTILINE)]
    *inputs, _ = (random.uniform(-1, 1, n * COUNT) for n in sizes)
    inputs[0] *= 0.01
    return [array.astype(REAL[precision][0]) for array in inputs]


def results_in_c(text, inputs, precision, folder):
    """The forces from a kernel in C, compiled without contraction."""
    (folder / "kernel.c").write_text(text)
    flags = "-std=c99 -O2 -ffp-contract=off -shared -fPIC".split()
    done = ran("cc", *flags, folder / "kernel.c", "-o", folder / "kernel.so", "-lm")
    assert done.returncode == 0, done.stderr
    forces = np.empty(24 * COUNT, inputs[0].dtype)
    pointers = [
        array.ctypes.data_as(ctypes.POINTER(REAL[precision][1])) for array in [*inputs, forces]
    ]
    name = re.search(r"^void (\w+)\(", text, re.MULTILINE)[1]
    getattr(ctypes.CDLL(str(folder / "kernel.so")), name)(ctypes.c_long(COUNT), *pointers)
    return forces


def results_in_opencl(text, inputs):
    """The same from OpenCL, on its first device."""
    opencl = pytest.importorskip("pyopencl", reason="ci/setup test installs it")
    try:
        device = opencl.get_platforms()[0].get_devices()[0]
    except opencl.LogicError:
        pytest.skip("no OpenCL device: ci/setup test installs pocl-opencl-icd")
    context = opencl.Context([device])
    queue = opencl.CommandQueue(context)
    program = opencl.Program(context, "#pragma OPENCL FP_CONTRACT OFF\n" + text).build()
    flags = opencl.mem_flags
    copied = flags.READ_ONLY | flags.COPY_HOST_PTR
    buffers = [opencl.Buffer(context, copied, hostbuf=array) for array in inputs]
    forces = np.empty(24 * COUNT, inputs[0].dtype)
    buffers.append(opencl.Buffer(context, flags.WRITE_ONLY, forces.nbytes))
    program.all_kernels()[0](queue, (COUNT + 28,), None, np.int64(COUNT), *buffers)
    opencl.enqueue_copy(queue, forces, buffers[-1])
    return forces


@pytest.mark.parametrize("precision", REAL)
def test_opencl_computes_the_bits_of_c(precision, tmp_path):
    text = written("c", precision)
    inputs = arrays_for(text, precision)
    expected = results_in_c(text, inputs, precision, tmp_path)
    assert np.isfinite(expected).all() and np.abs(expected).max() > 0
    assert (results_in_opencl(written("opencl", precision), inputs) == expected).all()


# What a toolkit declares: clang alone knows only the language.
CUDA = """
#define __global__ __attribute__((global))
#define __device__ __attribute__((device))
struct Index { unsigned x, y, z; };
extern __device__ const Index blockIdx, blockDim, threadIdx;
__device__ float sqrt(float); __device__ double sqrt(double);
__device__ float fabs(float); __device__ double fabs(double);
"""


@pytest.mark.skipif(not shutil.which("clang++"), reason="needs clang: ci/setup sanitize")
@pytest.mark.parametrize("precision", REAL)
def test_cuda_compiles_for_cards(precision, tmp_path):
    (tmp_path / "kernel.cu").write_text(CUDA + written("cuda", precision, "--step"))
    flags = "-x cuda --cuda-device-only --cuda-gpu-arch=sm_70 -nocudainc -nocudalib -S -O1".split()
    done = ran("clang++", *flags, tmp_path / "kernel.cu", "-o", tmp_path / "kernel.ptx")
    assert done.returncode == 0, done.stderr
    for kernel in ("tl_perturbation_force", "sum_at_nodes", "move_nodes", "find_ill"):
        assert f".entry {kernel}(" in (tmp_path / "kernel.ptx").read_text()


def test_every_method_is_written_or_refused_with_a_reason():
    refused = []
    for method in methods():
        outcome = sandglass("kernels", method, "column", "--dialect", "wgsl")
        assert outcome.returncode in (0, 2)
        if outcome.returncode == 2:
            assert f"METHOD = '{method}' has no kernel that could be written: " in outcome.stderr
            refused.append(method)
        else:
            assert f"fn {method.replace('-', '_')}_force(" in outcome.stdout
    assert {"linear-condensed", "tl-adaptive", "t4-anp", "ul-perturbation"} <= set(refused)
    assert "ul-viscous" in refused  # its force depends on velocities, which the arrays do not have
    assert len(refused) < len(methods()) / 2


@pytest.mark.parametrize(
    "arguments, message",
    [
        ("tl-perturbation column --dialect hlsl", "--dialect: hlsl not in {c,opencl,cuda,wgsl}"),
        ("tl-perturbation column --dialect wgsl -p double", "WGSL has no double precision"),
        ("tl-perturbation column --material 2", "--material = 2 must be in [1, 1]"),
        ("tl-perturbation cardiac-beam-1 --dialect wgsl", "lose digits in WGSL"),
        ("tl-perturbation stiff-core", "materials; choose one with --material, from 1 to 2"),
    ],
)
def test_wrong_use(arguments, message):
    sandglass("kernels", *arguments.split(), code=2, message=message)


def test_file(tmp_path):
    file = tmp_path / "kernel.c"
    sandglass("kernels", "tl-full", "column", "-o", file, code=0)
    assert file.read_text() == sandglass("kernels", "tl-full", "column", code=0).stdout


def test_constants(tmp_path):
    """Those of elements of a material, in both precisions; test_card.py moves a body by them."""
    counts = []
    for material in "1", "2":
        found = {}
        for precision, (kind, _) in REAL.items():
            file = tmp_path / f"{precision}.{material}"
            options = "--precision", precision, "--material", material, "--constants", file
            text = sandglass("kernels", "tl-perturbation", "stiff-core", *options, code=0).stdout
            numbers = int(re.search(r"constants \((\d+) numbers\)", text)[1])
            found[precision] = np.fromfile(file, kind).reshape(numbers, -1)
        assert (found["double"].astype(np.float32) == found["float"]).all()
        counts.append(found["double"].shape[1])
    described = sandglass("mesh", "stiff-core", "-o", tmp_path / "mesh.vtu", code=0).stdout
    assert sum(counts) == int(re.search(r"(\d+) elements", described)[1])
