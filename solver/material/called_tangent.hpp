#pragma once

#include <cstddef>

#include "material/called_law.hpp"
#include "material/memory.hpp"

namespace sandglass {

/// The tangent of a law at the points of an element, behind a function call, so that bounds of stiffnesses
/// are compiled once for elastic and viscoelastic laws.
template <class T>
class CalledTangent : public VolumeOfElastic<CalledTangent<T>> {
 public:
  /// Refers to both: an elastic law and the law for the same material with its axes and memories.
  template <class Law>
  CalledTangent(const CalledLaw& elastic, const Law& law)
      : elastic_(&elastic), law_(&law), bound_(bound_of<Law>) {}

  const CalledLaw& elastic() const { return *elastic_; }

  /// The law at integration point q.
  CalledTangent at_point(std::size_t q) const {
    CalledTangent at = *this;
    at.point_ = q;
    return at;
  }

  TangentBound<T> tangent_bound(const Tensor<T>& H, const T& J_minus_one, const T& p, const T& bulk) const {
    return bound_(law_, point_, H, J_minus_one, p, bulk);
  }

 private:
  template <class Law>
  static TangentBound<T> bound_of(const void* law, std::size_t q, const Tensor<T>& H, const T& J_minus_one,
                                  const T& p, const T& bulk) {
    return sandglass::at_point(*static_cast<const Law*>(law), q).tangent_bound(H, J_minus_one, p, bulk);
  }

  const CalledLaw* elastic_;
  const void* law_;
  TangentBound<T> (*bound_)(const void*, std::size_t, const Tensor<T>&, const T&, const T&, const T&);
  std::size_t point_ = 0;
};

}  // namespace sandglass
