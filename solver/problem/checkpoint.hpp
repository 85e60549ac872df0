#pragma once

#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstring>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/error.hpp"
#include "math/rows.hpp"

namespace sandglass {

/// The state of a stepper at a point from which it can be resumed with the same bits: named arrays, whose
/// meaning only the stepper knows. A double represents every float, and every integer up to 2^53, exactly.
struct Checkpoint {
  std::map<std::string, std::vector<double>> arrays;
};

/// Writes the state of a stepper into a checkpoint. A stepper lists its state once, in a template
/// `keep(archive)` that calls archive(name, value), with a writer or a reader, so that the two cannot differ.
/// Values are numbers, vectors of numbers, and rows.
class CheckpointWriter {
 public:
  explicit CheckpointWriter(Checkpoint& checkpoint) : arrays_(checkpoint.arrays) {}

  template <class Number>
  requires std::is_arithmetic_v<Number>
  void operator()(const std::string& name, Number& value) { arrays_[name] = {static_cast<double>(value)}; }

  template <std::floating_point Real>
  void operator()(const std::string& name, std::vector<Real>& values) {
    arrays_[name].assign(values.begin(), values.end());
  }

  template <class Real>
  void operator()(const std::string& name, Rows<Real>& rows) {
    const Real* numbers = numbers_of(rows);
    arrays_[name].assign(numbers, numbers + 4 * rows.size());
  }

 private:
  std::map<std::string, std::vector<double>>& arrays_;
};

/// Reads the state from a checkpoint into values that already have their sizes. Throws InputError if an array
/// is missing or has another size, or if the value of an integer is not one.
class CheckpointReader {
 public:
  explicit CheckpointReader(const Checkpoint& checkpoint) : arrays_(checkpoint.arrays) {}

  template <class Number>
  requires std::is_arithmetic_v<Number>
  void operator()(const std::string& name, Number& value) const {
    const double number = find(name, 1).front();
    if constexpr (std::is_integral_v<Number>) {
      constexpr double most = 2147483647.0;
      if (!(std::abs(number) <= most) || number != std::floor(number)) fail(name, "must hold an integer");
    }
    value = static_cast<Number>(number);
  }

  template <std::floating_point Real>
  void operator()(const std::string& name, std::vector<Real>& values) const {
    take(find(name, values.size()), values.data());
  }

  template <class Real>
  void operator()(const std::string& name, Rows<Real>& rows) const {
    take(find(name, 4 * rows.size()), numbers_of(rows));
  }

 private:
  [[noreturn]] static void fail(const std::string& name, const std::string& rule) {
    throw InputError("checkpoint: '" + name + "' " + rule + "; it belongs to another program or run");
  }

  const std::vector<double>& find(const std::string& name, std::size_t size) const {
    const auto found = arrays_.find(name);
    if (found == arrays_.end()) fail(name, "is missing");
    if (found->second.size() != size) {
      fail(name,
           "has " + std::to_string(found->second.size()) + " values and must have " + std::to_string(size));
    }
    return found->second;
  }

  template <class Real>
  static void take(const std::vector<double>& from, Real* to) {
    for (const double number : from) *to++ = static_cast<Real>(number);
  }

  const std::map<std::string, std::vector<double>>& arrays_;
};

/// Copies the state of a stepper to bytes, or back from const bytes, within a process: like the two above,
/// but much faster, and without allocating once the bytes exist.
template <class Bytes>
requires std::is_same_v<std::remove_const_t<Bytes>, std::vector<std::byte>>
class StateCopy {
 public:
  explicit StateCopy(Bytes& bytes) : bytes_(bytes) {}

  template <class Number>
  requires std::is_arithmetic_v<Number>
  void operator()(std::string_view /*name*/, Number& value) { copy(&value, sizeof value); }

  template <std::floating_point Real>
  void operator()(std::string_view /*name*/, std::vector<Real>& values) {
    copy(values.data(), values.size() * sizeof(Real));
  }

  template <class Real>
  void operator()(std::string_view /*name*/, Rows<Real>& rows) {
    copy(numbers_of(rows), 4 * rows.size() * sizeof(Real));
  }

 private:
  void copy(void* values, std::size_t size) {
    if (size == 0) return;
    if constexpr (std::is_const_v<Bytes>) {
      std::memcpy(values, bytes_.data() + at_, size);
    } else {
      if (bytes_.size() < at_ + size) bytes_.resize(at_ + size);
      std::memcpy(bytes_.data() + at_, values, size);
    }
    at_ += size;
  }

  Bytes& bytes_;
  std::size_t at_ = 0;
};

}  // namespace sandglass
