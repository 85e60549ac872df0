#include "benchmark/bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>

#include "assembly/method_entry.hpp"
#include "assembly/processor.hpp"
#include "base/memory.hpp"
#include "benchmark/condensed_model.hpp"
#include "benchmark/cost.hpp"
#include "benchmark/force_check.hpp"
#include "benchmark/stepped_model.hpp"
#include "solve/resident.hpp"

namespace sandglass {

namespace {

/// The motion of a method; null if there is none or it fails.
const OwnMotion* motion_of(const OwnMotions& motions, const std::string& method) {
  const auto found = motions.find(method);
  return found != motions.end() && found->second.mean_step ? &found->second : nullptr;
}

Speed speed_of(const Timing& timing, const BenchRecord& record, const Scene& scene, const OwnMotion* motion,
               double memory_gbs) {
  const auto elements = static_cast<double>(record.elements);
  Speed speed{};
  speed.ns = spread_of(timing.seconds_per_step);
  for (double* figure : {&speed.ns.best, &speed.ns.lower_quartile, &speed.ns.median, &speed.ns.upper_quartile,
                         &speed.ns.worst}) {
    *figure *= 1e9 / elements;
  }
  speed.check_ns = 1e9 * checks_per_step(timing, scene, motion) / elements;
  speed.p50_us = 1e6 * quantile(timing.seconds_of_a_step, 0.5);
  speed.p99_us = 1e6 * quantile(timing.seconds_of_a_step, 0.99);
  speed.max_us = 1e6 * quantile(timing.seconds_of_a_step, 1.0);
  speed.steps = static_cast<long>(timing.seconds_of_a_step.size());
  speed.gflops = record.work.operations / speed.ns.median;
  speed.peak_share = speed.gflops / record.ceiling.gflops;
  speed.gbs = record.work.bytes / speed.ns.median;
  speed.memory_share = speed.gbs / memory_gbs;
  speed.roofline_fraction = roofline_fraction(record.work, record.ceiling, speed.ns.median);
  return speed;
}

/// The forces with which all variants of a method must agree: the scalar kernel's, if there is one.
NodalField reference_forces(const Scene& scene, const std::string& method) {
  const auto kernel = has_scalar_kernels() ? KernelWidth::scalar : KernelWidth::pack;
  return make_stepped_model(scene, {.method = method, .kernel = kernel})->forces();
}

/// Variants that are held in memory at the same time.
struct Group {
  std::deque<std::unique_ptr<SteppedModel>> models;
  std::vector<BenchRecord> records;
};

/// Makes models from `next` on, as many as fit into memory, at least one.
Group make_group(const Scene& scene, const OwnMotions& motions, const std::vector<MethodChoice>& variants,
                 std::size_t& next) {
  const std::size_t elements = scene.mesh.cells.size(), nodes = scene.mesh.points.size();
  const double room = 0.5 * static_cast<double>(available_memory());
  double taken = 0.0;
  Group group;
  for (; next < variants.size(); ++next) {
    const MethodChoice& choice = variants[next];
    // The size of the previous model, since this one is not made yet; variants of a method are neighbours.
    const double model = group.records.empty() ? 0.0 : group.records.back().work.bytes;
    if (taken + 2.0 * model * static_cast<double>(elements) > room) break;
    const OwnMotion* motion = motion_of(motions, choice.method);
    group.models.push_back(make_stepped_model(scene, choice, motion));
    BenchRecord record{scene.settings.name, elements, nodes, choice, {}, 0.0, 0.0, {}, {}, {}, {}};
    const SteppedModel& made = *group.models.back();
    record.force_limit = force_limit(choice.precision, scene.materials.list.front().law);
    record.work = made.work();
    if (motion != nullptr) record.mean_step = motion->mean_step;
    taken += record.work.bytes * static_cast<double>(elements);
    group.records.push_back(std::move(record));
  }
  return group;
}

/// Removes variants that the device refuses, or that would take too long to set up, from the list, and makes
/// their records.
std::vector<BenchRecord> leave_out(const Scene& scene, std::vector<MethodChoice>& variants) {
  const std::size_t elements = scene.mesh.cells.size(), nodes = scene.mesh.points.size();
  std::vector<BenchRecord> records;
  std::erase_if(variants, [&](const MethodChoice& choice) {
    std::string why = choice.processor ? choice.processor->refusal(scene.materials, choice) : "";
    if (const auto reason = why_not_resident(scene); choice.processor && why.empty() && !reason.empty())
      why = fmt::format("the state cannot stay on the device: {}", reason);
    if (method_named(choice.method).is_condensed && nodes > most_condensed_nodes) {
      why = fmt::format("factorising {} nodes takes too long; at most {} are timed", nodes,
                        most_condensed_nodes);
    }
    if (why.empty()) return false;
    why.insert(0, "left out: ");
    records.push_back({scene.settings.name, elements, nodes, choice, why, 0.0, 0.0, {}, {}, {}, {}});
    return true;
  });
  return records;
}

/// Whether two records differ only in the method, or only in kernel and precision.
bool same_numbers(const MethodChoice& a, const MethodChoice& b) {
  return kernel_name(a) == kernel_name(b) && a.precision == b.precision && a.threads == b.threads;
}
bool same_method(const MethodChoice& a, const MethodChoice& b) {
  return a.method == b.method && a.threads == b.threads;
}

}  // namespace

bool is_wrong(const BenchRecord& record) {
  return record.status.starts_with("wrong");
}

bool is_disturbed(const BenchRecord& record) {
  return record.speed && record.speed->ns.upper_quartile > most_spread * record.speed->ns.lower_quartile;
}

std::string_view kernel_name(const MethodChoice& choice) {
  if (choice.processor != nullptr) return "device";
  return choice.kernel == KernelWidth::pack ? "pack" : "scalar";
}

std::vector<MethodChoice> variants_of(const BenchPlan& plan) {
  std::vector<MethodChoice> variants;
  for (const int threads : plan.threads) {
    for (const auto& method : plan.methods) {
      for (const Precision precision : plan.precisions) {
        variants.push_back({.method = method, .precision = precision, .threads = threads});
      }
      if (has_scalar_kernels()) {
        variants.push_back({.method = method, .threads = threads, .kernel = KernelWidth::scalar});
      }
      if (plan.processor == nullptr || threads != plan.threads.front()) continue;
      for (const Precision precision : plan.precisions)
        variants.push_back({.method = method, .precision = precision, .processor = plan.processor});
    }
  }
  return variants;
}

std::optional<double> BenchRecord::per_simulated_second() const {
  if (!speed || !mean_step) return std::nullopt;
  return 1e-9 * (speed->ns.median + speed->check_ns) * static_cast<double>(elements) / *mean_step;
}

OwnMotions follow_own_motions(const Scene& scene, const std::vector<std::string>& methods,
                              const Proceed& proceed) {
  OwnMotions motions;
  for (const auto& method : methods) {
    if (method_named(method).is_condensed) continue;
    motions[method] = follow_own_motion(scene, {.method = method}, proceed);
  }
  return motions;
}

std::vector<BenchRecord> bench(const Scene& scene, const OwnMotions& motions, const BenchPlan& plan,
                               MachineSpeed& machine, const Proceed& proceed) {
  auto variants = variants_of(plan);
  std::vector<BenchRecord> records = leave_out(scene, variants);
  std::map<std::string, NodalField> references;
  for (const auto& choice : variants) {
    if (!references.contains(choice.method)) {
      references[choice.method] = reference_forces(scene, choice.method);
    }
  }
  for (std::size_t next = 0; next < variants.size();) {
    const std::size_t first = next;
    Group group = make_group(scene, motions, variants, next);
    std::vector<Entry> entries;
    for (std::size_t n = 0; n < group.models.size(); ++n) {
      BenchRecord& record = group.records[n];
      const auto working_set =
          static_cast<std::size_t>(record.work.bytes * static_cast<double>(record.elements));
      record.ceiling = machine.ceiling(record.choice.precision, record.choice.threads, working_set);
      entries.push_back({group.models[n].get(), &references[record.choice.method], record.force_limit,
                         record.choice.threads});
    }
    const auto share = [&](double of_group) {
      return proceed((static_cast<double>(first) + of_group * static_cast<double>(next - first)) /
                     static_cast<double>(variants.size()));
    };
    const auto timings = measure(entries, plan.settings, share);
    machine.measure_again();
    for (std::size_t n = 0; n < timings.size(); ++n) {
      BenchRecord& record = group.records[n];
      const int threads = record.choice.threads;
      const auto working_set =
          static_cast<std::size_t>(record.work.bytes * static_cast<double>(record.elements));
      record.ceiling = machine.ceiling(record.choice.precision, threads, working_set);
      record.status = timings[n].status;
      record.force_difference = timings[n].force_difference;
      if (record.status == "ok") {
        record.speed = speed_of(timings[n], record, scene, motion_of(motions, record.choice.method),
                                machine.memory_gbs(threads));
      }
      records.push_back(std::move(record));
    }
  }
  compare_among_each_other(records);
  return records;
}

void compare_among_each_other(std::vector<BenchRecord>& records) {
  for (auto& record : records) {
    if (!record.speed) continue;
    for (const auto& other : records) {
      if (!other.speed || other.case_name != record.case_name || other.elements != record.elements) continue;
      const double ratio = record.speed->ns.median / other.speed->ns.median;
      if (other.choice.method == "tl-perturbation" && same_numbers(record.choice, other.choice)) {
        record.speed->to_tl_perturbation = ratio;
      }
      if (other.choice.kernel == KernelWidth::scalar && same_method(record.choice, other.choice)) {
        record.speed->speedup = 1.0 / ratio;
      }
    }
  }
}

}  // namespace sandglass
