#include "solve/substeps.hpp"

#include <cmath>

namespace sandglass {

Substeps::Substeps(int p) : coefficients_(static_cast<std::size_t>(p), {0.0, 0.5, 1.0}) {
  if (p == 1) return;
  const double d = 1.0 + nu / (static_cast<double>(p) * p), angle = std::acosh(d);
  const auto T = [&](double k) { return std::cosh(k * angle); };  // T_k(d)
  const double q = 2.0 * p * std::sinh(p * angle) / std::sinh(angle) / T(p);
  reach_ = 0.5 * std::sqrt(q * (1.0 + d));  // w^2 dt^2 <= q (1 + d) keeps |P| <= 1
  for (std::size_t k = 0; k < coefficients_.size(); ++k) {
    const auto degree = static_cast<double>(k);
    const double once = 1.0 / (q * T(degree + 1.0));
    coefficients_[k].keep = k == 0 ? 0.0 : T(degree - 1.0) / T(degree + 1.0);
    coefficients_[k].gain = k == 0 ? once : 2.0 * T(degree) * once;
  }
  double moves = 0.0;  // the final displacement caused by a unit change in step k
  for (std::size_t k = coefficients_.size(); k-- > 0;) {
    moves = 1.0 + (k + 1 < coefficients_.size() ? coefficients_[k + 1].keep : 0.0) * moves;
    coefficients_[k].weight = 2.0 * coefficients_[k].gain * moves;
  }
}

}  // namespace sandglass
