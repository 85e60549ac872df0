#include "base/memory.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "base/error.hpp"

namespace sandglass {

namespace {

std::size_t free_on_machine() {
  std::ifstream info("/proc/meminfo");
  for (std::string line; std::getline(info, line);) {
    if (line.starts_with("MemAvailable:")) return std::stoull(line.substr(13)) * 1024;
  }
  return static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) /
         2;
}

double bytes_of_an_element(MeshUse use) {
  switch (use) {
    case MeshUse::storing:
      return 350.0;
    case MeshUse::motion:
      return 850.0;
    case MeshUse::equilibrium:
      break;
  }
  return 3500.0;
}

}  // namespace

std::size_t available_memory() {
  rlimit limit{};
  const bool limited = getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
  return limited ? std::min<std::size_t>(free_on_machine(), limit.rlim_cur) : free_on_machine();
}

double memory_needed(double elements, MeshUse use) {
  return elements * bytes_of_an_element(use);
}

void require_memory(double elements, MeshUse use) {
  constexpr double giga = 1e9;
  const double needed = memory_needed(elements, use), available = static_cast<double>(available_memory());
  if (needed <= available) return;
  throw ComputationError(
      fmt::format("not enough memory: {:.3g} elements need about {:.1f} GB, and {:.1f} GB are free on this "
                  "machine or allowed by the shell; remedy: at most about {:.2g} elements",
                  elements, needed / giga, available / giga, available / memory_needed(1.0, use)));
}

}  // namespace sandglass
