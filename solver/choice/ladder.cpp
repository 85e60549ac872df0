#include "choice/ladder.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "choice/candidates.hpp"
#include "mesh/variations.hpp"

namespace sandglass {

std::string LadderMesh::name() const {
  return coarser ? counts_text(*coarser) : "own mesh";
}

std::vector<Rung> make_ladder(const std::deque<LadderMesh>& meshes, const LadderPlan& plan) {
  std::vector<Rung> rungs;
  const auto asked = [&](std::string_view method) {
    return plan.methods.empty() ||
           std::find(plan.methods.begin(), plan.methods.end(), method) != plan.methods.end();
  };
  for (const auto& mesh : meshes) {
    for_each_type(Methods{}, [&]<class Method>() {
      if (!asked(Method::name)) return;
      MethodChoice plain{.method = std::string(Method::name), .threads = plan.threads};
      if (constexpr std::string_view why = unfit<Method>(); !why.empty()) {
        if (!mesh.coarser) rungs.push_back({plain, &mesh, std::string(why)});
        return;
      }
      for (const auto precision : {Precision::double_precision, Precision::single_precision}) {
        plain.precision = precision;
        for (auto& choice : choices_of<Method>(plain, mesh.scene.description.law, plan.tolerance)) {
          rungs.push_back({std::move(choice), &mesh});
        }
      }
    });
  }
  return rungs;
}

std::string name_of(const Rung& rung) {
  const auto& choice = rung.choice;
  const std::string kappa = choice.kappa ? fmt::format(" kappa {:.3g}", *choice.kappa) : "";
  const std::string accuracy =
      adapts(choice.method) ? fmt::format(" accuracy {:.3g} %", 100.0 * choice.accuracy) : "";
  return fmt::format("{}{}{} {}", choice.method, kappa, accuracy, name_of(choice.precision));
}

bool has_small_strains(std::string_view method) {
  bool small = false;
  with_named_type(Methods{}, method, [&]<class Method>() { small = is_linear<Method>; });
  return small;
}

bool same_work(const Rung& a, const Rung& b) {
  return a.mesh == b.mesh && a.choice.method == b.choice.method && a.choice.precision == b.choice.precision &&
         a.choice.accuracy == b.choice.accuracy;
}

}  // namespace sandglass
