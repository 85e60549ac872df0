#pragma once

#include "math/exponential.hpp"

namespace sandglass {

/// Operations on values that depend on the input of a kernel.
struct Operations {
  long add = 0;      ///< additions and subtractions
  long mul = 0;      ///< multiplications
  long div = 0;      ///< divisions
  long special = 0;  ///< roots and transcendental functions, one each
  long total() const { return add + mul + div + special; }

  friend Operations operator+(const Operations& a, const Operations& b) {
    return {a.add + b.add, a.mul + b.mul, a.div + b.div, a.special + b.special};
  }
  friend Operations operator-(const Operations& a, const Operations& b) {
    return {a.add - b.add, a.mul - b.mul, a.div - b.div, a.special - b.special};
  }
};

/// A number that counts its operations: run a kernel on it and read the tally. Constants have no tally, so
/// operations between constants, which a compiler folds, cost nothing; changes of sign are free.
class Counted {
 public:
  Counted() = default;
  explicit(false) Counted(double constant) : value_(constant) {}
  Counted(double value, Operations& tally) : value_(value), tally_(&tally) {}

  double value() const { return value_; }

  friend Counted operator+(Counted a, Counted b) {
    return result(a.value_ + b.value_, a, b, &Operations::add);
  }
  friend Counted operator-(Counted a, Counted b) {
    return result(a.value_ - b.value_, a, b, &Operations::add);
  }
  friend Counted operator-(Counted a) {
    a.value_ = -a.value_;
    return a;
  }
  friend Counted operator*(Counted a, Counted b) {
    return result(a.value_ * b.value_, a, b, &Operations::mul);
  }
  friend Counted operator/(Counted a, Counted b) {
    return result(a.value_ / b.value_, a, b, &Operations::div);
  }
  friend bool operator<(Counted a, Counted b) { return a.value_ < b.value_; }
  friend bool operator>(Counted a, Counted b) { return a.value_ > b.value_; }
  friend Counted select(bool mask, Counted a, Counted b) { return mask ? a : b; }
  friend Counted max(Counted a, Counted b) { return a < b ? b : a; }
  friend Counted min(Counted a, Counted b) { return b < a ? b : a; }
  friend Counted abs(Counted a) { return a.value_ < 0.0 ? -a : a; }
  friend Counted sqrt(Counted a) { return special(std::sqrt(a.value_), a); }
  friend Counted log1p(Counted a) { return special(std::log1p(a.value_), a); }
  friend Counted expm1(Counted a) { return special(std::expm1(a.value_), a); }
  friend Counted inverse_cube_root(Counted a) { return special(sandglass::inverse_cube_root(a.value_), a); }

 private:
  static Counted result(double value, const Counted& a, const Counted& b, long Operations::*kind) {
    Counted r(value);
    r.tally_ = a.tally_ != nullptr ? a.tally_ : b.tally_;
    if (r.tally_ != nullptr) ++(r.tally_->*kind);
    return r;
  }
  static Counted special(double value, const Counted& a) {
    Counted r(value);
    r.tally_ = a.tally_;
    if (r.tally_ != nullptr) ++r.tally_->special;
    return r;
  }

  double value_ = 0.0;
  Operations* tally_ = nullptr;
};

}  // namespace sandglass
