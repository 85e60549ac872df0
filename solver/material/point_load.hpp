#pragma once

#include <cstddef>

#include "math/strain.hpp"

namespace sandglass {

/// The arguments of a law at an integration point in addition to the displacement gradient.
template <class T>
struct PointLoad {
  T V;                     ///< reference volume that the stress acts on, m^3
  VolumeChange<T> change;  ///< of the displacement gradient
  T p;                     ///< pressure, Pa, tension positive
};

/// Whether a law takes all points of an element in one call.
template <class Law, class T>
concept TakesAllPoints = requires(const Law& law, const PointLoad<T>* at, const Tensor<T>* H, Tensor<T>* VP) {
  law.weighted_piola(std::size_t(1), at, H, VP);
};

}  // namespace sandglass
