#include "fuzz/target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return sandglass::verification::feed(sandglass::verification::read_as_checkpoint_file, data, size);
}
