#include "choice/candidates.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "assembly/method_entry.hpp"
#include "choice/method_choices.hpp"

namespace sandglass {

const NodalField& CandidateMesh::farthest() const {
  const Displacements undeformed(reference.size(), NodalField(scene.mesh.points.size()));
  return reference[worst_time(reference, undeformed)];
}

std::string CandidateMesh::name() const {
  return (own() ? "own mesh" : difference) + (steps.empty() ? "" : ", " + steps);
}

std::vector<Candidate> make_candidates(const std::deque<CandidateMesh>& meshes, const CandidatePlan& plan) {
  std::vector<Candidate> candidates;
  const auto asked = [&](std::string_view method) {
    return plan.methods.empty() ||
           std::find(plan.methods.begin(), plan.methods.end(), method) != plan.methods.end();
  };
  for (const auto& mesh : meshes) {
    for (const MethodEntry& method : methods()) {
      if (!asked(method.name)) continue;
      MethodChoice plain{.method = std::string(method.name), .threads = plan.threads};
      if (const std::string_view why = unfit(method, mesh.scene.settings.quasi_static); !why.empty()) {
        if (mesh.own() && mesh.steps.empty()) candidates.push_back({plain, &mesh, std::string(why)});
        continue;
      }
      for (const auto precision : {Precision::double_precision, Precision::single_precision}) {
        plain.precision = precision;
        for (auto& choice :
             choices_of(method, plain, mesh.scene.materials.list.front().law, plan.tolerance)) {
          candidates.push_back({std::move(choice), &mesh});
        }
      }
    }
  }
  return candidates;
}

std::string name_of(const Candidate& candidate) {
  const auto& choice = candidate.choice;
  const std::string kappa = choice.kappa ? fmt::format(" kappa {:.3g}", *choice.kappa) : "";
  const std::string accuracy =
      method_named(choice.method).adapts() ? fmt::format(" accuracy {:.3g} %", 100.0 * choice.accuracy) : "";
  return fmt::format("{}{}{} {}", choice.method, kappa, accuracy, name_of(choice.precision));
}

}  // namespace sandglass
