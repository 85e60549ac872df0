/// Pairs of runs that must agree, on random problems: changes that must not affect the answer, and answers
/// that must follow from others. A new pair needs only an entry of `relations`.

#include <gtest/gtest.h>

#include "io/case_file.hpp"
#include "mesh/edges.hpp"
#include "sandglass/batch.hpp"
#include "support/mechanics.hpp"
#include "support/random_problem.hpp"
#include "support/random_scene.hpp"
#include "support/thread_ranks.hpp"

namespace sandglass::verification::relations_test {
namespace {

// Relations: a problem, its own answer, and random numbers for arbitrary choices.

/// A rotation that maps axes to axes if single components are imposed.
Tensor<double> fitting_rotation(const Problem& problem, RandomGeometry& random) {
  constexpr std::array all{true, true, true};
  const auto partial = [&](const ImposedDisplacement& imposed) { return imposed.components != all; };
  if (std::ranges::none_of(problem.description.displacements, partial)) return random.rotation();
  return {{0, 0, 1, 1, 0, 0, 0, 1, 0}};
}

Verdict rotation(const Problem& problem, const Answer& own, RandomGeometry& random) {
  if (is_handed(problem)) return {};
  return compare(problem, own, placed(problem, fitting_rotation(problem, random)));
}

Verdict mirror(const Problem& problem, const Answer& own, RandomGeometry& random) {
  if (is_handed(problem)) return {};
  return compare(problem, own, placed(problem, -1.0 * fitting_rotation(problem, random)));
}

/// Refined until it is divided among threads and ranks, for a few steps.
std::optional<Problem> enlarged(Problem problem) {
  constexpr std::size_t enough = 256, few = 64;
  Case& d = problem.description;
  const std::size_t elements = problem.mesh.cells.size();
  if (!d.ties.empty() || !d.refinements.empty() || elements > few || 8 * elements < enough)
    return std::nullopt;
  Refinement all;
  for (std::size_t e = 0; e < elements; ++e) all.numbers.push_back(static_cast<int>(e));
  d.refinements = {all};
  d.relaxation.max_steps = 12;
  d.dynamics.duration *= 8.0 / static_cast<double>(std::max(1L, problem.steps));
  d.dynamics.time_step *= 0.4;
  return problem;
}

/// Everything that a run reports.
struct RunOutput {
  std::string words;
  std::vector<std::uint64_t> bits;
  bool operator==(const RunOutput&) const = default;
};

RunOutput output_of(const Scene& scene, const MethodChoice& choice, KeepingRecorder& recorder,
                    const Checkpoint* from = nullptr) {
  const Answer answer = run(scene, choice, recorder, from);
  return {answer.failure + answer.words, bits_of(recorder.run(), answer.u)};
}

RunOutput output_of(const Problem& problem) {
  KeepingRecorder recorder;
  return output_of(problem.scene(), problem.choice, recorder);
}

Verdict same(const RunOutput& one, const RunOutput& other) {
  return held_if(one == other, one == other ? 0.0 : 1.0, one.words + " / " + other.words);
}

Verdict threads(const Problem& problem, const Answer& /*own*/, RandomGeometry& /*random*/) {
  auto larger = enlarged(problem);
  if (!larger) return {};
  const RunOutput alone = output_of(*larger);
  larger->choice.threads = 3;
  return same(alone, output_of(*larger));
}

Verdict ranks(const Problem& problem, const Answer& /*own*/, RandomGeometry& /*random*/) {
  const auto larger = enlarged(problem);
  if (!larger) return {};
  const auto together = ThreadRanks(2).run([&](std::shared_ptr<const Ranks> own) {
    Problem shared = *larger;
    shared.choice.ranks = std::move(own);
    return output_of(shared);
  });
  if (together[0].words.starts_with("refused")) return {};  // some features are not divided
  return same(together[0], together[0] == together[1] ? output_of(*larger) : together[1]);
}

/// A rounding of displacements is a pressure of K eps u / h in elements, to which a body yields in shear by K
/// / mu eps u. In static equilibrium it bends a beam of length l by 6 (l / h)^2 as much; in motion every step
/// adds as much. Three is the root of the eight nodes whose roundings meet in an element
/// (float_budget_test.cpp).
Verdict precision(const Problem& problem, const Answer& own, RandomGeometry& /*random*/) {
  if (!problem.method().controls_hourglass) return {};  // nothing resists accumulated roundings
  double amplification = 1.0;
  for (const auto& material : problem.description.materials) {
    std::visit(
        [&](const auto& law) {
          amplification = std::max(amplification, law.bulk_modulus() / law.shear_modulus());
        },
        material.law);
  }
  constexpr double roundoff = 0x1p-24;
  const double slenderness = diagonal(problem.mesh.points) / shortest_edge(problem.mesh);
  const double times =
      problem.is_static() ? 6.0 * slenderness * slenderness : static_cast<double>(problem.steps);
  // Frequencies of bodies are accurate to a thousandth, and elements take small steps in groups: rounding
  // decides the steps, on which the error of central differences depends.
  const auto& dynamics = problem.description.dynamics;
  const bool rounded = !problem.is_static() && dynamics.time_step == 0.0 &&
                       (dynamics.body_frequency == 1 || dynamics.subcycles > 1);
  const double steps_differ = rounded ? 1e-3 : 0.0;
  const double budget =
      std::max({3.0 * roundoff * amplification * times, allowed_for_rounding(problem), steps_differ});
  // Rounding may make a search longer or shorter.
  Problem longer = problem;
  longer.description.relaxation.max_steps *= 10;
  Problem single = longer;
  single.choice.precision = Precision::single_precision;
  return compare(problem, own.failure == "no rest" ? answer_of(longer) : own, answer_of(single), budget);
}

/// A run that is resumed from one of its checkpoints.
Verdict resume(const Problem& problem, const Answer& /*own*/, RandomGeometry& random) {
  const Scene scene = problem.scene();
  KeepingRecorder whole;
  const RunOutput uninterrupted = output_of(scene, problem.choice, whole);
  if (whole.kept().empty()) return {};
  const double place = random.uniform(0.0, static_cast<double>(whole.kept().size()));
  const RunSoFar& kept = whole.kept()[static_cast<std::size_t>(place)];
  KeepingRecorder rest(kept);
  return same(uninterrupted, output_of(scene, problem.choice, rest, &kept.point));
}

Verdict case_file(const Problem& problem, const Answer& own, RandomGeometry& /*random*/) {
  const auto text = text_of(problem);
  if (!text || own.failure == "too many steps") return {};
  const Answer other = attempt([&] {
    const Scene scene = read_scene(*text, MeshWithSets{problem.mesh, problem.sets, problem.element_sets});
    Observer silent;
    return run(scene, method_of(scene.settings), silent);
  });
  return compare(problem, own, other, allowed_for_rounding(problem));
}

/// Calls move(factor) for the steps of a motion.
template <class Move>
void for_each_step(const Problem& problem, const Move& move) {
  const DynamicsSettings& dynamics = problem.description.dynamics;
  const double ramp = dynamics.ramp_time > 0.0 ? dynamics.ramp_time : dynamics.duration;
  for (long n = 1; n <= problem.steps; ++n) {
    const double t = std::min(1.0, static_cast<double>(n) * dynamics.time_step / ramp);
    move(t * t * t * (10.0 + t * (6.0 * t - 15.0)));
  }
}

/// The text of a case for a program that passes the mesh; none if steps are not given, if there are element
/// sets, or if static loads have curves, which `settle` evaluates at the current time.
std::optional<std::string> text_for_program(Problem problem) {
  bool fits = problem.element_sets.empty() && !problem.method().is_condensed &&
              (problem.is_static() || problem.description.dynamics.time_step > 0.0);
  for_each_curve(problem.description, [&](const LoadCurve& curve) {
    fits = fits && (curve.times.empty() || !problem.is_static());
  });
  return fits ? text_of(problem) : std::nullopt;
}

MeshArrays arrays_of(const Problem& problem) {
  return {problem.mesh.points, problem.mesh.cells, problem.sets};
}

/// The library against a run: the same steps, or the same equilibrium.
Verdict simulation(const Problem& problem, const Answer& own, RandomGeometry& /*random*/) {
  const auto text = text_for_program(problem);
  if (!text || (own.failure == "failed" && !problem.is_static())) return {};  // takes shorter steps
  double shortest = INFINITY;
  const Answer other = attempt([&] {
    Simulation<double> body(arrays_of(problem), *text);
    if (problem.is_static()) {
      body.impose(1.0);
      body.settle();
    }
    for_each_step(problem, [&](double factor) {
      shortest = std::min(shortest, body.step_size());
      body.impose(factor);
      body.advance(problem.description.dynamics.time_step);
    });
    Answer reached;
    const auto rows = body.displacements();
    for (const int row : body.row_of_node())
      reached.u.push_back({rows[at(row)][0], rows[at(row)][1], rows[at(row)][2]});
    return reached;
  });
  if (shortest < problem.description.dynamics.time_step) return {};  // its steps are divided
  return compare(problem, own, other, allowed_for_rounding(problem));
}

/// The same as a body of a batch, beside one that moves half as far; with a method and loads that batches
/// support.
Verdict batch(const Problem& given, const Answer& /*own*/, RandomGeometry& random) {
  Problem problem = given;
  while (problem.method().packed_double.assemble_batch == nullptr) {
    const double place = random.uniform(0.0, static_cast<double>(methods().size()));
    problem.choice = {.method = std::string(methods()[static_cast<std::size_t>(place)].name)};
  }
  Case& d = problem.description;
  d.refinements.clear();
  d.forces.of<Pressure>().clear();
  d.forces.of<Gravity>().clear();
  d.forces.of<Support>().clear();
  for (CaseMaterial& material : d.materials) {
    if (is_viscoelastic(material.law) || has_fibres(material.law)) material = {{sample_law<Yeoh>(0.45), 1e3}};
  }
  for (double* time : {&d.dynamics.time_step, &d.dynamics.duration, &d.dynamics.ramp_time}) *time *= 0.2;
  const auto text = text_for_program(problem);
  if (!text || problem.is_static()) return {};
  const Answer own = answer_of(problem);
  if (!own.failure.empty()) return {};
  const Answer other = attempt([&] {
    Batch<double> bodies(arrays_of(problem), *text, 2);
    for_each_step(problem, [&](double factor) {
      bodies.impose(0, 0.5 * factor);
      bodies.impose(1, factor);
      bodies.advance(problem.description.dynamics.time_step);
    });
    Answer reached;
    for (std::size_t n = 0; n < problem.mesh.points.size(); ++n)
      reached.u.push_back(bodies.displacement(1, n));
    return reached;
  });
  return compare(problem, own, other, allowed_for_rounding(problem));
}

using P = const Problem&;
using A = const Answer&;
using R = RandomGeometry&;

struct Relation {
  const char* name;
  Verdict (*check)(P problem, A own, R random);
};

constexpr auto relations = std::to_array<Relation>({
    {"rotation", rotation},
    {"mirror", mirror},
    {"translation",
     [](P problem, A own, R random) {
       const double far = 10.0 * diagonal(problem.mesh.points);
       const Vector shift{random.uniform(-far, far), random.uniform(-far, far), random.uniform(-far, far)};
       return compare(problem, own, placed(problem, identity<double>(), shift));
     }},
    {"numbers of nodes",
     [](P problem, A own, R random) {
       return compare(problem, own, with_other_node_numbers(problem, random));
     }},
    {"numbers of cells",
     [](P problem, A own, R random) {
       return compare(problem, own, with_other_cell_numbers(problem, random));
     }},
    {"turned corners",
     [](P problem, A own, R random) { return compare(problem, own, with_turned_corners(problem, random)); }},
    {"units",
     [](P problem, A own, R random) {
       const auto unit = [&] { return std::pow(10.0, random.uniform(-3.0, 3.0)); };
       const double length = unit(), time = unit(), mass = unit();
       return compare(problem, own, in_other_units(problem, length, time, mass));
     }},
    {"a material as two",
     [](P problem, A own, R random) {
       return compare(problem, own, with_a_split_material(problem, random));
     }},
    {"a load as two", [](P problem, A own, R) { return compare(problem, own, with_split_loads(problem)); }},
    {"tables as formulas", [](P problem, A own, R) { return compare(problem, own, with_formulas(problem)); }},
    {"frames",
     [](P problem, A own, R) {
       if (problem.is_static() || !own.failure.empty()) return Verdict{};
       Problem other = problem;
       other.description.dynamics.frames += 4;
       const Answer answer = answer_of(other);
       return held_if(answer.u == own.u && answer.failure.empty(), largest_distance(answer.u, own.u));
     }},
    {"threads", threads},
    {"ranks", ranks},
    {"precision", precision},
    {"kill and resume", resume},
    {"case file", case_file},
    {"Simulation", simulation},
    {"Batch", batch},
    {"time reversal", time_reversal},
    {"energy balance", energy_balance},
    {"reciprocity", reciprocity},
    {"superposition", superposition},
    {"strong damping", damping},
});

/// How often a relation held and failed, and the largest difference where it held.
struct Count {
  std::array<long, 5> of{};  ///< by kind
  double largest = 0.0;

