#pragma once

#include <cmath>

#include "material/first_invariant.hpp"

/// Isochoric energies w(I1bar) + psi(E) of anisotropic solids: the energy of the matrix depends on the first
/// invariant, the energy of the fibres on the isochoric Green strain E = (J^(-2/3) F^T F - I)/2. All tensors
/// are in material axes (material_axes.hpp): the first points along the fibres, the second lies in the
/// sheets.
namespace sandglass {

/// E with all its digits near the undeformed state: 2 E = J^(-2/3) (F^T F - I) + (J^(-2/3) - 1) I, and with
/// r = J^(-1/3), r^2 - 1 = -(J - 1) r^3 (1 + r) / (1 + r + r^2). H is symmetrised first, so that a small
/// rotation leaves no strain.
template <class T>
Tensor<T> isochoric_green_strain(const Tensor<T>& H, const VolumeChange<T>& change) {
  const T r = change.inverse_root, r2 = r * r;
  const T half_shrinkage = T(0.5) * change.J_minus_one * (r2 * r) * (T(1) + r) / (T(1) + r + r2);
  const Tensor<T> growth = left_cauchy_green_minus_identity(transpose(H));  // F^T F - I
  Tensor<T> E = (T(0.5) * r2) * growth;
  for (int i = 0; i < 3; ++i) E(i, i) = E(i, i) - half_shrinkage;
  return E;
}

/// The common base of laws with such an energy. A law derives from FibreReinforced of itself and defines
/// bulk_modulus(), isochoric_energy(H), isochoric_tangent_bound(H), matrix_modulus(H, change), the shear
/// modulus 2 w' in Pa, fibre_stress(E) = dpsi/dE in Pa, symmetric, and linear_fibre_stress(E), its part
/// that is linear in E; it inherits the functions below.
template <class Law>
struct FibreReinforced : QuadraticVolume<Law> {
  static constexpr LawTraits traits{.isotropic = false};

  /// V P (J), the first Piola-Kirchhoff stress times its reference volume V (m^3), for a pressure p (Pa,
  /// tension positive) that may differ from the law's. Fibres add
  ///   J^(-2/3) F S - (S : Cbar) / (3 J) cof F,  S = dpsi/dE,  Cbar = I + 2 E.
  template <class T>
  Tensor<T> weighted_piola(const T& V, const Tensor<T>& H, const VolumeChange<T>& change, const T& p) const {
    const Tensor<T> E = isochoric_green_strain(H, change);
    const Tensor<T> S = law().fibre_stress(E);
    const T r = change.inverse_root, r2 = r * r;
    const T mean = T(1.0 / 3.0) * V * (r2 * r) * (trace(S) + T(2) * double_dot(S, E));
    return first_invariant_piola(V * law().matrix_modulus(H, change), V * p - mean, H, change) +
           (V * r2) * (S + H * S);
  }

  /// V tau (J), the Kirchhoff stress J sigma times its reference volume; fibres add J^(-2/3) dev(F S F^T).
  template <class T>
  Tensor<T> weighted_kirchhoff(const T& V, const Tensor<T>& H, const VolumeChange<T>& change,
                               const T& p) const {
    const T r = change.inverse_root;
    return first_invariant_kirchhoff(V * law().matrix_modulus(H, change), V * p,
                                     left_cauchy_green_minus_identity(H), change) +
           (V * r * r) * deviator(to_space(law().fibre_stress(isochoric_green_strain(H, change)), H));
  }

  /// The stress (Pa) of a small strain e: K tr(e) I + 2 mu dev(e) + dev S(dev e), with the undeformed mu.
  template <class T>
  Tensor<T> small_strain_stress(const Tensor<T>& strain) const {
    const Tensor<T> isochoric = deviator(strain);
    const T mu = law().matrix_modulus(Tensor<T>{}, VolumeChange<T>{T(0), T(1)});
    Tensor<T> stress = T(2) * mu * isochoric + deviator(law().linear_fibre_stress(isochoric));
    const T mean = T(law().bulk_modulus()) * trace(strain);
    for (int i = 0; i < 3; ++i) stress(i, i) = stress(i, i) + mean;
    return stress;
  }

 private:
  constexpr const Law& law() const { return static_cast<const Law&>(*this); }
};

/// Bound of psi(E_n), a function of the strain E_n of one fibre, for its square stretch c = Cbar_n and its
/// derivatives psi' (Pa) and psi'' >= 0 (Pa), without the part psi'' (dE_n)^2, whose curvature under changes
/// of shape, 2/3 c^2 psi'', is `square` (Pa): psi' c Q(L), Q = |L n|^2 - 4/3 tr L n.L n + 2/9 (tr L)^2
/// + tr(L L)/3, n the fibre in space. Q has uncoupled parts: n.L n with the trace of L across n, eigenvalues
/// 1/2 +- sqrt(17)/6; shears along n, 1/2 +- sqrt(13)/6; shears and the spin across n, +-1/3. The square
/// involves only the first, so that shortened fibres (psi' < 0) take the larger of two numbers.
template <class T>
TangentBound<T> fibre_stress_bound(const T& stress, const T& square) {
  const double root = std::sqrt(17.0) / 6.0;
  return {
      .volumetric = T(0),
      .gradient = max(max(T(0.5 + root) * stress, T(0.5 - root) * stress), T(-1.0 / 3.0) * stress - square)};
}

}  // namespace sandglass
