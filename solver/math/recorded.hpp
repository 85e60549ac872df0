#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "math/exponential.hpp"

namespace sandglass {

/// What a step of a tape computes, a, b and c being its operands.
enum class Operation {
  input,
  constant,
  add,
  subtract,
  multiply,
  divide,
  negate,
  less,    ///< a mask: a < b
  select,  ///< b where the mask a is true, else c
  max,
  min,
  abs,
  sqrt,
  inverse_cube_root,
  expm1,
  log1p,
  // The parts of the last three that work on bits.
  cube_root_guess,
  power_of_two,
  binary_exponent
};

/// A constant in both precisions, each computed in its own.
struct Constant {
  double in_double = 0.0;
  float in_float = 0.0F;

  template <std::floating_point Real>
  Real as() const {
    if constexpr (std::is_same_v<Real, float>) return in_float;
    return static_cast<Real>(in_double);
  }
  bool is(double number) const { return in_double == number && in_float == static_cast<float>(number); }
  bool operator==(const Constant&) const = default;
};

/// An operation of a straight-line program, on the results of earlier steps.
struct Step {
  Operation operation = Operation::constant;
  std::array<int, 3> of{-1, -1, -1};  ///< numbers of steps; -1: none. The number of an input
  Constant value = {};                ///< of a constant
};

/// The result of an operation on numbers; a mask is 0 or 1.
template <std::floating_point Real>
Real result_of(Operation operation, Real a, Real b, Real c) {
  switch (operation) {
    case Operation::add:
      return a + b;
    case Operation::subtract:
      return a - b;
    case Operation::multiply:
      return a * b;
    case Operation::divide:
      return a / b;
    case Operation::negate:
      return -a;
    case Operation::less:
      return a < b ? Real(1) : Real(0);
    case Operation::select:
      return a == Real(0) ? c : b;
    case Operation::max:
      return max(a, b);
    case Operation::min:
      return min(a, b);
    case Operation::abs:
      return abs(a);
    case Operation::sqrt:
      return sqrt(a);
    case Operation::inverse_cube_root:
      return inverse_cube_root(a);
    case Operation::expm1:
      return expm1(a);
    case Operation::log1p:
      return log1p(a);
    case Operation::power_of_two:
      return power_of_two(a);
    case Operation::binary_exponent:
      return binary_exponent(a);
    case Operation::cube_root_guess:
    case Operation::input:
    case Operation::constant:
      break;
  }
  return a;
}

/// A straight-line program: steps in order, and which of them are its results.
struct Program {
  std::vector<Step> steps;
  std::vector<int> results;
};

class Tape;

/// A number that records its operations on a tape: run a kernel on it, and the tape is the kernel's program
/// (the tape of automatic differentiation, here for any use). Operations on constants are computed in both
/// precisions; results are right up to the sign of zeros, for finite numbers. Kernels have no branches, so
/// that the program is the kernel for all values of its inputs.
class Recorded {
 public:
  Recorded() : Recorded(0.0) {}
  explicit(false) Recorded(double constant) : constant_{constant, static_cast<float>(constant)} {}

  /// The value of a constant.
  double value() const { return constant_.in_double; }

  friend Recorded operator+(const Recorded& a, const Recorded& b) { return record(Operation::add, a, b); }
  friend Recorded operator-(const Recorded& a, const Recorded& b) {
    return record(Operation::subtract, a, b);
  }
  friend Recorded operator-(const Recorded& a) { return record(Operation::negate, a); }
  friend Recorded operator*(const Recorded& a, const Recorded& b) {
    return record(Operation::multiply, a, b);
  }
  friend Recorded operator/(const Recorded& a, const Recorded& b) { return record(Operation::divide, a, b); }
  friend Recorded operator<(const Recorded& a, const Recorded& b) { return record(Operation::less, a, b); }
  friend Recorded operator>(const Recorded& a, const Recorded& b) { return record(Operation::less, b, a); }
  friend Recorded select(const Recorded& mask, const Recorded& a, const Recorded& b) {
    return record(Operation::select, mask, a, b);
  }
  friend Recorded max(const Recorded& a, const Recorded& b) { return record(Operation::max, a, b); }
  friend Recorded min(const Recorded& a, const Recorded& b) { return record(Operation::min, a, b); }
  friend Recorded abs(const Recorded& a) { return record(Operation::abs, a); }
  friend Recorded sqrt(const Recorded& a) { return record(Operation::sqrt, a); }
  friend Recorded inverse_cube_root(const Recorded& a) { return record(Operation::inverse_cube_root, a); }
  friend Recorded expm1(const Recorded& a) { return record(Operation::expm1, a); }
  friend Recorded log1p(const Recorded& a) { return record(Operation::log1p, a); }
  friend Recorded cube_root_guess(const Recorded& a) { return record(Operation::cube_root_guess, a); }
  friend Recorded power_of_two(const Recorded& a) { return record(Operation::power_of_two, a); }
  friend Recorded binary_exponent(const Recorded& a) { return record(Operation::binary_exponent, a); }

 private:
  friend class Tape;

  Recorded(Tape& tape, int step) : tape_(&tape), step_(step) {}

