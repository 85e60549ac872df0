#pragma once

#include "element/hexahedron.hpp"
#include "material/tangent_bound.hpp"
#include "math/strain.hpp"

namespace sandglass {

/// The uniform strain hexahedron in the Total Lagrangian formulation: one stress from the mean displacement
/// gradient.
struct OnePoint {
  /// What is constant in time.
  template <class T>
  struct Element {
    NodalVectors<T> h;  ///< mean shape gradients, 1/m (paper, eq. 1)
    T V;                ///< reference volume, m^3
  };

  static Element<double> precompute(const NodalVectors<double>& X) {
    const MeanGradient mean = sandglass::mean_gradient(X);
    return {mean.h, mean.volume};
  }

  /// The mean displacement gradient H_ij = u_Ii h_Ij.
  template <class T>
  static Tensor<T> mean_gradient(const NodalVectors<T>& u, const Element<T>& element) {
    return transpose(u) * element.h;
  }

  /// Internal nodal forces (N) of the stress: f = V h P^T.
  template <class T, class Law>
  static NodalVectors<T> force(const NodalVectors<T>& /*u*/, const Tensor<T>& H, const Element<T>& element,
                               const Law& law) {
    const Tensor<T> P = law.piola(H);
    return element.h * (element.V * transpose(P));
  }

  /// Strain energy (J).
  template <class T, class Law>
  static T energy(const NodalVectors<T>& /*u*/, const Tensor<T>& H, const Element<T>& element,
                  const Law& law) {
    return element.V * law.energy(H);
  }

  /// The smallest volume ratio det F at the integration points.
  template <class T>
  static T smallest_jacobian(const NodalVectors<T>& /*u*/, const Tensor<T>& H,
                             const Element<T>& /*element*/) {
    return T(1) + jacobian_minus_one(H);
  }

  /// The element's volume over its reference volume, as this element sees it.
  template <class T>
  static T mean_jacobian(const NodalVectors<T>& u, const Tensor<T>& H, const Element<T>& element) {
    return smallest_jacobian(u, H, element);
  }

  /// An upper bound of the largest eigenvalue (N/m) of the tangent stiffness at u. With spatial gradients h_c
  /// = h F^-1 and L = v^T h_c: (tr L)^2 <= |h_c|^2 |v|^2 and |L|^2 <= g |v|^2, g the largest eigenvalue of
  /// h_c^T h_c. On a cube at rest it is the exact eigenvalue; paper's eq. 7 and 8 give (lambda + 2 mu) |h|^2
  /// instead.
  template <class T, class Law>
  static T stiffness_bound(const NodalVectors<T>& /*u*/, const Tensor<T>& H, const Element<T>& element,
                           const Law& law) {
    const auto bound = tangent_bound(law, H);
    return element.V * gradient_bound(bound, element.h * inverse(identity<T>() + H));
  }

  /// volumetric |g|^2 + gradient lambda_max(g^T g) for shape gradients g (1/m): what a tangent bound costs
  /// per volume.
  template <class T>
  static T gradient_bound(const TangentBound<T>& bound, const NodalVectors<T>& g) {
    const Tensor<T> G = transpose(g) * g;
    return max(bound.volumetric, T(0)) * trace(G) + bound.gradient * largest_eigenvalue_bound(G);
  }
};

}  // namespace sandglass
