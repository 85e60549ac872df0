#pragma once

#include "element/one_point.hpp"
#include "element/stabilization_matrix.hpp"
#include "material/laws.hpp"

/// Physical hourglass stiffnesses, without a parameter: they follow from an element's shape and its law's
/// initial moduli. Updated Lagrangian controls evaluate them for the current shape in every step, Total
/// Lagrangian ones once.
namespace sandglass {

/// nu/(1-nu) of the undeformed state, as in plane stress.
template <class Law>
double plane_ratio(const Law& law) {
  const double lambda = lame_lambda(law);
  return lambda / (lambda + 2.0 * law.shear_modulus());
}

/// The edges of a hexahedron at its centre: dx_i/dxi_k in row i and column k, m.
template <class T>
Tensor<T> centre_edges(const Modes<T>& x) {
  Tensor<T> g;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) g(i, k) = T(0.125) * x(k, i);
  }
  return g;
}

/// g_k . g_l: an entry of the edges' metric, m^2.
template <class T>
T edge_product(const Tensor<T>& g, int k, int l) {
  return g(0, k) * g(0, l) + g(1, k) * g(1, l) + g(2, k) * g(2, l);
}

/// g_k . g_k, the squares of their lengths, m^2.
template <class T>
std::array<T, 3> edge_squares(const Tensor<T>& g) {
  std::array<T, 3> squares;
  for (int k = 0; k < 3; ++k) squares[static_cast<std::size_t>(k)] = edge_product(g, k, k);
  return squares;
}

/// The 12 x 12 matrix of a linear map from hourglass displacements to resistances.
template <class T, class Stiffness>
Matrix<T, 12, 12> matrix_of(const Stiffness& stiffness) {
  Matrix<T, 12, 12> K;
  for (int n = 0; n < 12; ++n) {
    HourglassModes<T> unit;
    for (auto& entry : unit.entries) entry = T(0);
    unit.entries[static_cast<std::size_t>(n)] = T(1);
    const HourglassModes<T> Q = stiffness.resistance(unit);
    for (int m = 0; m < 12; ++m) K(m, n) = Q.entries[static_cast<std::size_t>(m)];
  }
  return K;
}

/// A form as the control of a Total Lagrangian element: its stiffness in the reference configuration is
/// computed once and stored in the form's own structure, which is smaller than a 12 x 12 matrix. The control
/// follows the mean deformation.
template <class Form>
struct ReferenceHourglassControl {
  static constexpr HourglassTraits traits{.follows_deformation = true};

  template <class T>
  using Element = typename Form::template Stiffness<T>;
  template <class T>
  using History = NoHistory<T>;

  template <class Law>
  static Element<double> precompute(const NodalVectors<double>& X, const Law& law,
                                    const HourglassSettings& settings) {
    const Modes<double> x = to_modes(X);
    return Form::stiffness(x, OnePoint::geometry(x), Form::precompute(X, law, settings));
  }

  /// K r, in N.
  template <class T>
  static HourglassModes<T> resistance(const HourglassModes<T>& r, const Element<T>& element) {
    return element.resistance(r);
  }

  /// The bound (N/m) of StabilizationMatrixControl for the matrix of the form.
  template <class T>
  static T stiffness_bound(const Matrix<T, 8, 4>& gamma, const Element<T>& element) {
    return StabilizationMatrixControl::stiffness_bound(gamma, {symmetric_part(matrix_of<T>(element))});
  }
};

}  // namespace sandglass
