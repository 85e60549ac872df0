#pragma once

#include <memory>

#include "problem/model.hpp"

namespace sandglass {

/// The derivatives of the power of the elements' forces at given velocities, as if these were constant.
struct PowerDerivatives {
  std::vector<std::vector<double>> parameters;  ///< by those of each material's law; or empty
  std::vector<double> scales;  ///< by a factor of the stiffness of each element, at the factor one
};

/// Sums of such derivatives over states of a model, which is in double precision, must outlive this, and
/// whose forces depend on displacements alone. By parameters they are differences, for which the elements
/// exist once for each moved parameter: parameters are plain numbers in kernels.
class PowerDerivativeSum {
 public:
  /// `levels` are those of an adaptive method, else empty. Without `of_parameters` only stiffnesses of
  /// elements are considered.
  PowerDerivativeSum(const Model& model, const std::vector<double>& levels, bool of_parameters);

  /// Adds the derivatives at displacements u (m) and velocities v (m/s).
  void add(const Rows<double>& u, const Rows<double>& v);

  const PowerDerivatives& sum() const { return sum_; }

 private:
  /// The elements with some parameters moved, and what their powers contribute.
  struct Variant {
    std::unique_ptr<InternalForce<double>> elements;
    State<double> state;
    std::size_t parameter;        // its number in each law
    std::vector<double> weights;  // of each material, 1/unit; zero: no contribution
  };

  const Model& model_;
  State<double> state_;
  std::vector<Variant> variants_;
  std::vector<double> powers_;  // of each element, W
  PowerDerivatives sum_;
};

}  // namespace sandglass
