#pragma once

#include <stdexcept>
#include <string>

namespace sandglass {

/// The user's input breaks a rule: bad usage, file, key or value. The command line exits with 2.
/// The text names the file or key, the value, the rule and what is allowed.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// How a computation broke down, if known.
enum class Breakdown { other, inverted, not_finite, no_balance };

/// The computation failed: it diverged, an element inverted, or it was interrupted. The command line exits
/// with 3. The text names the step, the element and a remedy.
class ComputationError : public std::runtime_error {
 public:
  /// An error with its message.
  explicit ComputationError(const std::string& text, Breakdown breakdown = Breakdown::other)
      : std::runtime_error(text), breakdown_(breakdown) {}

  /// How the computation broke down.
  Breakdown breakdown() const { return breakdown_; }

 private:
  Breakdown breakdown_;
};

}  // namespace sandglass
