#include "app/run_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "comparison/comparison.hpp"
#include "comparison/verdict.hpp"

namespace sandglass {

namespace {

/// The references of a scene; one that belongs to another case is told, not fatal: a case may be edited and
/// run.
References references_to_show(const Scene& scene) {
  try {
    return read_references(scene);
  } catch (const InputError& error) {
    fmt::print(stderr, "note: not compared: {}\n", error.what());
    return {};
  }
}

}  // namespace

void print_energies(const Scene& scene, const HistoryRow& row) {
  fmt::print("energies (J): strain {:.6g}, hourglass {:.6g}", row.strain, row.hourglass);
  // In a relaxation part of the external work is damped away, so that there its sum tells nothing.
  if (!scene.description.quasi_static) {
    fmt::print(", kinetic {:.6g}, work of the imposed displacements {:.6g}", row.kinetic, row.external_work);
    if (row.adaption != 0.0) fmt::print(", brought by changes of levels {:.3g}", row.adaption);
  }
  fmt::print("\n");
}

void print_accuracy(const Scene& scene, const NodalField& u, bool on_own_mesh) {
  const References references = references_to_show(scene);
  const auto print = [&](const char* name, const std::optional<Displacements>& reference) {
    const auto figures = accuracy_of(scene, references.comparison, {u}, reference);
    if (!figures) return;
    fmt::print("against the {}: max {:.4g} %, rms {:.4g} % of the imposed displacement\n", name,
               100.0 * figures->max_relative_error, 100.0 * figures->rms_relative_error);
  };
  if (on_own_mesh) print("golden", references.golden);
  print("truth", references.truth);
}

void print_levels(const std::string& name, const std::vector<double>& levels, double share_of_time) {
  if (levels.empty()) return;
  std::string text;
  double level = 0.0;
  for (const auto& method : method_named(name).levels) {
    const auto count = static_cast<double>(std::count(levels.begin(), levels.end(), level++));
    text += fmt::format("{}{:.3g} % {}", text.empty() ? "" : ", ",
                        100.0 * count / static_cast<double>(levels.size()), method);
  }
  fmt::print("elements: {}; chosen in {:.2g} % of the time\n", text, 100.0 * share_of_time);
}

void print_time(double seconds, long steps, std::size_t elements, bool went_on, bool asleep) {
  if (went_on || asleep) {
    fmt::print("wall time {:.3g} s{}\n", seconds, went_on ? " since the checkpoint" : "");
    return;
  }
  fmt::print("wall time {:.3g} s, {:.4g} ns per element and step\n", seconds,
             1e9 * seconds / static_cast<double>(std::max(steps, 1L)) / static_cast<double>(elements));
}

void print_estimate(std::string_view against, const Scene& scene, double unit, double largest, double rms,
                    const std::string& how) {
  fmt::print("estimated error against {}: max {:.4g} %, rms {:.4g} % of the {} displacement, {}\n", against,
             100.0 * largest / unit, 100.0 * rms / unit, largest_imposed(scene) > 0.0 ? "imposed" : "largest",
             how);
}

void print_traffic(const Ranks& ranks) {
  const auto most = [&](long number) {
    return ranks.largest(static_cast<double>(number)) /
           static_cast<double>(std::max(ranks.traffic().exchanges, 1L));
  };
  const Ranks::Traffic traffic = ranks.traffic();
  fmt::print("{} ranks: {} exchanges, each of at most {:.3g} messages and {:.0f} bytes from a rank\n",
             ranks.count(), traffic.exchanges, most(traffic.messages), most(traffic.bytes));
}

}  // namespace sandglass
