#pragma once

#include "element/hourglass_form.hpp"

namespace sandglass {

/// Enhanced assumed strain, physically stabilised, after Puso 2000 (IJNME 49:1029): the element's strain
/// energy in its hourglass modes, with strains enhanced where trilinear displacements are too stiff, and the
/// enhanced modes condensed by hand.
///
/// With edges g_k at the centre and hourglass displacements q_a = gamma_a^T u, the covariant strains vary as
/// xi, eta, zeta (from D_ka = g_k . q_a, a = 1..3) and as their products (a = 4). These functions are
/// orthogonal, so that the energy falls apart:
/// - What varies as one parent coordinate, say zeta, is the bending of a plate with the edges g_1 and g_2 and
///   the thickness g_3: E_11 = D_12, E_22 = D_21, 2 E_12 = D_11 + D_22. The strains E_33, E_13 and E_23 are
///   enhanced, which leaves plane stress: sigma = 2 mu (E + nu/(1-nu) tr E) in the plane's own metric. No
///   shear locking, no volumetric locking, and exact bending of any parallelepiped.
/// - What varies as a product is a normal strain along one edge, D_k4; a volumetric strain is added that
///   takes its pressure away, 4/3 mu (g^kk)^2 remains. The parasitic shears of this mode are left out.
/// Puso maps strains with the lengths of the edges alone; here the whole metric is used, so that skew
/// elements bend as exactly as boxes. The gradients inside gamma are mean ones: with centre gradients the
/// patch test fails on distorted meshes.
struct EnhancedStrain {
  static constexpr bool takes_kappa = false;

  template <class T>
  struct Element {
    T shear;  ///< mu, Pa
    T ratio;  ///< nu/(1-nu)
  };

  template <class Law>
  static Element<double> precompute(const NodalVectors<double>& /*X*/, const Law& law,
                                    const HourglassSettings& /*settings*/) {
    return {law.shear_modulus(), plane_ratio(law)};
  }

  /// The plate between two edges.
  template <class T>
  struct Plate {
    T aa, bb, ab;  ///< its metric, m^2
    T minor;       ///< determinant of the metric, m^4
  };

  template <class T>
  struct Stiffness {
    Tensor<T> g;                    ///< edges, m
    std::array<Plate<T>, 3> plate;  ///< by the number of the edge across: (2,3), (3,1), (1,2)
    T V;                            ///< m^3
    T shear;                        ///< mu, Pa
    T ratio;                        ///< nu/(1-nu)

    HourglassModes<T> resistance(const HourglassModes<T>& q) const {
      const Matrix<T, 3, 4> D = transpose(g) * transpose(q);
      Matrix<T, 3, 4> R;  // contravariant: Q_a = g_k R_ka
      const T bending = (shear * V) * T(2.0 * integral_of_square);
      std::array<T, 3> twist;
      for (int n = 0; n < 3; ++n) {
        const auto [a, b] = plane(n);
        const Plate<T>& p = plate[static_cast<std::size_t>(n)];
        // Both indices are raised with the adjoint (bb, -ab, aa) of the metric; the two determinants wait.
        const T E12 = T(0.5) * (D(a, a) + D(b, b));
        const T M11 = p.bb * D(a, b) - p.ab * E12, M12 = p.bb * E12 - p.ab * D(b, a);
        const T M21 = p.aa * E12 - p.ab * D(a, b), M22 = p.aa * D(b, a) - p.ab * E12;
        const T spherical = ratio * (M11 + M22);
        const T N11 = M11 + spherical, N22 = M22 + spherical;
        const T scale = bending / (p.minor * p.minor);
        R(a, b) = scale * (N11 * p.bb - M12 * p.ab);
        R(b, a) = scale * (N22 * p.aa - M21 * p.ab);
        twist[static_cast<std::size_t>(n)] = scale * (M12 * p.aa - N11 * p.ab);
      }
      const T fourth = fourth_stiffness();
      for (int k = 0; k < 3; ++k) {
        const T minor = plate[static_cast<std::size_t>(k)].minor;
        R(k, k) = twist[static_cast<std::size_t>((k + 1) % 3)] + twist[static_cast<std::size_t>((k + 2) % 3)];
        R(k, 3) = (fourth * (minor * minor)) * D(k, 3);
      }
      return transpose(g * R);
    }

    /// Each plate's stresses come from R, and their strains from Hooke's law in reverse,
    /// 2 mu E = sigma - nu/(1+nu) tr sigma.
    T energy(const HourglassModes<T>& Q) const {
      const Matrix<T, 3, 4> R = inverse(g) * transpose(Q);
      const T compliance = T(1) / ((shear * V) * T(2.0 * integral_of_square));
      const T lateral = ratio / (T(1) + T(2) * ratio);  // nu/(1+nu)
      const T fourth = fourth_stiffness();
      T energy = T(0);
      for (int n = 0; n < 3; ++n) {
        const auto [a, b] = plane(n);
        const Plate<T>& p = plate[static_cast<std::size_t>(n)];
        const T s11 = R(a, b), s22 = R(b, a), s12 = T(0.5) * (R(a, a) + R(b, b) - R(n, n));
        const T m11 = p.aa * s11 + p.ab * s12, m12 = p.aa * s12 + p.ab * s22;  // one index lowered
        const T m21 = p.ab * s11 + p.bb * s12, m22 = p.ab * s12 + p.bb * s22;
        const T tr = m11 + m22;
        energy =
            energy + T(0.5) * compliance * (m11 * m11 + m22 * m22 + T(2) * m12 * m21 - lateral * tr * tr);
        energy = energy + T(0.5) * R(n, 3) * R(n, 3) / (fourth * p.minor * p.minor);
      }
      return energy;
    }

    T bound() const { return row_sum_bound(matrix_of<T>(*this)); }

   private:
    /// 4/3 mu times the integral of (xi eta)^2 and, with g^kk = minor / det(g)^2, the rest of (g^kk)^2.
    T fourth_stiffness() const {
      const T eight_over_V = T(8) / V;
      const T inverse_determinant = eight_over_V * eight_over_V;
      return (shear * V) * T(4.0 / 9.0 * integral_of_square) * (inverse_determinant * inverse_determinant);
    }
  };

  template <class T>
  static Stiffness<T> stiffness(const Modes<T>& x, const OnePoint::Element<T>& current,
                                const Element<T>& element) {
    Stiffness<T> result;
    result.g = centre_edges(x);
    const std::array<T, 3> square = edge_squares(result.g);
    for (int n = 0; n < 3; ++n) {
      const auto [a, b] = plane(n);
      Plate<T>& p = result.plate[static_cast<std::size_t>(n)];
      p.aa = square[static_cast<std::size_t>(a)];
      p.bb = square[static_cast<std::size_t>(b)];
      p.ab = edge_product(result.g, a, b);
      p.minor = p.aa * p.bb - p.ab * p.ab;
    }
    result.V = current.V;
    result.shear = element.shear;
    result.ratio = element.ratio;
    return result;
  }

 private:
  /// Integral of xi^2 over the element is V/3, and hourglass amplitudes are q/8.
  static constexpr double integral_of_square = 1.0 / 3.0 / 64.0;

  /// The two edges beside edge n.
  static constexpr std::array<int, 2> plane(int n) { return {(n + 1) % 3, (n + 2) % 3}; }
};

}  // namespace sandglass
