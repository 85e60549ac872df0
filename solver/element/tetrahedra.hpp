#pragma once

#include "element/corner_gradients.hpp"
#include "element/hourglass_none.hpp"
#include "element/one_point.hpp"
#include "element/tetrahedron_pressure.hpp"
#include "material/point_stress.hpp"

namespace sandglass {

/// A hexahedron as linear tetrahedra: both cuts into five, each with half the weight. Every face has both
/// diagonals from both sides, so that neighbours agree without a colouring of the mesh, no direction is
/// preferred, and volume and nodal forces of a uniform stress are those of the trilinear hexahedron, because
/// the volume under a bilinear face is the mean of those under its two triangulations: the patch test holds.
/// A single cut costs half, prefers its diagonals, and fits its neighbours only if the elements can be
/// coloured like a chess-board. In modes, eight of the displacement gradients are the corner gradients of the
/// trilinear field, times 8
///   a_k + s_j a_kj + s_l a_kl + s_j s_l a_123,
/// the two inner ones a_k -+ a_jl, where k, j, l are the three axes. `Pressure` is a policy: `OwnPressure` or
/// `NodalPressure`.
template <class Pressure>
struct Tetrahedra {
  /// What is constant in time.
  template <class T>
  using Element = TetrahedronConstants<T>;

  static constexpr KinematicsTraits traits{.points = static_cast<int>(tetrahedron_count),
                                           .averages_over_nodes = Pressure::averages_over_nodes,
                                           .averages_pressure = Pressure::averages_over_nodes,
                                           .demand = "all its tetrahedra must have a positive volume"};
  using NoControl = NoHourglassControl;

  static Element<double> precompute(const NodalVectors<double>& X) {
    Element<double> element{};
    const auto jacobians = parent_gradients(to_modes(X));  // times 8
    for (std::size_t e = 0; e < tetrahedron_count; ++e) {
      element.inverse_jacobian[e] = inverse(jacobians[e]);
      element.weight[e] = parent_weight(e) * determinant(0.125 * jacobians[e]);
    }
    return element;
  }

  static bool accepts(const NodalVectors<double>& X) {
    const auto jacobians = parent_gradients(to_modes(X));
    for (const auto& jacobian : jacobians) {
      if (!(determinant(jacobian) > 0.0)) return false;
    }
    return true;
  }

  /// The deformation of each tetrahedron.
  template <class T>
  struct Deformation {
    TetrahedronTensors<T> H;
    TetrahedronValues<T> inverse_root;
    TetrahedronValues<T> J_minus_one;
    [[no_unique_address]] typename Pressure::template Around<T> around;
  };

  template <class Hourglass, class T>
  static Deformation<T> deformation(const ElementMotion<T>& motion, const Element<T>& element) {
    Deformation<T> now;
    now.H = gradients(motion, element);
    for (std::size_t e = 0; e < tetrahedron_count; ++e) {
      const VolumeChange<T> change = volume_change(now.H[e]);
      now.J_minus_one[e] = change.J_minus_one;
      now.inverse_root[e] = change.inverse_root;
    }
    now.around = Pressure::around(motion);
    return now;
  }

  /// Internal forces (N) in modes: sum_e w_e B_e (P_iso(H_e) + p_e cof F_e)^T.
  template <class Hourglass, class T, class Law>
  static Modes<T> force(const Deformation<T>& now, const Element<T>& element,
                        const NoControl::Element<T>& /*control*/, NoHistory<T>& /*history*/, const Law& law) {
    const TetrahedronValues<T> p = Pressure::pressures(now.J_minus_one, now.around, law);
    TetrahedronTensors<T> flux;  // w P J^-T, the stress conjugate to the parent gradient
    const auto load = [&](std::size_t e) {
      return PointLoad<T>{element.weight[e], {now.J_minus_one[e], now.inverse_root[e]}, p[e]};
    };
    for_each_stress(law, now.H, load, [&](std::size_t e, const Tensor<T>& VP) {
      flux[e] = VP * transpose(element.inverse_jacobian[e]);
    });
    return parent_divergence(flux);
  }

  /// The element's contribution to nodal volumes: a quarter of each tetrahedron for each of its nodes.
  template <class T>
  static NodalVolumes<T> nodal_volumes(const ElementMotion<T>& motion, const Element<T>& element) {
    TetrahedronValues<T> change = dilatations(gradients(motion, element));
    for (std::size_t e = 0; e < tetrahedron_count; ++e) change[e] = element.weight[e] * change[e];
    return {nodal_shares(change), nodal_shares(element.weight)};
  }

  /// Strain energy (J), including the element's share, by volume, of the energy at its nodes.
  template <class Hourglass, class T, class Law>
  static ElementEnergy<T> energy(const ElementMotion<T>& motion, const Element<T>& element,
                                 const NoControl::Element<T>& /*control*/, const NoHistory<T>& /*history*/,
                                 const Law& law) {
    const TetrahedronTensors<T> H = gradients(motion, element);
    T W = Pressure::volumetric_energy(dilatations(H), Pressure::around(motion), element, law);
    for (std::size_t e = 0; e < tetrahedron_count; ++e)
      W = W + element.weight[e] * at_point(law, e).isochoric_energy(H[e]);
    return {W, T(0)};
  }

