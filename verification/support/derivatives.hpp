#pragma once

#include <array>
#include <bit>
#include <type_traits>

#include "math/dual.hpp"
#include "math/matrix.hpp"

/// Exact derivatives of kernels, by running them on dual numbers.
namespace sandglass::verification {

using D = Dual<double>;

template <int R, int C>
Matrix<D, R, C> constant(const Matrix<double, R, C>& a) {
  Matrix<D, R, C> result{};
  for (std::size_t n = 0; n < a.entries.size(); ++n) result.entries[n] = D(a.entries[n]);
  return result;
}

/// a + epsilon b.
template <int R, int C>
Matrix<D, R, C> along(const Matrix<double, R, C>& a, const Matrix<double, R, C>& b) {
  Matrix<D, R, C> result{};
  for (std::size_t n = 0; n < a.entries.size(); ++n) result.entries[n] = D(a.entries[n], b.entries[n]);
  return result;
}

template <int R, int C>
Matrix<double, R, C> slope(const Matrix<D, R, C>& a) {
  Matrix<double, R, C> result{};
  for (std::size_t n = 0; n < a.entries.size(); ++n) result.entries[n] = a.entries[n].slope;
  return result;
}

/// The unit vector of entry `n`.
template <int R, int C>
Matrix<double, R, C> unit(std::size_t n) {
  Matrix<double, R, C> e{};
  e.entries[n] = 1.0;
  return e;
}

/// The gradient of a scalar function of a matrix.
template <int R, int C, class Function>
Matrix<double, R, C> gradient(const Matrix<double, R, C>& at, const Function& function) {
  Matrix<double, R, C> result{};
  for (std::size_t n = 0; n < at.entries.size(); ++n) {
    result.entries[n] = function(along(at, unit<R, C>(n))).slope;
  }
  return result;
}

namespace detail {

/// Constants of one part of an element, converted to another number type. Being plain aggregates of numbers,
/// they are converted without naming their members, which includes future parts.
template <class To, class From>
To with_other_numbers(const From& from) {
  if constexpr (std::is_empty_v<From>) {
    return {};
  } else {
    constexpr std::size_t count = sizeof(From) / sizeof(double);
    static_assert(sizeof(To) == count * sizeof(D), "an element's constants must all be of its number type");
    const auto numbers = std::bit_cast<std::array<double, count>>(from);
    std::array<D, count> duals{};
    for (std::size_t n = 0; n < count; ++n) duals[n] = D(numbers[n]);
    return std::bit_cast<To>(duals);
  }
}

}  // namespace detail

/// The constants of an element for kernels that run on dual numbers.
template <class Formulation>
typename Formulation::template Element<D> dual_element(
    const typename Formulation::template Element<double>& element) {
  using To = typename Formulation::template Element<D>;
  return {detail::with_other_numbers<decltype(To::body)>(element.body),
          detail::with_other_numbers<decltype(To::hourglass)>(element.hourglass)};
}

}  // namespace sandglass::verification
