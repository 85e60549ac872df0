#pragma once

#include <string>
#include <vector>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "solve/central_difference.hpp"
#include "solve/relaxation.hpp"
#include "support/kept_run.hpp"
#include "support/scenes.hpp"
#include "support/softening.hpp"

namespace sandglass::verification {

/// All that determines an answer: the arguments of `make_scene`, and the method.
struct Problem {
  Case description;
  Mesh mesh;
  NodeSets sets;
  ElementSets element_sets;
  MethodChoice choice;
  long steps = 0;  ///< approximate number of steps of a motion

  Scene scene() const { return make_scene(description, mesh, sets, element_sets); }
  const MethodEntry& method() const { return method_named(choice.method); }
  bool is_static() const { return description.quasi_static; }
};

/// Whether the forces depend on the path that led to the displacements.
inline bool follows_a_path(const Problem& problem) {
  const Scene scene = problem.scene();
  const Model model(scene, problem.choice);
  return std::visit([](const auto& elements) { return elements->needs_increment(); }, model.internal_force());
}

/// Whether a material's stress has a kink in the undeformed body, which then has no frequencies.
inline bool slackens_somewhere(const Problem& problem) {
  return std::ranges::any_of(problem.description.materials, [](const CaseMaterial& material) {
    return std::visit([]<class Law>(const Law&) { return slackens<Law>; }, material.law);
  });
}

/// Calls use(curve) for the curve of every load.
template <class Use>
void for_each_curve(Case& description, const Use& use) {
  description.forces.for_each([&](auto& force) {
    if constexpr (requires { force.curve; }) use(force.curve);
  });
}

/// Multiplies all numbers.
template <class Numbers>
void multiply(Numbers& numbers, double factor) {
  for (double& number : numbers) number *= factor;
}

/// The largest length in a nodal field.
inline double largest_in(const NodalField& field) {
  return largest_distance(field, NodalField(field.size()));
}

/// The outcome of a problem.
struct Answer {
  NodalField u, v = {};                 ///< m, m/s
  std::string failure, words;           ///< the kind of failure, empty if none; the message
  double largest = 0.0, fastest = 0.0;  ///< m, m/s, over all frames
  double energy = 0.0, work = 0.0;      ///< J, at the end
  double busiest = 0.0;                 ///< J, the largest energy or work in any row
  bool stable = false;                  ///< whether the equilibrium was found stable
};

/// Calls `act`, which returns an answer or throws an error with its message for users.
template <class Act>
Answer attempt(const Act& act) {
  Answer answer;
  try {
    return act();
  } catch (const InputError& error) {
    answer.failure = "refused";
    answer.words = error.what();
  } catch (const ComputationError& error) {
    answer.failure = "failed";
    answer.words = error.what();
  }
  return answer;
}

/// The displacements of a scene with a method, from a checkpoint, or starting near given displacements.
inline Answer run(const Scene& scene, const MethodChoice& choice, Observer& observer,
                  const Checkpoint* from = nullptr, const NodalField* near = nullptr) {
  return attempt([&]() -> Answer {
    const Model model(scene, choice);
    if (scene.settings.quasi_static) {
      Relaxation found = relax(model, observer, from, near);
      return {.u = std::move(found.u),
              .failure = in_equilibrium(found) ? "" : "no rest",
              .words = outcome(found, choice.precision),
              .stable = found.stability != Stability::not_decided};
    }
    Motion motion = integrate(model, observer, from);
    return {.u = std::move(motion.u),
            .v = std::move(motion.v),
            .failure = motion.interrupted ? "too many steps" : "",
            .words = ""};
  });
}

/// The answer and its reports; a motion may take at most thirty times its steps.
inline Answer answer_of(const Problem& problem, const NodalField* near = nullptr,
                        std::vector<HistoryRow>* rows = nullptr) {
  return attempt([&] {
    Recorder recorder;
    if (!problem.is_static()) recorder.last_step = 30 * problem.steps;
    Answer answer = run(problem.scene(), problem.choice, recorder, nullptr, near);
    for (const Frame& frame : recorder.frames) {
      answer.largest = std::max(answer.largest, largest_in(frame.u));
      answer.fastest = std::max(answer.fastest, largest_in(frame.v));
    }
    for (const HistoryRow& row : recorder.rows) {
      answer.energy = total_energy(row);
      answer.work = row.external_work;
      answer.busiest = std::max({answer.busiest, answer.energy, std::abs(answer.work)});
    }
    if (rows != nullptr) *rows = std::move(recorder.rows);
    return answer;
  });
}

}  // namespace sandglass::verification
