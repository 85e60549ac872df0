#pragma once

#include <vector>

namespace sandglass {

/// The value below which a share `p` in [0, 1] of the samples lies, linear between neighbouring samples.
/// Throws std::invalid_argument without samples.
double quantile(std::vector<double> samples, double p);

/// A summary of samples in five figures.
struct Spread {
  double best;
  double lower_quartile;
  double median;
  double upper_quartile;
  double worst;
};

Spread spread_of(const std::vector<double>& samples);

}  // namespace sandglass
