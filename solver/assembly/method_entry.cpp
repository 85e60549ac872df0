#include "assembly/method_entry.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "base/names.hpp"
#include "element/methods.hpp"

namespace sandglass {

const std::vector<MethodEntry>& methods() {
  static const std::vector<MethodEntry> entries = []<class... Method>(TypeList<Method...>) {
    return std::vector<MethodEntry>{method_entry<Method>()...};
  }(Methods{});
  return entries;
}

std::vector<std::string> method_names() {
  return names_of(Methods{});
}

const MethodEntry& method_named(std::string_view name, std::string_view key) {
  const auto found = std::find_if(methods().begin(), methods().end(),
                                  [&](const MethodEntry& entry) { return entry.name == name; });
  if (found == methods().end()) {
    throw InputError(fmt::format("{}: '{}' is not known; {}; `sandglass methods` lists all", key, name,
                                 suggestion(name, method_names())));
  }
  return *found;
}

}  // namespace sandglass
