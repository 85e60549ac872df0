#include "app/machine.hpp"

#include <fstream>

#include "app/build_info.hpp"
#include "base/error.hpp"
#include "io/file_hash.hpp"

namespace sandglass {

namespace {

/// The processor's name as the system tells it; "unknown" where it does not.
std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.starts_with("model name")) return line.substr(std::min(line.find(": ") + 2, line.size()));
  }
  return "unknown";
}

}  // namespace

Provenance build_provenance() {
  return {{"version", std::string(build_info::version)},
          {"revision", std::string(build_info::revision)},
          {"compiler", std::string(build_info::compiler)},
          {"build_flags", std::string(build_info::flags)},
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
          {"build_flags", std::string(build_info::flags)},
          {"program_hash", program}};
}

}  // namespace sandglass