  /// Reference volume, m^3.
  template <class T>
  static T volume(const ElementMotion<T>& /*motion*/, const Element<T>& element) {
    T V = element.weight[0];
    for (std::size_t e = 1; e < tetrahedron_count; ++e) V = V + element.weight[e];
    return V;
  }

  template <class T>
  static T smallest_jacobian(const ElementMotion<T>& motion, const Element<T>& element) {
    const TetrahedronValues<T> dilatation = dilatations(gradients(motion, element));
    T smallest = dilatation[0];
    for (std::size_t e = 1; e < tetrahedron_count; ++e) smallest = min(smallest, dilatation[e]);
    return T(1) + smallest;
  }

  template <class T>
  static T dilatation(const ElementMotion<T>& motion, const Element<T>& element) {
    const TetrahedronValues<T> each = dilatations(gradients(motion, element));
    T sum = element.weight[0] * each[0];
    for (std::size_t e = 1; e < tetrahedron_count; ++e) sum = sum + element.weight[e] * each[e];
    return sum / volume(motion, element);
  }

  /// An upper bound of the largest eigenvalue (N/m) of the tangent stiffness, see gram_bound.hpp. With nodal
  /// pressures it bounds an element stiffness whose sum over the mesh is not below the true one.
  template <class Hourglass, class T, class Law>
  static T stiffness_bound(const ElementMotion<T>& motion, const Element<T>& element,
                           const NoControl::Element<T>& /*control*/, const NoHistory<T>& /*history*/,
                           const Law& law) {
    const TetrahedronTensors<T> H = gradients(motion, element);
    const TetrahedronValues<T> dilatation = dilatations(H);
    const auto around = Pressure::around(motion);
    const TetrahedronValues<T> p = Pressure::pressures(dilatation, around, law);
    std::array<NodalVectors<T>, tetrahedron_count> g;  // spatial gradients of the shape functions
    TetrahedronValues<T> volumetric, gradient;
    for (std::size_t e = 0; e < tetrahedron_count; ++e) {
      const Tensor<T> to_space = T(8) * (element.inverse_jacobian[e] * inverse(identity<T>() + H[e]));
      g[e] = from_double<T>(detail::tetrahedron_gradient(e)) * to_space;
      const auto point = tangent_bound(at_point(law, e), H[e], dilatation[e], p[e],
                                       Pressure::own_bulk_tangent(dilatation[e], law));
      volumetric[e] = element.weight[e] * max(point.volumetric, T(0));
      gradient[e] = element.weight[e] * point.gradient;
    }
    return gradients_bound(gradient, g) + gram_bound(volumetric, g) +
           Pressure::shared_bulk_bound(dilatation, around, element, g, law);
  }

 private:
  /// Half the volume of a tetrahedron in the parent cube: 4/3 at a corner, 8/3 inside.
  static constexpr double parent_weight(std::size_t e) { return e < 8 ? 2.0 / 3.0 : 4.0 / 3.0; }

  /// Parent gradients du_i/dxi_k, times 8.
  template <class T>
  static TetrahedronTensors<T> parent_gradients(const Modes<T>& modes) {
    TetrahedronTensors<T> gradients;
    const auto corners = corner_gradients<AtCorners>(modes);
    std::copy(corners.begin(), corners.end(), gradients.begin());
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        gradients[8](i, k) = modes(k, i) - modes(3 + k, i);
        gradients[9](i, k) = modes(k, i) + modes(3 + k, i);
      }
    }
    return gradients;
  }

  /// The transpose of `parent_gradients`.
  template <class T>
  static Modes<T> parent_divergence(const TetrahedronTensors<T>& flux) {
    std::array<Tensor<T>, 8> corners;
    std::copy_n(flux.begin(), 8, corners.begin());
    Modes<T> f = corner_divergence<AtCorners>(corners);
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        f(k, i) = f(k, i) + (flux[8](i, k) + flux[9](i, k));
        f(3 + k, i) = f(3 + k, i) + (flux[9](i, k) - flux[8](i, k));
      }
    }
    return f;
  }

  /// Displacement gradients.
  template <class T>
  static TetrahedronTensors<T> gradients(const ElementMotion<T>& motion, const Element<T>& element) {
    TetrahedronTensors<T> H = parent_gradients(motion.u);
    for (std::size_t e = 0; e < tetrahedron_count; ++e) H[e] = H[e] * element.inverse_jacobian[e];
    return H;
  }

  template <class T>
  static TetrahedronValues<T> dilatations(const TetrahedronTensors<T>& H) {
    TetrahedronValues<T> dilatation;
    for (std::size_t e = 0; e < tetrahedron_count; ++e) dilatation[e] = jacobian_minus_one(H[e]);
    return dilatation;
  }
};

}  // namespace sandglass
