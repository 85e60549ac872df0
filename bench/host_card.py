"""For tests: the kernels for cards as C++ on this processor."""

import ctypes
import re

from common.program import output_of

# What a card provides, and each kernel in a loop over its items.
HOST = """
#include <cmath>
using std::fabs; using std::sqrt;
#define __global__
#define __device__ static
struct Index { unsigned x; };
static Index blockIdx, blockDim{1}, threadIdx;
"""
LOOP = """
extern "C" void run_{name}(unsigned items, {parameters}) {{
  for (blockIdx.x = 0; blockIdx.x < items; ++blockIdx.x) {name}({arguments});
}}
"""
KERNEL = re.compile(r'extern "C" __global__ void (\w+)\(([^)]*)\)')


class HostCard:
    """Has the functions of cuda.Card, and no card."""

    name, driver, architecture = "this processor", "-", "-"

    def __init__(self, folder):
        self.folder, self.free = folder, 1e9

    def functions(self, text, names):
        text = HOST + text.replace('extern "C" __device__', "static")
        for name, parameters in KERNEL.findall(text):
            arguments = ", ".join(re.findall(r"(\w+)(?:,|$)", parameters))
            text += LOOP.format(name=name, parameters=parameters, arguments=arguments)
        number = len(list(self.folder.glob("*.so")))  # ctypes loads a path once
        source, library = self.folder / "kernels.cpp", self.folder / f"kernels{number}.so"
        source.write_text(text)
        output_of("c++", "-O2", "-shared", "-fPIC", "-w", source, "-o", library)
        loaded = ctypes.CDLL(library)
        return {name: loaded[f"run_{name}"] for name in names}

    def free_bytes(self):
        return self.free

    def zeros(self, size):
        return ctypes.create_string_buffer(max(size, 16))

    def release(self, array):
        pass

    def write(self, array, data):
        array[: len(data)] = data

    def read(self, array, size):
        return array.raw[:size]

    def launch(self, function, items, *arguments):
        function(ctypes.c_uint(items), *arguments)

    def recorded(self, queue):
        return queue

    def seconds(self, queue):
        queue()
        return 1.0
