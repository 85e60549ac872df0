#include "benchmark/bench_json.hpp"

#include <fmt/format.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "assembly/processor.hpp"

namespace sandglass {

namespace {

using Json = nlohmann::ordered_json;

Json or_null(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json to_record(const BenchRecord& record) {
  const auto& choice = record.choice;
  const auto figure = [&](const std::function<std::optional<double>(const Speed&)>& of) {
    return record.speed ? or_null(of(*record.speed)) : Json(nullptr);
  };
  return {{"case", record.case_name},
          {"elements", record.elements},
          {"nodes", record.nodes},
          {"method", choice.method},
          {"kernel", kernel_name(choice)},
          {"precision", name_of(choice.precision)},
          {"threads", choice.threads},
          {"status", record.status},
          // JSON has no infinity: the difference of forces that are not finite is null.
          {"force_difference", record.force_difference},
          {"force_limit", record.force_limit},
          {"ns_per_element_step", figure([](const Speed& s) { return s.ns.median; })},
          {"ns_best", figure([](const Speed& s) { return s.ns.best; })},
          {"ns_lower_quartile", figure([](const Speed& s) { return s.ns.lower_quartile; })},
          {"ns_upper_quartile", figure([](const Speed& s) { return s.ns.upper_quartile; })},
          {"ratio_to_tl_perturbation", figure([](const Speed& s) { return s.to_tl_perturbation; })},
          {"speedup_over_scalar_double", figure([](const Speed& s) { return s.speedup; })},
          {"check_ns_per_element_step", figure([](const Speed& s) { return s.check_ns; })},
          {"mean_step_seconds", or_null(record.mean_step)},
          {"seconds_per_simulated_second", or_null(record.per_simulated_second())},
          {"step_p50_us", figure([](const Speed& s) { return s.p50_us; })},
          {"step_p99_us", figure([](const Speed& s) { return s.p99_us; })},
          {"step_max_us", figure([](const Speed& s) { return s.max_us; })},
          {"steps_timed", record.speed ? Json(record.speed->steps) : Json(nullptr)},
          {"operations_per_element_step", record.work.operations},
          {"bytes_per_element_step", record.work.bytes},
          {"gflops", figure([](const Speed& s) { return s.gflops; })},
          {"fraction_of_peak", figure([](const Speed& s) { return s.peak_share; })},
          {"gbs", figure([](const Speed& s) { return s.gbs; })},
          {"fraction_of_bandwidth", figure([](const Speed& s) { return s.memory_share; })},
          {"stream_gbs_at_working_set", record.ceiling.gbs},
          {"roofline_fraction", figure([](const Speed& s) { return s.roofline_fraction; })}};
}

}  // namespace

std::string to_json(const Provenance& provenance, const BenchPlan& plan, MachineSpeed& machine,
                    const std::vector<BenchRecord>& records) {
  Json document;
  for (const auto& [name, value] : provenance) document[name] = value;
  document["machine"] = {{"processors", available_processors()},
                         {"last_level_cache_bytes", last_level_cache()}};
  if (plan.processor != nullptr) document["device"] = plan.processor->name();
  document["repetitions"] = plan.settings.repetitions;
  for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
    for (const int threads : plan.threads) {
      document["peak_gflops"][std::string(name_of(precision))][fmt::to_string(threads)] =
          machine.peak_gflops(precision, threads);
    }
  }
  for (const int threads : plan.threads) {
    document["bandwidth_gbs"][fmt::to_string(threads)] = machine.memory_gbs(threads);
  }
  document["records"] = Json::array();
  for (const auto& record : records) document["records"].push_back(to_record(record));
  return document.dump(1) + "\n";
}

}  // namespace sandglass
