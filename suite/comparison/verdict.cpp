#include "comparison/verdict.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "comparison/answer.hpp"
#include "comparison/reference_file.hpp"
#include "counting/method_work.hpp"
#include "solve/stable_step.hpp"

namespace sandglass {

namespace {

std::optional<Displacements> read_if_present(const std::filesystem::path& path, const Scene& scene) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return std::nullopt;
  return read_reference(path, scene);
}

std::optional<double> figure_of(const Verdict& verdict, const Expectation& expected) {
  const bool measured = expected.reference == "measured";
  if (measured || expected.reference == "published")
    return largest_relative_error(verdict.published, measured, expected.figure == "period_error");
  const auto& accuracy = expected.reference == "golden" ? verdict.golden : verdict.truth;
  if (!accuracy) return std::nullopt;
  if (expected.figure == "max_relative_error") return accuracy->max_relative_error;
  if (expected.figure == "rms_relative_error") return accuracy->rms_relative_error;
  return accuracy->profile_relative_error;
}

bool concerns(const Expectation& expected, const Verdict& verdict) {
  if (verdict.method != expected.method || verdict.precision != "double") return false;
  if (!verdict.kappa || expected.kappa == "best") return true;
  if (expected.kappa == "auto") return verdict.kappa_is_auto;
  return !verdict.kappa_is_auto && fmt::to_string(*verdict.kappa) == expected.kappa;
}

/// Computes the answer of a scene and fills in the verdict's figures about its computation. Throws
/// ComputationError.
Answer fill_answer(const Scene& scene, const MethodChoice& choice, Verdict& verdict) {
  const Model model(scene, choice);
  if (const BodyForce* load = first_not_dead(scene.forces)) verdict.load_in_steps = load->traits().name;
  verdict.stable_step = stable_step(model, NodalField(scene.mesh.points.size())).step;
  Observer silent;
  Answer answer = compute_answer(model, silent);
  const StrainEnergies energies = answer.energies;
  verdict.status =
      answer.failure ? fmt::format("failed: {}, residual {:.1e}", answer.status, answer.residual) : "ok";
  if (scene.settings.quasi_static) {
    verdict.search = SearchCost{answer.seconds, answer.steps};
  } else {
    verdict.motion = MotionCost{answer.seconds, answer.steps};
  }
  verdict.residual = answer.residual;
  verdict.hourglass_energy_ratio = energies.strain > 0.0 ? energies.hourglass / energies.strain : 0.0;
  return answer;
}

}  // namespace

References read_references(const Scene& scene) {
  References references{.comparison = read_comparison(scene), .golden = {}, .truth = {}};
  references.golden = read_if_present(references.comparison.golden, scene);
  references.truth = read_if_present(references.comparison.truth, scene);
  return references;
}

std::optional<Accuracy> accuracy_of(const Scene& scene, const Comparison& comparison, const Displacements& u,
                                    const std::optional<Displacements>& reference) {
  if (!reference) return std::nullopt;
  const auto* profile = comparison.profile ? &scene.sets.at(comparison.profile->set) : nullptr;
  return accuracy(u, *reference, profile, displacement_unit(scene, *reference));
}

std::optional<double> golden_to_truth(const Scene& scene, const References& references) {
  const auto& [comparison, golden, truth] = references;
  if (!golden || !truth) return std::nullopt;
  return accuracy_of(scene, comparison, *golden, truth)->max_relative_error;
}

Verdict run_and_compare(const Scene& scene, const References& references, const MethodChoice& choice,
                        Displacements& u) {
  const MethodEntry& method = method_named(choice.method);
  const KernelLaw law = kernel_law(scene.materials.list.front().law);
  Verdict verdict{
      .case_name = scene.settings.name,
      .elements = scene.mesh.cells.size(),
      .method = choice.method,
      .kappa = choice.kappa ? choice.kappa : method.auto_kappa(elastic_law(law), choice.kappa_modulus),
      .kappa_is_auto = method.takes_kappa && !choice.kappa,
      .precision = std::string(name_of(choice.precision)),
      .operations = work_of(method, law, shapes_in(scene.mesh)).operations.total.total(),
      .family = scene.settings.family,
      .variants = scene.settings.variants,
      .published =
          published_results(scene, references.comparison.published, references.truth, references.golden)};
  StrainEnergies energies;
  std::vector<ReactionsAt> checks;
  try {
    Answer answer = fill_answer(scene, choice, verdict);
    u = std::move(answer.u);
    energies = answer.energies;
    checks = std::move(answer.checks);
  } catch (const ComputationError& error) {
    const std::string_view text(error.what());
    verdict.status = fmt::format("failed: {}", text.substr(0, text.find('\n')));
    // Without a breakdown the method does not support the case, which says nothing about its answers.
    if (error.breakdown() != Breakdown::other) verdict.finding = finding_of(error.breakdown());
    return verdict;
  }
  verdict.golden = accuracy_of(scene, references.comparison, u, references.golden);
  verdict.truth = accuracy_of(scene, references.comparison, u, references.truth);
  if (references.golden) {
    verdict.symptoms = symptoms(scene, u, energies.strain + energies.hourglass, *references.golden,
                                displacement_unit(scene, *references.golden));
    verdict.finding =
        verdict.ok() ? judge(*verdict.symptoms, golden_to_truth(scene, references)) : Finding::no_equilibrium;
  }
  fill_computed(scene, u, checks, verdict.published);
  return verdict;
}

std::vector<LimitCheck> check_limits(const std::string& case_name,
                                     const std::vector<Expectation>& expectations,
                                     const std::vector<Verdict>& verdicts) {
  std::vector<LimitCheck> checks;
  for (const auto& expected : expectations) {
    LimitCheck check{case_name, expected, {}, {}, false};
    for (const auto& verdict : verdicts) {
      if (verdict.case_name != check.case_name || !concerns(expected, verdict)) continue;
      const auto figure = figure_of(verdict, expected);
      if (!figure || (check.figure && *check.figure <= *figure)) continue;
      check.figure = figure;
      check.kappa = verdict.kappa;
      // A run without equilibrium may show that a method fails, never that it is accurate.
      check.holds = expected.below ? verdict.ok() && *figure <= *expected.below : *figure > *expected.above;
    }
    checks.push_back(check);
  }
  return checks;
}

}  // namespace sandglass
