#pragma once

#include "element/element_motion.hpp"
#include "element/gram_bound.hpp"
#include "element/tetrahedron_split.hpp"

/// The pressure of a tetrahedron: policies of `Tetrahedra`. Each has
///   around(motion)                       the data of surrounding elements on which the pressure depends,
///   pressures(dilatation, around, law)   the pressure (Pa) of each tetrahedron from J - 1,
///   volumetric_energy(...)               the element's share of the volumetric energy, J,
///   own_bulk_tangent(dilatation, law)    the bulk tangent (Pa) of a tetrahedron's own volume change,
///   shared_bulk_bound(...)               a bound (N/m) of the stiffness due to shared pressures.
namespace sandglass {

/// One pressure per tetrahedron: the linear tetrahedron, which locks as nu -> 1/2.
struct OwnPressure {
  static constexpr bool averages_over_nodes = false;

  /// The data of surrounding elements on which the pressure depends.
  template <class T>
  struct Around {};
  template <class T>
  static Around<T> around(const ElementMotion<T>& /*motion*/) {
    return {};
  }

  template <class T, class Law>
  static TetrahedronValues<T> pressures(const TetrahedronValues<T>& dilatation, const Around<T>& /*around*/,
                                        const Law& law) {
    TetrahedronValues<T> p;
    for (std::size_t e = 0; e < tetrahedron_count; ++e) p[e] = law.pressure(dilatation[e]);
    return p;
  }

  template <class T, class Law>
  static T volumetric_energy(const TetrahedronValues<T>& dilatation, const Around<T>& /*around*/,
                             const TetrahedronConstants<T>& element, const Law& law) {
    T U = element.weight[0] * law.volumetric_energy(dilatation[0]);
    for (std::size_t e = 1; e < tetrahedron_count; ++e) {
      U = U + element.weight[e] * law.volumetric_energy(dilatation[e]);
    }
    return U;
  }

  template <class T, class Law>
  static T own_bulk_tangent(const T& dilatation, const Law& law) {
    return law.bulk_tangent(dilatation);
  }

  template <class T, class Law>
  static T shared_bulk_bound(const TetrahedronValues<T>& /*dilatation*/, const Around<T>& /*around*/,
                             const TetrahedronConstants<T>& /*element*/,
                             const std::array<NodalVectors<T>, tetrahedron_count>& /*g*/,
                             const Law& /*law*/) {
    return T(0);
  }
};

/// Averaged nodal pressures (Bonet & Burton 1998; Joldes, Wittek & Miller 2009): a quarter of each
/// tetrahedron belongs to each of its nodes. With V_I the undeformed volume that belongs to node I and J_I
/// its volume ratio, both separately for each material at the node, the energy is
///   sum_e V_e W_iso(F_e) + sum_I V_I U(J_I),
/// so that the pressure of a tetrahedron is the mean of p_I = U'(J_I) over its nodes, and its stress
/// P_iso(F) + p cof F, as in Bonet and Burton. Joldes et al. evaluate the law for (Jbar/J)^(1/3) F instead,
/// with Jbar the mean of the nodes' J_I: the same pressure, but other powers of Jbar/J in both parts of the
/// stress, which then is not the derivative of an energy. The two agree for Jbar = J.
struct NodalPressure {
  static constexpr bool averages_over_nodes = true;

  template <class T>
  using Around = std::array<T, 8>;  ///< J_I - 1
  template <class T>
  static Around<T> around(const ElementMotion<T>& motion) {
    return motion.dilatation;
  }

  template <class T, class Law>
  static TetrahedronValues<T> pressures(const TetrahedronValues<T>& /*dilatation*/, const Around<T>& around,
                                        const Law& law) {
    std::array<T, 8> quarter;
    for (std::size_t I = 0; I < 8; ++I) quarter[I] = T(0.25) * law.pressure(around[I]);
    return sums_over_nodes(quarter);
  }

  template <class T, class Law>
  static T volumetric_energy(const TetrahedronValues<T>& /*dilatation*/, const Around<T>& around,
                             const TetrahedronConstants<T>& element, const Law& law) {
    const std::array<T, 8> V = nodal_shares(element.weight);
    T U = V[0] * law.volumetric_energy(around[0]);
    for (std::size_t I = 1; I < 8; ++I) U = U + V[I] * law.volumetric_energy(around[I]);
    return U;
  }

  template <class T, class Law>
  static T own_bulk_tangent(const T& /*dilatation*/, const Law& /*law*/) {
    return T(0);
  }

  /// A bound (N/m) of the element's share of V_I U''(J_I) (dJ_I)^2, which couples all neighbours of a node:
  /// dJ_I is the mean, weighted by volume, of the dJ of the surrounding hexahedra, and the square of a mean
  /// is at most the mean of the squares. So each hexahedron h contributes v_hI U''(J_I) (G_hI . v)^2, with
  /// v_hI its share of V_I and G_hI = sum_e (V_e / 4) J_e g_e / v_hI over its own tetrahedra.
  template <class T, class Law>
  static T shared_bulk_bound(const TetrahedronValues<T>& dilatation, const Around<T>& around,
                             const TetrahedronConstants<T>& element,
                             const std::array<NodalVectors<T>, tetrahedron_count>& g, const Law& law) {
    const std::array<T, 8> v = nodal_shares(element.weight);
    std::array<T, 8> stiffness;
    std::array<NodalVectors<T>, 8> G{};
    for (std::size_t I = 0; I < 8; ++I) {
      stiffness[I] = v[I] * max(law.bulk_tangent(around[I]), T(0));
      for (std::size_t e = 0; e < tetrahedron_count; ++e) {
        if (!detail::belongs(static_cast<int>(I), e)) continue;
        G[I] += (T(0.25) * element.weight[e] * (T(1) + dilatation[e]) / v[I]) * g[e];
      }
    }
    return gram_bound(stiffness, G);
  }
};

}  // namespace sandglass
