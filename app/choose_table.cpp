#include "app/choose_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "app/wrapped_text.hpp"

namespace sandglass {

namespace {

std::string line(const std::string& text, std::size_t indent = 2) {
  return wrapped(text, indent) + "\n";
}

std::string number_or_dash(const std::optional<double>& value, double factor = 1.0) {
  return value ? fmt::format("{:.3g}", factor * *value) : "-";
}

/// The number of a mesh in the table, from 1.
std::size_t number_of(const CandidateMesh& mesh, const Choice& choice) {
  const auto is = [&](const CandidateMesh& other) { return &other == &mesh; };
  const auto found = std::find_if(choice.meshes.begin(), choice.meshes.end(), is);
  return static_cast<std::size_t>(found - choice.meshes.begin()) + 1;
}

std::string head_text(const Scene& scene, const Choice& choice) {
  const Demand& demand = choice.demand;
  std::string text = line(
      fmt::format("{}: at most {} of the imposed displacement from the {}{}, at every node{}{}",
                  scene.settings.name, percentage(demand.tolerance), choice.reference.name,
                  demand.against.empty() ? " element's answer on the same mesh" : "",
                  demand.real_time ? ", in real time" : "",
                  demand.budget ? fmt::format(", {:.3g} ms a step or answer", 1e3 * *demand.budget) : ""));
  return text +
         line(fmt::format("us/step: median of a step, or of a condensed answer, on this machine with {} "
                          "thread{}; s/sim. s: wall time of a simulated second at the mean step of the "
                          "case's own motion, or of {:.0f} condensed answers, as in a real-time loop; rows "
                          "are sorted by it; run s: the same, measured in the run of a motion",
                          demand.threads, demand.threads == 1 ? "" : "s", answers_per_second));
}

/// The numbered meshes, and those rejected for every method.
std::string meshes_text(const Choice& choice) {
  std::string text;
  const auto add = [&](const std::string& number, const std::string& name, const Evaluation& evaluation) {
    text += line(fmt::format("mesh {}: {}{}{}", number, name,
                             evaluation.error ? fmt::format("; the golden's element is {} off on it",
                                                            percentage(*evaluation.error))
                                              : "",
                             evaluation.reason.empty() ? "" : "; rejected: " + evaluation.reason),
                 4);
  };
  for (const auto& mesh : choice.meshes) {
    const auto is = [&](const MeshAttempt& attempt) { return attempt.kept && attempt.mesh == mesh.name(); };
    const auto found = std::find_if(choice.others.begin(), choice.others.end(), is);
    add(fmt::to_string(number_of(mesh, choice)), mesh.name(),
        found == choice.others.end() ? Evaluation{} : found->evaluation);
  }
  for (const auto& [mesh, evaluation, kept] : choice.others) {
    if (!kept) add("-", mesh, evaluation);
  }
  const MeshSource& source = choice.meshes.front().problem.description.mesh;
  if (!std::holds_alternative<AnyGenerator>(source)) {
    text +=
        fmt::format("the mesh {}: no coarser one was tried\n",
                    std::holds_alternative<MeshFile>(source) ? "comes from a file" : "has several bodies");
  }
  return text;
}

std::string row_text(const Attempt& attempt, const Choice& choice) {
  const auto& [candidate, cost, evaluation, outcome] = attempt;
  return fmt::format(
      "{} {:<44}{:>4}{:>9}{:>9}{:>9}{:>8}{:>9}{:>6}\n", outcome == Outcome::chosen ? '>' : ' ',
      name_of(candidate), number_of(*candidate.mesh, choice),
      cost ? fmt::format("{:.3g}", 1e6 * cost->seconds) : "-",
      number_or_dash(cost ? cost->mean_step : std::nullopt, 1e3),
      number_or_dash(cost ? cost->per_simulated_second() : std::nullopt),
      evaluation.per_simulated_second ? fmt::format("{:.2g}", *evaluation.per_simulated_second) : "-",
      number_or_dash(evaluation.error, 100.0),
      evaluation.smallest_jacobian ? fmt::format("{:.2g}", *evaluation.smallest_jacobian) : "-");
}

/// Candidates rejected for the same kind of reason.
struct Rejected {
  std::string kind;
  std::vector<const Attempt*> attempts;
};

/// A reason begins with its kind; figures follow.
std::string kind_of(const std::string& reason) {
  return reason.substr(0, reason.find_first_of(":;,"));
}

std::vector<Rejected> rejected(const Choice& choice) {
  std::vector<Rejected> kinds;
  for (const auto& attempt : choice.attempts) {
    if (attempt.outcome != Outcome::refused) continue;
    const std::string kind = kind_of(attempt.evaluation.reason);
    auto found = std::find_if(kinds.begin(), kinds.end(), [&](const Rejected& r) { return r.kind == kind; });
    if (found == kinds.end()) found = kinds.insert(kinds.end(), {kind, {}});
    found->attempts.push_back(&attempt);
  }
  return kinds;
}

/// "12 rejected: inaccurate: tl-perturbation, tl-perturbation kappa 0.013; error 2.39 to 7.47 %".
std::string summary(const Rejected& group) {
  std::vector<std::string> methods;
  std::vector<double> errors;
  for (const Attempt* attempt : group.attempts) {
    const auto& choice = attempt->candidate.choice;
    const std::string method =
        choice.kappa ? fmt::format("{} kappa {:.2g}", choice.method, *choice.kappa) : choice.method;
    if (std::find(methods.begin(), methods.end(), method) == methods.end()) methods.push_back(method);
    if (attempt->evaluation.error) errors.push_back(*attempt->evaluation.error);
  }
  std::string text =
      fmt::format("{} rejected: {}: {}", group.attempts.size(), group.kind, fmt::join(methods, ", "));
  if (!errors.empty()) {
    const auto [least, most] = std::minmax_element(errors.begin(), errors.end());
    const std::string low = percentage(*least), high = percentage(*most);
    text += low == high ? "; error " + low : fmt::format("; error {:.3g} to {}", 100.0 * *least, high);
  }
  return line(text, 4);
}

std::string candidates_text(const Choice& choice) {
  std::string text = fmt::format("  {:<44}{:>4}{:>9}{:>9}{:>9}{:>8}{:>9}{:>6}\n", "method and numbers",
                                 "mesh", "us/step", "step ms", "s/sim. s", "run s", "error %", "det F");
  for (const auto& attempt : choice.attempts) {
    if (attempt.outcome == Outcome::chosen || attempt.outcome == Outcome::sufficient) {
      text += row_text(attempt, choice);
    }
  }
  if (!choice.chosen) text += "  none suffices\n";
  for (const auto& group : rejected(choice)) {
    text += summary(group);
    if (!choice.demand.all) continue;
    for (const Attempt* attempt : group.attempts) text += row_text(*attempt, choice);
  }
  const auto not_tried = std::count_if(choice.attempts.begin(), choice.attempts.end(),
                                       [](const Attempt& a) { return a.outcome == Outcome::not_tried; });
  if (not_tried > 0) {
    text += fmt::format("{} costlier ones were not tried; --all tries them and lists the rejected ones\n",
                        not_tried);
  } else if (!choice.demand.all) {
    text += "--all lists the rejected ones\n";
  }
  return text;
}

}  // namespace

std::string choose_table(const Scene& scene, const Choice& choice) {
  std::string text = head_text(scene, choice) + meshes_text(choice) + candidates_text(choice);
  for (const auto& remark : remarks(choice)) text += line("note: " + remark);
  if (!choice.chosen) return text;
  const Attempt& chosen = choice.attempts[*choice.chosen];
  if (!chosen.cost->remark.empty()) text += line("note: " + chosen.cost->remark);
  const bool itself = *chosen.evaluation.error == 0.0;
  return text + line(fmt::format("choose {}, {}: {} at most{}, {} s for a simulated second",
                                 name_of(chosen.candidate), chosen.candidate.mesh->name(),
                                 percentage(*chosen.evaluation.error),
                                 itself ? ", as it is the reference itself" : "",
                                 number_or_dash(chosen.cost->per_simulated_second())));
}

}  // namespace sandglass
