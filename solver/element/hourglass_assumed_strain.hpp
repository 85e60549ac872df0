#pragma once

#include "element/hourglass_form.hpp"

namespace sandglass {

/// Assumed strain stabilisation of Belytschko and Bindeman 1993 (CMAME 105:225), their ASQBI field in three
/// dimensions, which is LS-DYNA's hourglass type 6. In axes along the element's edges, with q_ij the
/// displacement along i of hourglass mode j,
///   Q_ii = mu ((H_jj + H_kk) q_ii + H_ij q_jj + H_ik q_kk),
///   Q_ij = 2 mu (H_ii q_ij / (1-nu) + nu/(1-nu) H_ij q_ji),   j = 1..3, not i,
///   Q_i4 = 2 mu (1+nu) / 3 H_ii q_i4,
///   H_ij = integral of h_j,i h_i,j: V / (3 l_i l_j) for a box with half edges l, and H_ii = V / (3 l_i^2).
/// A box bends exactly, at any Poisson's ratio; any other element is replaced by the nearest box. Their
/// corotational axes follow the first edge; these are the orthogonal ones nearest to all three, so that the
/// numbering of the nodes does not matter. Gradients are mean ones: with gradients at the centre one point
/// fails the patch test on distorted meshes with every control.
struct AssumedStrain {
  static constexpr HourglassTraits traits{};

  template <class T>
  struct Element {
    T shear;  ///< mu, Pa
    T ratio;  ///< nu/(1-nu)
    T young;  ///< E = 2 mu (1+nu), Pa
  };

  template <class Law>
  static Element<double> precompute(const NodalVectors<double>& /*X*/, const Law& law,
                                    const HourglassSettings& /*settings*/) {
    return {law.shear_modulus(), plane_ratio(law), young_modulus(law)};
  }

  /// The stiffness in terms of d_ka = q_ka / l_k: normal strains are d and shears are ratios of lengths times
  /// d, so that no root is needed; H_jj q_ii becomes (l_i / l_j)^2 d_ii.
  template <class T>
  struct Stiffness {
    Tensor<T> b;             ///< unit axes over the box's half edges, 1/m, in columns
    std::array<T, 3> twist;  ///< l_i^2 (1/l_j^2 + 1/l_k^2)
    T shear;                 ///< mu V/3, N m, over 64 because hourglass amplitudes are q/8
    T normal;                ///< 2 mu / (1-nu), likewise
    T cross;                 ///< 2 mu nu / (1-nu), likewise
    T fourth;                ///< E/3, likewise

    HourglassModes<T> resistance(const HourglassModes<T>& q) const {
      const Matrix<T, 3, 4> d = transpose(b) * transpose(q);
      Matrix<T, 3, 4> r;
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        r(i, i) = shear * (twist[static_cast<std::size_t>(i)] * d(i, i) + (d(j, j) + d(k, k)));
        r(i, j) = normal * d(i, j) + cross * d(j, i);
        r(i, k) = normal * d(i, k) + cross * d(k, i);
        r(i, 3) = fourth * d(i, 3);
      }
      return transpose(b * r);
    }

    /// The energy (J) stored by resistances Q (N), from the inverses of the blocks.
    T energy(const HourglassModes<T>& Q) const {
      const Matrix<T, 3, 4> r = inverse(b) * transpose(Q);
      Tensor<T> twisting;
      Triple<T> torque;
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) twisting(i, j) = i == j ? twist[static_cast<std::size_t>(i)] : T(1);
        torque(i, 0) = r(i, i);
      }
      T energy = double_dot(torque, inverse(twisting) * torque) / shear;
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        const T own = r(i, j) * r(i, j) + r(j, i) * r(j, i);
        energy =
            energy + (normal * own - T(2) * cross * r(i, j) * r(j, i)) / (normal * normal - cross * cross);
        energy = energy + r(i, 3) * r(i, 3) / fourth;
      }
      return T(0.5) * energy;
    }

    T bound() const { return block_row_sum_bound(matrix_of<T>(*this)); }
  };

  /// The stiffness in a configuration with nodal coordinates x (m, in modes) and the geometry `current`.
  template <class T>
  static Stiffness<T> stiffness(const Modes<T>& x, const OnePoint::Element<T>& current,
                                const Element<T>& element) {
    const Tensor<T> g = centre_edges(x);
    const std::array<T, 3> square = edge_squares(g);
    const std::array<T, 3> inverse_square{T(1) / square[0], T(1) / square[1], T(1) / square[2]};
    Stiffness<T> result;
    result.b = box_edges(g, inverse_square);
    for (int k = 0; k < 3; ++k) {
      const auto n = static_cast<std::size_t>(k);
      for (int i = 0; i < 3; ++i) result.b(i, k) = result.b(i, k) * inverse_square[n];
      result.twist[n] = square[n] * (inverse_square[(n + 1) % 3] + inverse_square[(n + 2) % 3]);
    }
    const T scale = current.V * T(1.0 / 3.0 / 64.0);
    result.shear = element.shear * scale;
    result.cross = T(2) * result.shear * element.ratio;
    result.normal = T(2) * result.shear + result.cross;  // 1/(1-nu) = 1 + nu/(1-nu)
    result.fourth = (element.young * scale) * T(1.0 / 3.0);
    return result;
  }

  /// The edges (m) of the box that replaces an element: as long as its edges g, and at right angles. This is
  /// Loewdin's orthogonalisation E (E^T E)^(-1/2) of the unit edges E, which treats all three edges equally,
  /// in the expansion I - C/2 + 3/8 C^2 with the cosines C = E^T E - I: at right angles up to third order in
  /// the cosines. In this form for edges of any length it needs no root.
  template <class T>
  static Tensor<T> box_edges(const Tensor<T>& g, const std::array<T, 3>& inverse_square) {
    Tensor<T> p;  // g_j . g_k / |g_j|^2, without the diagonal
    for (int j = 0; j < 3; ++j) {
      const int k = (j + 1) % 3;
      const T product = edge_product(g, j, k);
      p(j, k) = product * inverse_square[static_cast<std::size_t>(j)];
      p(k, j) = product * inverse_square[static_cast<std::size_t>(k)];
    }
    Tensor<T> share;
    for (int j = 0; j < 3; ++j) {
      const int k = (j + 1) % 3, l = (j + 2) % 3;
      share(j, j) = T(1) + T(0.375) * (p(j, k) * p(k, j) + p(j, l) * p(l, j));
      share(j, k) = T(0.375) * (p(j, l) * p(l, k)) - T(0.5) * p(j, k);
      share(j, l) = T(0.375) * (p(j, k) * p(k, l)) - T(0.5) * p(j, l);
    }
    return g * share;
  }
};

}  // namespace sandglass
