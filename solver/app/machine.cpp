#include "app/machine.hpp"

#include <fstream>

#include "app/build_info.hpp"

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

}  // namespace sandglass
