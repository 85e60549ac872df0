#include "benchmark/rest.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "benchmark/statistics.hpp"
#include "comparison/accuracy.hpp"
#include "solve/relaxation.hpp"

namespace sandglass {

namespace {

constexpr int runs = 3;

/// One scene with one method, relaxed again and again.
class Subject final : private Observer {
 public:
  Subject(const Scene& scene, const MethodChoice& choice, const Proceed& proceed)
      : scene_(scene), model_(scene_, choice), proceed_(proceed) {}

  /// Relaxes until the case's own end, or for `most` evaluations.
  Relaxation run(std::optional<long> most = {}) {
    int& max_steps = scene_.settings.relaxation.max_steps;
    const int limit = max_steps;
    if (most) max_steps = static_cast<int>(*most);
    Relaxation found = relax(model_, *this);
    max_steps = limit;
    if (found.interrupted || !proceed_(share_)) throw ComputationError("bench: interrupted");
    return found;
  }

  /// Sets the share of the work done that is reported from now on.
  void show(double share) { share_ = share; }

  /// Distance from displacements `rest` after `evaluations`, over the unit of displacements.
  double error(long evaluations, const NodalField& rest) {
    return accuracy(run(evaluations).u, rest, nullptr, displacement_unit(scene_, rest)).max_relative_error;
  }

 private:
  bool proceed(long /*step*/, double /*share*/, double /*residual*/) override { return proceed_(share_); }

  Scene scene_;  // a copy, because the number of evaluations is a setting of the case
  Model model_;
  const Proceed& proceed_;
  double share_ = 0.0;
};

}  // namespace

long first_below(long last, double limit, const std::function<double(long)>& error) {
  long above = -1;
  while (last - above > 1) {
    const long middle = above + (last - above) / 2;
    (error(middle) < limit ? last : above) = middle;
  }
  return last;
}

RestRecord time_to_rest(const Scene& scene, const MethodChoice& choice, const Proceed& proceed) {
  RestRecord record{scene.settings.name, choice, "ok"};
  Subject subject(scene, choice, proceed);
  Relaxation rest;
  std::vector<double> seconds;
  for (int n = 0; n < runs; ++n) {
    subject.show(0.5 * n / runs);
    try {
      rest = subject.run();
    } catch (const ComputationError& error) {
      if (!proceed(0.0)) throw;
      const std::string_view text(error.what());
      record.status = fmt::format("failed: {}", text.substr(0, text.find('\n')));
      return record;
    }
    seconds.push_back(rest.seconds);
  }
  record.evaluations = rest.steps;
  record.residual = rest.residual;
  if (!in_equilibrium(rest)) {
    record.status = fmt::format("failed: {}", outcome(rest, choice.precision));
    return record;
  }
  const double median = quantile(seconds, 0.5);
  const auto seconds_until = [&](double limit, double share) {
    subject.show(share);
    const long evaluations =
        first_below(rest.steps, limit, [&](long most) { return subject.error(most, rest.u); });
    return median * static_cast<double>(evaluations) / static_cast<double>(rest.steps);
  };
  const double to_1_percent = seconds_until(1e-2, 0.5);
  record.times = {to_1_percent, seconds_until(1e-3, 0.75), median};
  return record;
}

std::string to_json(const Provenance& provenance, const std::vector<RestRecord>& records) {
  using Json = nlohmann::ordered_json;
  Json document;
  for (const auto& [name, value] : provenance) document[name] = value;
  document["records"] = Json::array();
  for (const auto& record : records) {
    const auto figure = [&](double RestTimes::*time) {
      return record.times ? Json((*record.times).*time) : Json(nullptr);
    };
    document["records"].push_back({{"case", record.case_name},
                                   {"method", record.choice.method},
                                   {"precision", name_of(record.choice.precision)},
                                   {"threads", record.choice.threads},
                                   {"status", record.status},
                                   {"evaluations", record.evaluations},
                                   {"seconds_to_1_percent", figure(&RestTimes::to_1_percent)},
                                   {"seconds_to_0_1_percent", figure(&RestTimes::to_0_1_percent)},
                                   {"seconds_to_rest", figure(&RestTimes::to_rest)},
                                   {"residual", record.residual}});
  }
  return document.dump(1) + "\n";
}

}  // namespace sandglass
