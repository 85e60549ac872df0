"""NVIDIA cards by ctypes: the driver (libcuda), and a compiler (NVRTC, or nvcc without it)."""

import ctypes
import glob
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

if __package__ in (None, ""):
    sys.path.insert(1, str(Path(__file__).resolve().parent.parent))

from common.errors import ComputationError, InputError

THREADS = 128  # of a block
POINTER = ctypes.c_void_p
_NVRTC = [
    "libnvrtc.so",
    *(f"libnvrtc.so.{version}" for version in (13, 12, "11.2")),
    "/usr/local/cuda*/lib64/libnvrtc.so*",
    "/usr/lib/*/libnvrtc.so*",
    f"{sys.prefix}/lib/python3*/site-packages/nvidia/*/lib/libnvrtc.so*",
]


def _library(names):
    """The first of these libraries, by name or pattern of paths, that can be loaded; else None."""
    for name in names:
        for place in sorted(glob.glob(name), reverse=True) if "/" in name else [name]:
            try:
                return ctypes.CDLL(place)
            except OSError:
                continue
    return None


def compiled(text, architecture):
    """The code of CUDA C++ text for an architecture such as "sm_80".

    Where the compiler is older than the card, it is portable code for the newest architecture that
    it knows, which the driver translates. Raises InputError without a compiler and for cards that
    it no longer knows, ComputationError with its messages if it fails.
    """
    nvrtc = _library(_NVRTC)
    if nvrtc is not None:
        return _by_nvrtc(nvrtc, text, architecture)
    nvcc = shutil.which("nvcc") or next(iter(glob.glob("/usr/local/cuda*/bin/nvcc")), None)
    if nvcc is None:
        raise InputError(
            "no compiler for CUDA C++ is found; allowed: libnvrtc of a CUDA toolkit or of `pip "
            "install nvidia-cuda-nvrtc`, or nvcc on the PATH"
        )
    return _by_nvcc(nvcc, text, architecture)


def _by_nvrtc(nvrtc, text, architecture):
    def call(name, *arguments, log=b""):
        code = getattr(nvrtc, name)(*arguments)
        if code != 0:
            raise ComputationError(f"{name} failed with error {code}\n{log() if log else ''}")

    count = ctypes.c_int()
    call("nvrtcGetNumSupportedArchs", ctypes.byref(count))
    known = (ctypes.c_int * count.value)()
    call("nvrtcGetSupportedArchs", known)
    number = int(architecture.split("_")[1])
    if number < min(known):
        raise InputError(f"this NVRTC compiles for sm_{min(known)} and newer, not {architecture}")
    own = number in known
    newest = max(each for each in known if each <= number)
    flag = f"--gpu-architecture={architecture if own else f'compute_{newest}'}".encode()
    program = POINTER()
    call("nvrtcCreateProgram", ctypes.byref(program), text.encode(), b"kernels.cu", 0, None, None)

    def result(kind):
        size = ctypes.c_size_t()
        call(f"nvrtcGet{kind}Size", program, ctypes.byref(size))
        code = ctypes.create_string_buffer(size.value)
        call(f"nvrtcGet{kind}", program, code)
        return code.raw

    flags = (ctypes.c_char_p * 1)(flag)
    call("nvrtcCompileProgram", program, 1, flags, log=lambda: result("ProgramLog").decode())
    code = result("CUBIN" if own else "PTX")
    call("nvrtcDestroyProgram", ctypes.byref(program))
    return code


def _by_nvcc(nvcc, text, architecture):
    with tempfile.TemporaryDirectory() as folder:
        source, code = Path(folder, "kernels.cu"), Path(folder, "kernels.cubin")
        source.write_text(text)
        command = [nvcc, "-cubin", f"-arch={architecture}", source, "-o", code]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise ComputationError(f"nvcc failed:\n{done.stderr}")
        return code.read_bytes()


