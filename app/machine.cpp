#include "app/machine.hpp"

#include <fmt/format.h>

#include <fstream>

#include "app/build_info.hpp"
#include "base/error.hpp"
#include "io/file_hash.hpp"
#include "math/pack.hpp"

namespace sandglass {

namespace {

/// The processor's name according to the system, or "unknown".
std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.starts_with("model name")) return line.substr(std::min(line.find(": ") + 2, line.size()));
  }
  return "unknown";
}

/// The compiler's flags and the width of packs. "-march=native" alone is ambiguous, as its meaning depends on
/// the machine; memory, bits and speed depend on the width.
std::string build_flags() {
  return fmt::format("{}; packs of {} doubles", build_info::flags, native_width<double>);
}

}  // namespace

Provenance build_provenance() {
  return {{"version", std::string(build_info::version)},
          {"revision", std::string(build_info::revision)},
          {"compiler", std::string(build_info::compiler)},
          {"build_flags", build_flags()},
          {"processor", processor()}};
}

Identity program_identity() {
  std::string program = "unknown";
  try {
    program = hash_of_file("/proc/self/exe");
  } catch (const InputError&) {  // a system without /proc
  }
  return {{"revision", std::string(build_info::revision)},
          {"compiler", std::string(build_info::compiler)},
          {"build_flags", build_flags()},
          {"program_hash", program}};
}

}  // namespace sandglass
