#include "stability/cell.hpp"

#include "comparison/accuracy.hpp"

namespace sandglass {

namespace {

/// Whether a dynamic run fails only because its step is long.
bool is_unstable(const Trial& trial, const Answer& own, const Scene& scene, double limit, Answers& answers) {
  if (!trial.step || *trial.step <= *careful(trial).step) return false;
  const auto safe = answers.of(careful(trial));
  if (safe->failure) return false;
  if (own.failure) return true;
  return !(accuracy(own.u, safe->u, nullptr, unit_of(trial, scene, safe->u)).max_relative_error <= limit);
}

}  // namespace

Cell compute_cell(const Map& map, const Case& description, const std::string& method, double x, double y,
                  double limit, Answers& answers) {
  Cell cell{.method = method, .x = x, .y = y};
  const Trial trial = trial_of(map, description, method, x, y);
  const Answer own = compute(trial);
  cell.status = own.status;
  cell.steps = own.steps;
  cell.refused = own.refused;
  if (own.refused) return cell;
  const Scene scene = scene_of(trial);
  const double good = limit_of(trial, limit);
  cell.finding = own.failure;
  if (is_unstable(trial, own, scene, good, answers)) cell.finding = Finding::unstable;
  const auto golden = answers.of(golden_of(trial));
  cell.golden_failed = golden->failure || golden->refused;
  if (cell.golden_failed && !cell.finding) cell.status = "the golden fails: " + golden->status;
  if (cell.golden_failed || own.u.empty()) return cell;
  cell.symptoms = symptoms(scene, own.u.back(), own.energies.strain + own.energies.hourglass,
                           golden->u.back(), unit_of(trial, scene, golden->u));
  if (!cell.finding) cell.finding = diagnose(*cell.symptoms, good);
  return cell;
}

}  // namespace sandglass
