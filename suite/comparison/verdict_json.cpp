#include "comparison/verdict_json.hpp"

#include <nlohmann/json.hpp>

namespace sandglass {

namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json to_record(const std::optional<Accuracy>& accuracy) {
  if (!accuracy) return nullptr;
  return {{"max_relative_error", accuracy->max_relative_error},
          {"profile_relative_error", or_null(accuracy->profile_relative_error)},
          {"rms_relative_error", accuracy->rms_relative_error}};
}

Json to_record(const std::optional<Symptoms>& symptoms) {
  if (!symptoms) return nullptr;
  return {{"zigzag_share", symptoms->zigzag_share},
          {"bending_ratio", symptoms->bending_ratio},
          {"stiffness_ratio", symptoms->stiffness_ratio}};
}

/// The three kinds of cost; unknown and inapplicable figures are null.
void add_cost(Json& record, const Verdict& verdict) {
  const auto& search = verdict.search;
  const auto& motion = verdict.motion;
  const auto& cost = verdict.step_cost;
  const auto ns = [&](double StepCost::*seconds) {
    return cost && !cost->condensed ? Json(1e9 * (*cost).*seconds / static_cast<double>(verdict.elements))
                                    : Json(nullptr);
  };
  record["ns_per_element_step"] = ns(&StepCost::seconds);
  record["ns_lower_quartile"] = ns(&StepCost::lower_quartile);
  record["ns_upper_quartile"] = ns(&StepCost::upper_quartile);
  record["check_ns_per_element_step"] = ns(&StepCost::checks);
  record["mean_step_seconds"] = cost ? or_null(cost->mean_step) : Json(nullptr);
  record["step_remark"] = cost ? cost->remark : "";
  record["seconds_per_simulated_second"] = cost ? or_null(cost->per_simulated_second()) : Json(nullptr);
  record["equilibrium_seconds"] = search ? Json(search->seconds) : Json(nullptr);
  record["evaluations"] = search ? Json(search->evaluations) : Json(nullptr);
  record["motion_seconds"] = motion ? Json(motion->seconds) : Json(nullptr);
  record["steps"] = motion ? Json(motion->steps) : Json(nullptr);
}

Json to_record(const Verdict& verdict) {
  Json record{{"case", verdict.case_name},
              {"method", verdict.method},
              {"kappa", or_null(verdict.kappa)},
              {"kappa_is_auto", verdict.kappa_is_auto},
              {"precision", verdict.precision},
              {"status", verdict.status},
              {"finding", verdict.finding ? Json(name_of(*verdict.finding)) : Json(nullptr)},
              {"symptoms", to_record(verdict.symptoms)},
              {"golden", to_record(verdict.golden)},
              {"truth", to_record(verdict.truth)},
              {"operations", verdict.operations},
              {"load_in_steps", verdict.load_in_steps.empty() ? Json(nullptr) : Json(verdict.load_in_steps)},
              {"stable_step", verdict.stable_step},
              {"residual", verdict.residual},
              {"hourglass_energy_ratio", verdict.hourglass_energy_ratio}};
  add_cost(record, verdict);
  if (verdict.mean_dilatation) record["twin"] = to_record(verdict.mean_dilatation);
  return record;
}

Json to_record(const ProgramValues& found) {
  return {{"program", found.program},
          {"elements", found.elements},
          {"values", found.values},
          {"source", found.source}};
}

Json to_record(const PublishedResult& result) {
  const auto& published = result.published;
  Json programs = Json::array();
  for (const auto& program : published.programs) programs.push_back(to_record(program));
  return {{"set", published.set},
          {"component", published.component},
          {"source", published.source},
          {"published", published.value},
          {"computed", or_null(result.computed)},
          {"ratio", or_null(result.ratio())},
          {"scatter", or_null(published.scatter)},
          {"of", published.obstacles.empty() ? words_of(published.of)[static_cast<std::size_t>(published.of)]
                                             : std::string_view("force")},
          {"golden", or_null(result.golden)},
          {"truth", or_null(result.truth)},
          {"ratio_to_truth", or_null(result.ratio_to_truth())},
          {"programs", std::move(programs)}};
}

Json to_record(const LimitCheck& check) {
  return {{"case", check.case_name},
          {"method", check.expectation.method},
          {"kappa", check.expectation.kappa},
          {"reference", check.expectation.reference},
          {"figure", check.expectation.figure},
          {"below", or_null(check.expectation.below)},
          {"above", or_null(check.expectation.above)},
          {"found", or_null(check.figure)},
          {"at_kappa", or_null(check.kappa)},
          {"holds", check.holds},
          {"reason", check.expectation.reason}};
}

template <class Entry>
Json to_records(const std::vector<Entry>& entries) {
  Json records = Json::array();
  for (const auto& entry : entries) records.push_back(to_record(entry));
  return records;
}

Json to_published_record(const Verdict& verdict) {
  Json record = to_record(verdict);
  record["family"] = verdict.family;
  record["variants"] = verdict.variants;
  record["values"] = to_records(verdict.published);
  return record;
}

}  // namespace

std::string to_json(const Provenance& provenance, const std::vector<Verdict>& verdicts,
                    const std::vector<LimitCheck>& limits) {
  Json document;
  for (const auto& [name, value] : provenance) document[name] = value;
  document["records"] = Json::array();
  document["published"] = Json::array();
  for (const auto& verdict : verdicts) {
    if (verdict.published.empty()) {
      document["records"].push_back(to_record(verdict));
    } else {
      document["published"].push_back(to_published_record(verdict));
    }
  }
  document["limits"] = to_records(limits);
  return document.dump(1) + "\n";
}

}  // namespace sandglass
