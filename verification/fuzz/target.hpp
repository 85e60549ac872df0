#pragma once

#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "base/error.hpp"
#include "fuzz/readers.hpp"

namespace sandglass::verification {

/// Passes one input to a reader, which may throw only InputError. The bytes go through a file in memory, as
/// users' bytes go through a file.
template <class Read>
int feed(const Read& read, const std::uint8_t* data, std::size_t size) {
  static const std::filesystem::path scratch = "/dev/shm/sandglass-fuzz." + std::to_string(getpid());
  try {
    read({reinterpret_cast<const std::byte*>(data), size}, scratch);
  } catch (const InputError&) {
  }
  std::error_code ignored;
  std::filesystem::remove(scratch, ignored);
  return 0;
}

}  // namespace sandglass::verification
