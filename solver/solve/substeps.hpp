#pragma once

#include <vector>

namespace sandglass {

/// The coefficients of p small steps in one large one, from stabilised Chebyshev polynomials. Velocities are
/// zero before step 0; in step k = 0, ..., p - 1 the change of a displacement is c := keep(k) c - gain(k)
/// dt^2 a. An acceleration -w^2 u leads to u = P(w^2 dt^2) u(0) with P(x) = T_p(d - x/q) / T_p(d), d = 1 +
/// nu/p^2 and q = 2 T_p'(d) / T_p(d), so that P(x) = 1 - x/2 + ... with nu = 0 they are leapfrog's.
class Substeps {
 public:
  /// Keeps |P| away from one, so that small nodes do not excite others by resonance: every step up to
  /// `share_of_large` of the large elements' stable step is then stable; see README.md.
  static constexpr double nu = 0.2;
  static constexpr double share_of_large = 0.9;

  explicit Substeps(int p);

  int count() const { return static_cast<int>(coefficients_.size()); }

  /// The stable large step over the stable step of the small elements.
  double reach() const { return reach_; }

  double keep(std::size_t k) const { return coefficients_[k].keep; }
  double gain(std::size_t k) const { return coefficients_[k].gain; }

  /// The share of the acceleration before step k in their mean, 2 (u(p) - u(0)) / dt^2.
  double weight(std::size_t k) const { return coefficients_[k].weight; }

 private:
  struct Coefficients {
    double keep, gain, weight;
  };
  std::vector<Coefficients> coefficients_;
  double reach_ = 1.0;
};

}  // namespace sandglass
