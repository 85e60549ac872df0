#include "choice/choose_json.hpp"

#include <nlohmann/json.hpp>

#include "assembly/method_entry.hpp"
#include "benchmark/own_motion.hpp"

namespace sandglass {

namespace {

using Json = nlohmann::ordered_json;

template <class Value>
Json or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json to_record(const Attempt& attempt) {
  const auto& [candidate, cost, evaluation, outcome] = attempt;
  return {{"rung", name_of(candidate)},
          {"method", candidate.choice.method},
          {"kappa", or_null(candidate.choice.kappa)},
          {"accuracy",
           method_named(candidate.choice.method).adapts() ? Json(candidate.choice.accuracy) : Json(nullptr)},
          {"precision", name_of(candidate.choice.precision)},
          {"mesh", candidate.mesh->name()},
          {"elements", candidate.mesh->scene.mesh.cells.size()},
          {"seconds", cost ? Json(cost->seconds) : Json(nullptr)},
          {"check_seconds_per_step", cost ? Json(cost->checks) : Json(nullptr)},
          {"step_size", cost ? or_null(cost->mean_step) : Json(nullptr)},
          {"step_remark", cost ? cost->remark : ""},
          {"seconds_per_simulated_second", cost ? or_null(cost->per_simulated_second()) : Json(nullptr)},
          {"run_seconds_per_simulated_second", or_null(evaluation.per_simulated_second)},
          {"error", or_null(evaluation.error)},
          {"smallest_jacobian", or_null(evaluation.smallest_jacobian)},
          {"outcome", name_of(outcome)},
          {"reason", evaluation.reason}};
}

}  // namespace

std::string to_json(const Provenance& provenance, const Scene& scene, const Choice& choice) {
  Json document;
  for (const auto& [name, value] : provenance) document[name] = value;
  const Demand& demand = choice.demand;
  document["case"] = scene.settings.name;
  document["tolerance"] = demand.tolerance;
  document["real_time"] = demand.real_time;
  document["budget_seconds"] = or_null(demand.budget);
  document["threads"] = demand.threads;
  document["reference"] = {{"name", choice.reference.name},
                           {"own_error", or_null(choice.reference.own.largest)},
                           {"note", choice.reference.own.note}};
  document["answers_per_second"] = answers_per_second;
  const DynamicsSettings motion = in_own_motion(scene).settings.dynamics;
  document["own_motion"] = {{"duration", motion.duration}, {"damping", motion.damping}};
  document["chosen"] = or_null(choice.chosen);
  document["remarks"] = remarks(choice);
  document["other_meshes"] = Json::array();
  for (const auto& [mesh, evaluation, kept] : choice.others) {
    document["other_meshes"].push_back({{"mesh", mesh},
                                        {"error", or_null(evaluation.error)},
                                        {"kept", kept},
                                        {"reason", evaluation.reason}});
  }
  document["rungs"] = Json::array();
  for (const auto& attempt : choice.attempts) document["rungs"].push_back(to_record(attempt));
  return document.dump(1) + "\n";
}

}  // namespace sandglass
