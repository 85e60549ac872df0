#pragma once

#include "material/called_law.hpp"
#include "material/small_strain.hpp"

/// The definitions of `CalledLaw`, for the source file of each number type; see CMakeLists.txt.
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
[[gnu::flatten, gnu::noinline]] void weighted_kirchhoff(const Law& law, const PointLoad<T>* at,
                                                        const Tensor<T>* H, Tensor<T>* V_tau) {
  *V_tau = law.weighted_kirchhoff(at->V, *H, at->change, at->p);
}

}  // namespace detail

/// Calls visit(law) after a chain of comparisons; unlike std::visit it needs no second call.
template <std::size_t alternative, class Visit>
decltype(auto) CalledLaw::visit(const Visit& visit) const {
  if constexpr (alternative + 1 < std::variant_size_v<VariantOf<ElasticLaws>>) {
    if (law_.index() != alternative) return this->visit<alternative + 1>(visit);
  }
  return visit(*std::get_if<alternative>(&law_));
}

template <class T>
T CalledLaw::isochoric_energy(const Tensor<T>& H) const {
  return visit<0>([&](const auto& law) { return law.isochoric_energy(H); });
}

template <class T>
void CalledLaw::weighted_piola(std::size_t count, const PointLoad<T>* at, const Tensor<T>* H,
                               Tensor<T>* VP) const {
  visit<0>([=](const auto& law) { detail::weighted_piola(law, count, at, H, VP); });
}

template <class T>
void CalledLaw::weighted_kirchhoff(const PointLoad<T>* at, const Tensor<T>* H, Tensor<T>* V_tau) const {
  visit<0>([=](const auto& law) { detail::weighted_kirchhoff(law, at, H, V_tau); });
}

template <class T>
TangentBound<T> CalledLaw::tangent_bound(const Tensor<T>& H, const T& J_minus_one, const T& p,
                                         const T& bulk) const {
  return visit<0>([&](const auto& law) { return sandglass::tangent_bound(law, H, J_minus_one, p, bulk); });
}

template <class T>
TangentBound<T> CalledLaw::viscoelastic_tangent_bound(const Tensor<T>& H, const T& J_minus_one, const T& p,
                                                      const T& bulk) const {
  return visit<0>(
      [&](const auto& law) { return sandglass::viscoelastic_tangent_bound(law, H, J_minus_one, p, bulk); });
}

template <class T>
Tensor<T> CalledLaw::small_strain_stress(const Tensor<T>& strain) const {
  return visit<0>([&](const auto& law) { return sandglass::small_strain_stress(law, strain); });
}

}  // namespace sandglass