  bool is(double number) const { return tape_ == nullptr && constant_.is(number); }
  static Recorded record(Operation operation, const Recorded& a, const Recorded& b = {},
                         const Recorded& c = {});

  Tape* tape_ = nullptr;  ///< null: a constant
  int step_ = -1;
  Constant constant_;
};

/// The operations that numbers record, each once: equal ones share their result.
class Tape {
 public:
  /// The next input.
  Recorded input() { return {*this, step_of({Operation::input, {inputs_++, -1, -1}})}; }

  /// The program with these results: the steps on which they depend, in the order of recording.
  Program program(const std::vector<Recorded>& results) {
    std::vector<int> numbers;
    for (const Recorded& result : results) numbers.push_back(number_of(result));
    std::vector<bool> used(steps_.size(), false);
    for (const int n : numbers) used[static_cast<std::size_t>(n)] = true;
    for (std::size_t n = steps_.size(); n-- > 0;) {
      if (!used[n] || steps_[n].operation == Operation::input) continue;
      for (const int operand : steps_[n].of) {
        if (operand >= 0) used[static_cast<std::size_t>(operand)] = true;
      }
    }
    Program program;
    std::vector<int> number(steps_.size(), -1);
    for (std::size_t n = 0; n < steps_.size(); ++n) {
      if (!used[n]) continue;
      number[n] = static_cast<int>(program.steps.size());
      Step step = steps_[n];
      for (int& operand : step.of) {
        if (operand >= 0 && step.operation != Operation::input) {
          operand = number[static_cast<std::size_t>(operand)];
        }
      }
      program.steps.push_back(step);
    }
    for (const int n : numbers) program.results.push_back(number[static_cast<std::size_t>(n)]);
    return program;
  }

 private:
  friend class Recorded;

  /// The number of the step with this result.
  int number_of(const Recorded& x) {
    return x.tape_ != nullptr ? x.step_ : step_of({Operation::constant, {-1, -1, -1}, x.constant_});
  }

  int step_of(const Step& step) {
    const Key key{static_cast<std::int64_t>(step.operation),
                  step.of[0],
                  step.of[1],
                  step.of[2],
                  std::bit_cast<std::int64_t>(step.value.in_double),
                  std::bit_cast<std::int32_t>(step.value.in_float)};
    const auto [found, is_new] = known_.try_emplace(key, static_cast<int>(steps_.size()));
    if (is_new) steps_.push_back(step);
    return found->second;
  }

  /// The operand of a negation; none if the number is not one.
  bool negates(const Recorded& x, Recorded& operand) {
    if (x.tape_ == nullptr || steps_[static_cast<std::size_t>(x.step_)].operation != Operation::negate) {
      return false;
    }
    operand = {*this, steps_[static_cast<std::size_t>(x.step_)].of[0]};
    return true;
  }

  using Key = std::array<std::int64_t, 6>;
  std::vector<Step> steps_;
  std::map<Key, int> known_;
  int inputs_ = 0;
};

/// Not inlined: kernels are compiled with all their calls inlined (`flatten`), which would multiply this.
[[gnu::noinline]] inline Recorded Recorded::record(Operation operation, const Recorded& a, const Recorded& b,
                                                   const Recorded& c) {
  Tape* const tape = a.tape_ != nullptr ? a.tape_ : b.tape_ != nullptr ? b.tape_ : c.tape_;
  if (tape == nullptr) {
    Recorded folded;
    const Constant &x = a.constant_, &y = b.constant_, &z = c.constant_;
    folded.constant_ = {result_of(operation, x.in_double, y.in_double, z.in_double),
                        result_of(operation, x.in_float, y.in_float, z.in_float)};
    return folded;
  }
  Recorded operand;
  switch (operation) {
    case Operation::add:
      if (a.is(0.0)) return b;
      if (b.is(0.0)) return a;
      if (tape->negates(b, operand)) return a - operand;
      if (tape->negates(a, operand)) return b - operand;
      break;
    case Operation::subtract:
      if (a.is(0.0)) return -b;
      if (b.is(0.0)) return a;
      if (tape->negates(b, operand)) return a + operand;
      break;
    case Operation::multiply:
      if (a.is(0.0) || b.is(0.0)) return 0.0;
      if (a.is(1.0)) return b;
      if (b.is(1.0)) return a;
      if (a.is(-1.0)) return -b;
      if (b.is(-1.0)) return -a;
      break;
    case Operation::divide:
      if (a.is(0.0)) return 0.0;
      if (b.is(1.0)) return a;
      break;
    case Operation::negate:
      if (tape->negates(a, operand)) return operand;
      break;
    default:
      break;
  }
  Step step{operation, {tape->number_of(a), -1, -1}};
  const bool is_binary = operation >= Operation::add && operation <= Operation::divide;
  if (is_binary || operation == Operation::less || operation == Operation::max ||
      operation == Operation::min || operation == Operation::select) {
    step.of[1] = tape->number_of(b);
  }
  if (operation == Operation::select) step.of[2] = tape->number_of(c);
  const bool commutes = operation == Operation::add || operation == Operation::multiply;
  if (commutes && step.of[0] > step.of[1]) std::swap(step.of[0], step.of[1]);
  return {*tape, tape->step_of(step)};
}

}  // namespace sandglass