class Card:
    """The first NVIDIA card, with a stream of its own. Raises InputError if there is none."""

    def __init__(self):
        self._driver = _library(["libcuda.so.1", "libcuda.so"])
        if self._driver is None:
            raise InputError("no NVIDIA card: libcuda.so.1, which its driver brings, is not found")
        count, device, context = ctypes.c_int(), ctypes.c_int(), POINTER()
        code = self._driver.cuInit(0)
        if code == 0:
            self._call("cuDeviceGetCount", ctypes.byref(count))
        if count.value == 0:
            raise InputError(f"no NVIDIA card: the driver finds none (error {code} of cuInit)")
        self._call("cuDeviceGet", ctypes.byref(device), 0)
        self._call("cuDevicePrimaryCtxRetain", ctypes.byref(context), device)
        self._call("cuCtxSetCurrent", context)
        name, version = ctypes.create_string_buffer(256), ctypes.c_int()
        self._call("cuDeviceGetName", name, 256, device)
        self._call("cuDriverGetVersion", ctypes.byref(version))
        self.name = name.value.decode()
        self.driver = f"{version.value // 1000}.{version.value % 1000 // 10}"
        major, minor = (self._attribute(device, number) for number in (75, 76))
        self.architecture = f"sm_{major}{minor}"
        self._stream = POINTER()
        self._call("cuStreamCreate", ctypes.byref(self._stream), 1)

    def _call(self, name, *arguments):
        code = getattr(self._driver, name)(*arguments)
        if code != 0:
            raise ComputationError(f"{name} of the driver failed with error {code}")

    def _attribute(self, device, number):
        value = ctypes.c_int()
        self._call("cuDeviceGetAttribute", ctypes.byref(value), number, device)
        return value.value

    def free_bytes(self):
        """The memory of the card that is free."""
        free, total = ctypes.c_size_t(), ctypes.c_size_t()
        self._call("cuMemGetInfo_v2", ctypes.byref(free), ctypes.byref(total))
        return free.value

    def functions(self, text, names):
        """The kernels of these names in CUDA C++ text, by name."""
        module, found = POINTER(), {}
        self._call("cuModuleLoadData", ctypes.byref(module), compiled(text, self.architecture))
        for name in names:
            found[name] = POINTER()
            self._call("cuModuleGetFunction", ctypes.byref(found[name]), module, name.encode())
        return found

    def zeros(self, size):
        """An array of so many bytes, all zero."""
        array = POINTER()
        self._call("cuMemAlloc_v2", ctypes.byref(array), ctypes.c_size_t(max(size, 16)))
        self._call("cuMemsetD8_v2", array, ctypes.c_ubyte(0), ctypes.c_size_t(max(size, 16)))
        self.wait()
        return array

    def release(self, array):
        """Gives its memory back."""
        self._call("cuMemFree_v2", array)

    def write(self, array, data):
        """Copies bytes to an array."""
        self._call("cuMemcpyHtoD_v2", array, bytes(data), ctypes.c_size_t(len(data)))
        self.wait()

    def read(self, array, size):
        """The first bytes of an array."""
        self.wait()
        data = ctypes.create_string_buffer(size)
        self._call("cuMemcpyDtoH_v2", data, array, ctypes.c_size_t(size))
        return data.raw

    def launch(self, function, items, *arguments):
        """Queues a kernel for so many items, with arguments of ctypes."""
        pointers = (POINTER * len(arguments))(
            *(ctypes.cast(ctypes.byref(argument), POINTER) for argument in arguments)
        )
        blocks = (items + THREADS - 1) // THREADS
        self._call(
            "cuLaunchKernel", function, blocks, 1, 1, THREADS, 1, 1, 0, self._stream, pointers, None
        )

    def recorded(self, queue):
        """Records what queue() queues and returns a function that queues it again, in one call."""
        graph, ready = POINTER(), POINTER()
        self._call("cuStreamBeginCapture_v2", self._stream, 0)
        queue()
        self._call("cuStreamEndCapture", self._stream, ctypes.byref(graph))
        self._call("cuGraphInstantiateWithFlags", ctypes.byref(ready), graph, ctypes.c_ulonglong(0))
        return lambda: self._call("cuGraphLaunch", ready, self._stream)

    def wait(self):
        """Waits for the end of all work."""
        self._call("cuCtxSynchronize")

    def seconds(self, queue):
        """The time from the start of what queue() queues to its end, by the clock of the card."""
        start, end, elapsed = POINTER(), POINTER(), ctypes.c_float()
        for event in (start, end):
            self._call("cuEventCreate", ctypes.byref(event), 0)
        self._call("cuEventRecord", start, self._stream)
        queue()
        self._call("cuEventRecord", end, self._stream)
        self._call("cuEventSynchronize", end)
        self._call("cuEventElapsedTime", ctypes.byref(elapsed), start, end)
        for event in (start, end):
            self._call("cuEventDestroy_v2", event)
        return 1e-3 * elapsed.value
