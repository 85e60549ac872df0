#pragma once

#include "material/called_law.hpp"
#include "material/small_strain.hpp"

/// The definitions of `CalledLawOf`, for the source file of each number type; see CMakeLists.txt.
namespace sandglass {

namespace detail {

// Each law has its own function: in a common one the compiler would keep tensors in memory.

template <class Law, class T>
[[gnu::flatten, gnu::noinline]] void weighted_piola(const Law& shared, std::size_t count,
                                                    const PointLoad<T>* at, const Tensor<T>* H,
                                                    Tensor<T>* VP) {
  const Law law = shared;  // a copy that no store can alias, so that moduli are computed once
  for (std::size_t q = 0; q < count; ++q) {
    VP[q] = law.weighted_piola(at[q].V, H[q], at[q].change, at[q].p);
  }
}

template <class Law, class T>
[[gnu::flatten, gnu::noinline]] void weighted_piola(const Law& shared, std::size_t count,
                                                    const PointLoad<T>* at, const Tensor<T>* H, Tensor<T>* VP,
                                                    const MaterialAxes<T>& axes) {
  const Law law = shared;
  for (std::size_t q = 0; q < count; ++q) {
    VP[q] = in_space(axes, law.weighted_piola(at[q].V, in_material(axes, H[q]), at[q].change, at[q].p));
  }
}

template <class Law, class T>
[[gnu::flatten, gnu::noinline]] void weighted_kirchhoff(const Law& law, const PointLoad<T>* at,
                                                        const Tensor<T>* H, Tensor<T>* V_tau) {
  *V_tau = law.weighted_kirchhoff(at->V, *H, at->change, at->p);
}

/// A displacement gradient or a strain, transformed to the axes of a law.
template <class Law, class T>
Tensor<T> in_axes_of(const Law& /*law*/, const Tensor<T>& H, const MaterialAxes<T>* axes) {
  if constexpr (!is_isotropic<Law>) {
    if (axes != nullptr) return in_material(*axes, H);
  }
  return H;
}

/// A stress in the axes of a law, transformed to space.
template <class Law, class T>
Tensor<T> from_axes_of(const Law& /*law*/, const Tensor<T>& stress, const MaterialAxes<T>* axes) {
  if constexpr (!is_isotropic<Law>) {
    if (axes != nullptr) return in_space(*axes, stress);
  }
  return stress;
}

}  // namespace detail

/// Calls visit(law) after a chain of comparisons; unlike std::visit it needs no second call.
template <class Value>
template <std::size_t alternative, class Visit>
decltype(auto) CalledLawOf<Value>::visit(const Visit& visit) const {
  if constexpr (alternative + 1 < std::variant_size_v<VariantOf<ElasticLawsOf<Value>>>) {
    if (law_.index() != alternative) return this->visit<alternative + 1>(visit);
  }
  return visit(*std::get_if<alternative>(&law_));
}

template <class Value>
template <class T>
typename CalledLawOf<Value>::template Volume<T> CalledLawOf<Value>::called_volume(const T& x) const {
  const T K(bulk_modulus_);
  return std::visit(
      [&]<class Part>(const Part&) {
        return Volume<T>{K * Part::energy(x), K * Part::slope(x), K * Part::curvature(x)};
      },
      volume_);
}

template <class Value>
template <class T>
T CalledLawOf<Value>::isochoric_energy(const Tensor<T>& H, const MaterialAxes<T>* axes) const {
  return visit<0>([&](const auto& law) { return law.isochoric_energy(detail::in_axes_of(law, H, axes)); });
}

template <class Value>
template <class T>
void CalledLawOf<Value>::weighted_piola(std::size_t count, const PointLoad<T>* at, const Tensor<T>* H,
                                        Tensor<T>* VP, const MaterialAxes<T>* axes) const {
  visit<0>([=]<class Law>(const Law& law) {
    if constexpr (!is_isotropic<Law>) {
      if (axes != nullptr) return detail::weighted_piola(law, count, at, H, VP, *axes);
    }
    detail::weighted_piola(law, count, at, H, VP);
  });
}

template <class Value>
template <class T>
void CalledLawOf<Value>::weighted_kirchhoff(const PointLoad<T>* at, const Tensor<T>* H, Tensor<T>* V_tau,
                                            const MaterialAxes<T>* axes) const {
  visit<0>([=](const auto& law) {
    const Tensor<T> own = detail::in_axes_of(law, *H, axes);
    detail::weighted_kirchhoff(law, at, &own, V_tau);
    *V_tau = detail::from_axes_of(law, *V_tau, axes);
  });
}

template <class Value>
template <class T>
TangentBound<T> CalledLawOf<Value>::tangent_bound(const Tensor<T>& H, const T& J_minus_one, const T& p,
                                                  const T& bulk, const MaterialAxes<T>* axes) const {
  return visit<0>([&](const auto& law) {
    return sandglass::tangent_bound(law, detail::in_axes_of(law, H, axes), J_minus_one, p, bulk);
  });
}

template <class Value>
template <class T>
TangentBound<T> CalledLawOf<Value>::viscoelastic_tangent_bound(const Tensor<T>& H, const T& J_minus_one,
                                                               const T& p, const T& bulk,
                                                               const MaterialAxes<T>* axes) const {
  return visit<0>([&](const auto& law) {
    return sandglass::viscoelastic_tangent_bound(law, detail::in_axes_of(law, H, axes), J_minus_one, p, bulk);
  });
}

template <class Value>
template <class T>
Tensor<T> CalledLawOf<Value>::small_strain_stress(const Tensor<T>& strain,
                                                  const MaterialAxes<T>* axes) const {
  return visit<0>([&](const auto& law) {
    return detail::from_axes_of(
        law, sandglass::small_strain_stress(law, detail::in_axes_of(law, strain, axes)), axes);
  });
}

}  // namespace sandglass
