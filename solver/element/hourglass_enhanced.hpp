#pragma once

#include "element/hourglass_form.hpp"
#include "math/symmetric_matrix.hpp"

namespace sandglass {

/// Enhanced assumed strain, physically stabilised, after Puso 2000 (IJNME 49:1029): the element's strain
/// energy in its hourglass modes, with strains enhanced where trilinear displacements are too stiff, and the
/// enhanced modes condensed analytically.
///
/// With edges g_k at the centre and hourglass displacements q_a = gamma_a^T u, the covariant strains vary as
/// xi, eta, zeta (from D_ka = g_k . q_a, a = 1..3) and as their products (a = 4). These functions are
/// orthogonal, so that the energy is a sum:
/// - The part that varies with one parent coordinate, say zeta, is the bending of a plate with the edges g_1
///   and g_2 and the thickness g_3: E_11 = D_12, E_22 = D_21, 2 E_12 = D_11 + D_22. The strains E_33, E_13
///   and E_23 are enhanced, which leaves plane stress: sigma = 2 mu (E + nu/(1-nu) tr E) in the metric of the
///   plane. There is neither shear locking nor volumetric locking, and a parallelepiped bends exactly out of
///   the plane of two edges.
/// - The part that varies with a product is a normal strain along one edge, D_k4; an added volumetric strain
///   removes its pressure, and 4/3 mu (g^kk)^2 remains. The parasitic shears of this mode are omitted.
/// Puso maps strains with the lengths of the edges only; here the whole metric is used, so that skew elements
/// bend as exactly as boxes. Gradients are mean ones: with gradients at the centre one point fails the patch
/// test on distorted meshes with every control.
struct EnhancedStrain {
  static constexpr HourglassTraits traits{};

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

  /// The stiffness of the plate between the edges a and b: stresses (aa, bb, ab) from strains, twice for ab.
  template <class T>
  using Plate = SymmetricMatrix<T, 3>;

  template <class T>
  struct Stiffness {
    Tensor<T> g;                    ///< edges, m
    std::array<Plate<T>, 3> plate;  ///< N/m^3, by the number of the edge across: (2,3), (3,1), (1,2)
    std::array<T, 3> fourth;        ///< N/m^3, of the normal strain along each edge

    HourglassModes<T> resistance(const HourglassModes<T>& q) const {
      const Matrix<T, 3, 4> D = transpose(g) * transpose(q);
      Matrix<T, 3, 4> R;  // contravariant: Q_a = g_k R_ka
      std::array<T, 3> twist;
      for (int n = 0; n < 3; ++n) {
        const auto across = static_cast<std::size_t>(n);
        const auto [a, b] = plane(n);
        const Triple<T> stress = plate[across] * Triple<T>{{D(a, b), D(b, a), D(a, a) + D(b, b)}};
        R(a, b) = stress(0, 0);
        R(b, a) = stress(1, 0);
        twist[across] = stress(2, 0);
        R(n, 3) = fourth[across] * D(n, 3);
      }
      for (int k = 0; k < 3; ++k) {
        const auto [a, b] = plane(k);
        R(k, k) = twist[static_cast<std::size_t>(a)] + twist[static_cast<std::size_t>(b)];
      }
      return transpose(g * R);
    }

    /// The energy (J) stored by resistances Q (N), from the inverses of the plates' stiffnesses; each edge is
    /// in two planes, so that the three twists follow from the three R_kk.
    T energy(const HourglassModes<T>& Q) const {
      const Matrix<T, 3, 4> R = inverse(g) * transpose(Q);
      T energy = T(0);
      for (int n = 0; n < 3; ++n) {
        const auto across = static_cast<std::size_t>(n);
        const auto [a, b] = plane(n);
        const Triple<T> stress{{R(a, b), R(b, a), T(0.5) * (R(a, a) + R(b, b) - R(n, n))}};
        energy = energy + double_dot(stress, inverse(dense(plate[across])) * stress);
        energy = energy + R(n, 3) * R(n, 3) / fourth[across];
      }
      return T(0.5) * energy;
    }

    T bound() const { return block_row_sum_bound(matrix_of<T>(*this)); }
  };

  /// The stiffness in a configuration with nodal coordinates x (m, in modes) and the geometry `current`.
  template <class T>
  static Stiffness<T> stiffness(const Modes<T>& x, const OnePoint::Element<T>& current,
                                const Element<T>& element) {
    Stiffness<T> result;
    result.g = centre_edges(x);
    const std::array<T, 3> square = edge_squares(result.g);
    // Integrals of xi^2 and (xi eta)^2 over the element are V/3 and V/9, and hourglass amplitudes are q/8.
    const T bending = (element.shear * current.V) * T(2.0 / 3.0 / 64.0);
    const T eight_over_V = T(8) / current.V;
    const T inverse_determinant = eight_over_V * eight_over_V;  // of the metric: g^kk = minor / determinant
    const T fourth = (bending * T(2.0 / 9.0)) * (inverse_determinant * inverse_determinant);
    for (int n = 0; n < 3; ++n) {
      const auto across = static_cast<std::size_t>(n);
      const auto [a, b] = plane(n);
      const T aa = square[static_cast<std::size_t>(a)], bb = square[static_cast<std::size_t>(b)];
      const T ab = edge_product(result.g, a, b);
      const T aabb = aa * bb, abab = ab * ab;
      const T minor = aabb - abab;
      const T minor_square = minor * minor;
      result.plate[across] = plane_stress(aa, bb, ab, aabb, abab, bending / minor_square, element.ratio);
      result.fourth[across] = fourth * minor_square;
    }
    return result;
  }

 private:
  /// The two edges other than edge n.
  static constexpr std::array<int, 2> plane(int n) { return {(n + 1) % 3, (n + 2) % 3}; }

  /// sigma = 2 mu (E + nu/(1-nu) tr E) with both indices raised by the inverse metric, which is (bb, aa, -ab)
  /// over its determinant; `scale` holds 2 mu and the determinant's square.
  template <class T>
  static Plate<T> plane_stress(const T& aa, const T& bb, const T& ab, const T& aabb, const T& abab,
                               const T& scale, const T& ratio) {
    const T normal = scale + scale * ratio;
    const T mixed = -(normal * ab);
    Plate<T> C;
    C(0, 0) = normal * (bb * bb);
    C(1, 1) = normal * (aa * aa);
    C(0, 1) = scale * (abab + ratio * aabb);
    C(0, 2) = mixed * bb;
    C(1, 2) = mixed * aa;
    C(2, 2) = scale * (T(0.5) * (aabb + abab) + ratio * abab);
    return C;
  }
};

}  // namespace sandglass
