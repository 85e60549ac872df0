#include "commands/score.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "comparison/answer.hpp"
#include "comparison/comparison.hpp"

namespace sandglass {

namespace {

/// The answer of the mean-dilatation element, for cases without a stored golden. Throws ComputationError if
/// there is none.
Displacements mean_dilatation_answer(const Scene& scene) {
  Observer silent;
  Answer answer = compute_answer(scene, {.method = std::string(golden_method)}, silent);
  if (answer.refused || answer.failure) {
    throw ComputationError(fmt::format("{}: {} found no answer to compare with: {}", scene.settings.name,
                                       golden_method, answer.status));
  }
  return std::move(answer.u);
}

/// The verdict that displacements allow. Without energies, locking is never found.
Finding finding_of(const Scene& scene, const References& references, const Displacements& u) {
  const double unit = displacement_unit(scene, *references.golden);
  Symptoms found = symptoms(scene, u, 0.0, *references.golden, unit);
  found.stiffness_ratio = 1.0;
  return judge(found, golden_to_truth(scene, references));
}

}  // namespace

void require_scorable(const Scene& scene) {
  if (scene.settings.quasi_static) return;
  throw InputError(fmt::format("{}: a dynamic case has no answer to score", scene.settings.file.string()));
}

Verdict score(const Scene& scene, const NodalField& u, const std::string& name) {
  require_scorable(scene);
  if (u.size() != scene.mesh.points.size()) {
    throw InputError(fmt::format("displacements: {} rows were given; {} has {} nodes", u.size(),
                                 scene.settings.name, scene.mesh.points.size()));
  }
  const References references = read_references(scene);
  const Displacements answer{u};
  Verdict verdict{.case_name = scene.settings.name,
                  .method = name,
                  .precision = "double",
                  .status = "ok",
                  .golden = accuracy_of(scene, references.comparison, answer, references.golden),
                  .truth = accuracy_of(scene, references.comparison, answer, references.truth),
                  .family = scene.settings.family,
                  .variants = scene.settings.variants};
  if (references.golden) {
    verdict.finding = finding_of(scene, references, answer);
  } else {
    verdict.mean_dilatation =
        accuracy_of(scene, references.comparison, answer, mean_dilatation_answer(scene));
  }
  return verdict;
}

}  // namespace sandglass