  void add(const Verdict& verdict) {
    ++of[static_cast<std::size_t>(verdict.kind)];
    if (verdict.kind == Kind::held) largest = std::max(largest, verdict.difference);
  }
};

/// For more or other problems: SANDGLASS_SCENES=1000 SANDGLASS_SEED=7 relations_test. For a single one with
/// one relation: SANDGLASS_FIRST=17 SANDGLASS_SCENES=1 SANDGLASS_RELATION=units.
TEST(Relations, hold) {
  const long first = from_environment("SANDGLASS_FIRST", 0), count = from_environment("SANDGLASS_SCENES", 80);
  const long seed = from_environment("SANDGLASS_SEED", 1);
  const char* only = std::getenv("SANDGLASS_RELATION");
  std::map<std::string, Count> counts;
  std::map<std::string, long> answers;
  for (long number = first; number < first + count; ++number) {
    const Problem problem = RandomProblem(seed, number).make();
    if (count == 1) fmt::print("{}\n", text_of(problem).value_or("It has lists of fibres."));
    const Answer own = answer_of(problem);
    ++answers[own.failure.empty() ? "answered" : own.failure];
    if (own.failure == "refused") continue;
    for (const Relation& relation : relations) {
      if (only != nullptr && std::string(only) != relation.name) continue;
      RandomGeometry random(static_cast<std::uint64_t>(1000003 * seed + number));
      const Verdict verdict = relation.check(problem, own, random);
      counts[relation.name].add(verdict);
      const std::string what = fmt::format(
          "{}, problem {} of seed {}, {} {}: {:.2e} {}", relation.name, number, seed, problem.choice.method,
          problem.is_static() ? "at rest" : "in motion", verdict.difference, verdict.words);
      if (verdict.kind == Kind::explained || verdict.kind == Kind::open)
        fmt::print("{}: {}\n", verdict.kind == Kind::open ? "open" : "explained", what);
      if (verdict.kind == Kind::violated) ADD_FAILURE() << what;
    }
  }
  for (const auto& [what, number] : answers) fmt::print("{} {}, ", number, what);
  fmt::print("by seed {}\n{:20} held explained open violated  largest that held\n", seed, "");
  for (const Relation& relation : relations) {
    const auto& [of, largest] = counts[relation.name];
    fmt::print("{:20} {:4} {:9} {:4} {:8}  {:.1e}\n", relation.name, of[1], of[2], of[3], of[4], largest);
  }
}

}  // namespace
}  // namespace sandglass::verification::relations_test
