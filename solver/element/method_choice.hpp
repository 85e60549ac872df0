#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "base/ranks.hpp"
#include "element/hourglass_settings.hpp"

namespace sandglass {

/// The number type of a run.
enum class Precision { double_precision, single_precision };

/// "double" or "float".
constexpr std::string_view name_of(Precision precision) {
  return precision == Precision::double_precision ? "double" : "float";
}

/// How many elements a kernel computes at a time: as many as a register holds, or one, for comparison.
enum class KernelWidth { pack, scalar };

/// The default accuracy of adaptive methods.
inline constexpr double default_accuracy = 0.003;

class Processor;

/// The user's choices in addition to the case.
struct MethodChoice {
  std::string method;
  std::optional<double> kappa = {};  ///< none means auto
  Precision precision = Precision::double_precision;
  int threads = 1;
  std::shared_ptr<const Ranks> ranks = std::make_shared<const Ranks>();
  KernelWidth kernel = KernelWidth::pack;
  KappaModulus kappa_modulus = KappaModulus::p_wave;
  double accuracy = default_accuracy;  ///< of an adaptive method: displacement error over the largest imposed
  std::shared_ptr<const Processor> processor = nullptr;  ///< that computes forces; none: this one
};

}  // namespace sandglass
