#pragma once

#include <array>

#include "material/laws.hpp"
#include "math/dual.hpp"
#include "math/symmetric_matrix.hpp"
#include "mesh/hexahedron.hpp"

/// The part of the displacement gradient whose mean vanishes, which one point misses. For set-up, in double
/// precision.
namespace sandglass {

/// The fluctuation of the displacement gradient at the 2x2x2 Gauss points. It is determined by the hourglass
/// displacements q = gamma^T u: du_i/dX_j = H_ij + sum_a q_ai gradient(a, j), exactly and for any shape.
struct HourglassFluctuation {
  std::array<Matrix<double, 4, 3>, 8> gradient;  ///< per m of hourglass displacement, 1/m
  std::array<double, 8> weight;                  ///< det(dX/dxi), m^3
};

/// The fluctuation of an element with reference coordinates X (m). Nodal values are a linear field and
/// Gamma a, hence q = gamma^T Gamma a = (8 I - c g^T) a with c = Gamma^T X and g = Gamma^T h the mean
/// gradients of the hourglass modes. That is a = q / 8 on parallelepipeds, where g = 0; elsewhere the inverse
/// is (I + c (8 I - g^T c)^-1 g^T) / 8.
inline HourglassFluctuation hourglass_fluctuation(const NodalVectors<double>& X) {
  const auto Gamma_T = transpose(hourglass_base_vectors());
  const MeanGradient mean = mean_gradient(X);
  const Matrix<double, 4, 3> c = Gamma_T * X;
  const Matrix<double, 4, 3> g = Gamma_T * mean.h;
  Matrix<double, 4, 4> amplitude = c * inverse(8.0 * identity<double>() - transpose(g) * c) * transpose(g);
  for (int a = 0; a < 4; ++a) amplitude(a, a) += 1.0;
  amplitude = 0.125 * amplitude;

  HourglassFluctuation fluctuation{};
  const auto points = gauss_points();
  for (std::size_t p = 0; p < points.size(); ++p) {
    const PointGradient point = point_gradient(X, points[p]);
    fluctuation.gradient[p] = transpose(amplitude) * (Gamma_T * point.gradient - g);
    fluctuation.weight[p] = point.measure;
  }
  return fluctuation;
}

/// The tangent dP_ij/dH_kl (Pa) of the isochoric part of an undeformed law, in row 3 i + j and column 3 k +
/// l.
template <class Law>
Matrix<double, 9, 9> undeformed_isochoric_tangent(const Law& law) {
  Matrix<double, 9, 9> tangent;
  for (int kl = 0; kl < 9; ++kl) {
    Tensor<Dual<double>> H = from_double<Dual<double>>(Tensor<double>{});
    H.entries[static_cast<std::size_t>(kl)].slope = 1.0;
    const Tensor<Dual<double>> P = law.isochoric_piola(H);
    for (int ij = 0; ij < 9; ++ij) tangent(ij, kl) = P.entries[static_cast<std::size_t>(ij)].slope;
  }
  return tangent;
}

}  // namespace sandglass
