#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/ranks.hpp"
#include "problem/model.hpp"

namespace sandglass {

/// The options of `sandglass run`, as they are written.
struct RunOptions {
  std::string name;
  std::optional<std::string> method = {};
  std::optional<std::string> kappa = {};
  std::optional<std::string> kappa_modulus = {};
  std::optional<std::string> precision = {};
  std::optional<std::string> accuracy = {};
  std::optional<std::string> sleep = {};
  int threads = 1;
  std::string device = "cpu";
  std::shared_ptr<const Ranks> ranks;
  std::string output;
  std::string checkpoint;
  double checkpoint_every = 60.0;
  std::string estimate;
  std::string against;
  bool describe = false;
};

/// The options that were given.
struct Given {
  std::optional<Precision> precision;
  std::optional<std::optional<double>> kappa;
  std::optional<KappaModulus> kappa_modulus;
  std::optional<double> accuracy;
  std::optional<double> sleep;
};

/// The options in their own types. Throws InputError, which names the option, for one that is not valid.
Given parse(const RunOptions& options);

/// The method of the options, completed by the case's [method]. The case's kappa belongs to the case's own
/// method, and is ignored if an option names another.
MethodChoice choose_method(const RunOptions& options, const Given& given, const CaseSettings& settings);

/// Throws InputError for options that exclude each other.
void require_sensible(const RunOptions& options);

/// Throws InputError for options that the case does not support: those for quasi-static cases if it is a
/// motion, estimates if it has friction, and refined meshes if it has a [[contact]].
void require_supported(const RunOptions& options, const Scene& scene);

/// Throws InputError unless the output files can be written; a run never overwrites its own input.
void require_places(const RunOptions& options, const CaseSettings& settings);

}  // namespace sandglass
