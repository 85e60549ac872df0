#pragma once

#include <atomic>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

#include "answer.hpp"

namespace sandglass {

/// A Kind<double> or a Kind<float>, used by one thread at a time.
template <template <class> class Kind>
class EitherPrecision : public NeverUnmade {
 public:
  /// `arguments` are those of Kind; `precision` is "double" or "float".
  template <class... Arguments>
  explicit EitherPrecision(const std::string& precision, const Arguments&... arguments)
      : held_(make(precision, arguments...)) {}

  template <class Real>
  explicit EitherPrecision(const Kind<Real>& original) : held_(std::make_unique<Kind<Real>>(original)) {}

  /// Returns `use(kind)`. Throws if another thread is using the object, which `name` stands for.
  template <class Use>
  auto with(const Use& use, const char* name = "simulation") {
    require_made(name);
    if (busy_.test_and_set())
      throw std::runtime_error("the " + std::string(name) + " is busy in another thread");
    const Release release{busy_};
    return std::visit([&](auto& held) { return use(*held); }, held_);
  }

 private:
  using Held = std::variant<std::unique_ptr<Kind<double>>, std::unique_ptr<Kind<float>>>;

  struct Release {
    std::atomic_flag& flag;
    ~Release() { flag.clear(); }
  };

  template <class... Arguments>
  static Held make(const std::string& precision, const Arguments&... arguments) {
    if (precision == "double") return std::make_unique<Kind<double>>(arguments...);
    if (precision == "float") return std::make_unique<Kind<float>>(arguments...);
    throw InputError("precision = '" + precision + "' must be 'double' or 'float'");
  }

  Held held_;
  std::atomic_flag busy_;
};

}  // namespace sandglass
