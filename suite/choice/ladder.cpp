#include "choice/ladder.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "assembly/method_entry.hpp"
#include "choice/candidates.hpp"

namespace sandglass {

const NodalField& LadderMesh::farthest() const {
  const Displacements at_rest(reference.size(), NodalField(scene.mesh.points.size()));
  return reference[worst_time(reference, at_rest)];
}

std::string LadderMesh::name() const {
  return (own() ? "own mesh" : difference) + (steps.empty() ? "" : ", " + steps);
}

std::vector<Rung> make_ladder(const std::deque<LadderMesh>& meshes, const LadderPlan& plan) {
  std::vector<Rung> rungs;
  const auto asked = [&](std::string_view method) {
    return plan.methods.empty() ||
           std::find(plan.methods.begin(), plan.methods.end(), method) != plan.methods.end();
  };
  for (const auto& mesh : meshes) {
    for (const MethodEntry& method : methods()) {
      if (!asked(method.name)) continue;
      MethodChoice plain{.method = std::string(method.name), .threads = plan.threads};
      if (const std::string_view why = unfit(method, mesh.scene.settings.quasi_static); !why.empty()) {
        if (mesh.own() && mesh.steps.empty()) rungs.push_back({plain, &mesh, std::string(why)});
        continue;
      }
      for (const auto precision : {Precision::double_precision, Precision::single_precision}) {
        plain.precision = precision;
        for (auto& choice :
             choices_of(method, plain, mesh.scene.materials.list.front().law, plan.tolerance)) {
          rungs.push_back({std::move(choice), &mesh});
        }
      }
    }
  }
  return rungs;
}

std::string name_of(const Rung& rung) {
  const auto& choice = rung.choice;
  const std::string kappa = choice.kappa ? fmt::format(" kappa {:.3g}", *choice.kappa) : "";
  const std::string accuracy =
      method_named(choice.method).adapts() ? fmt::format(" accuracy {:.3g} %", 100.0 * choice.accuracy) : "";
  return fmt::format("{}{}{} {}", choice.method, kappa, accuracy, name_of(choice.precision));
}

}  // namespace sandglass
