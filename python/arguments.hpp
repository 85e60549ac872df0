#pragma once

#include <pybind11/pybind11.h>

#include <optional>
#include <string>
#include <vector>

namespace sandglass {

/// The arguments of a function of the package, by name. Each getter throws a TypeError that names argument,
/// rule and type for a value of another type, and for one that is not given.
class Arguments {
 public:
  explicit Arguments(pybind11::dict given) : given_(std::move(given)) {}

  std::string text(const char* name) const;
  std::string path(const char* name) const;
  double number(const char* name) const;
  int integer(const char* name) const;
  bool flag(const char* name) const;
  std::vector<std::string> texts(const char* name) const;
  std::vector<int> integers(const char* name) const;

  /// None if the argument is None, else `get(name)` of these arguments.
  template <class Value>
  std::optional<Value> optional(const char* name, Value (Arguments::*get)(const char*) const) const {
    if (value(name).is_none()) return std::nullopt;
    return (this->*get)(name);
  }

  pybind11::object value(const char* name) const;

 private:
  pybind11::dict given_;
};

}  // namespace sandglass
