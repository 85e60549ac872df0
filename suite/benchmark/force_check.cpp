#include "benchmark/force_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sandglass {

double relative_difference(const NodalField& f, const NodalField& reference) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (f.size() != reference.size()) return infinity;
  double difference = 0.0;
  double largest = 0.0;
  for (std::size_t n = 0; n < f.size(); ++n) {
    const Vector d{f[n][0] - reference[n][0], f[n][1] - reference[n][1], f[n][2] - reference[n][2]};
    // Component by component: std::hypot of three may return 0 if one of them is not a number.
    if (!std::isfinite(d[0]) || !std::isfinite(d[1]) || !std::isfinite(d[2])) return infinity;
    difference = std::max(difference, std::hypot(d[0], d[1], d[2]));
    largest = std::max(largest, std::hypot(reference[n][0], reference[n][1], reference[n][2]));
  }
  if (difference == 0.0) return 0.0;
  return largest > 0.0 ? difference / largest : infinity;
}

double force_limit(Precision precision, const AnyLaw& any_law) {
  const double ratio =
      std::visit([](const auto& law) { return law.bulk_modulus() / law.shear_modulus(); }, any_law);
  const double at_49 = precision == Precision::double_precision ? 1e-12 : 2e-5;
  return at_49 * std::max(1.0, ratio / 50.0);
}

std::string force_status(double difference, double limit) {
  if (difference < limit) return "ok";
  return fmt::format(
      "wrong result: forces differ from the method's in double precision by {:.2e} of the largest; "
      "must be below {:.2g}",
      difference, limit);
}

}  // namespace sandglass
