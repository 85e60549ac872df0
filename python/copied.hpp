#pragma once

#include <pybind11/numpy.h>

#include <vector>

#include "mesh/mesh.hpp"

/// Copies of data of the library as arrays of Python.
namespace sandglass {

/// An array of its own with the numbers of `rows`, in a shape.
template <class Number, class Rows>
pybind11::array_t<Number> copied(const Rows& rows, std::vector<pybind11::ssize_t> shape) {
  return pybind11::array_t<Number>(std::move(shape), reinterpret_cast<const Number*>(rows.data()));
}

template <class Rows>
pybind11::ssize_t count(const Rows& rows) {
  return static_cast<pybind11::ssize_t>(rows.size());
}

inline pybind11::array field(const NodalField& u) {
  return copied<double>(u, {count(u), 3});
}

inline pybind11::array numbers(const std::vector<double>& values) {
  return copied<double>(values, {count(values)});
}

}  // namespace sandglass
