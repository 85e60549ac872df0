#pragma once

#include "support/problem_maps.hpp"

/// Whether two answers of a problem agree, and explanations if they do not.
namespace sandglass::verification {

enum class Kind { none, held, explained, open, violated };

/// The outcome of a relation on a problem; `none` if the relation does not apply, `open` if it is known not
/// to hold, though it should.
struct Verdict {
  Kind kind = Kind::none;
  double difference = 0.0;  ///< relative
  std::string words = {};
};

/// Held or violated.
inline Verdict held_if(bool holds, double difference, const std::string& words = {}) {
  return {holds ? Kind::held : Kind::violated, difference, words};
}

/// Whether forces have a potential, except for pressures, and there is no damping.
inline bool is_conservative(const Problem& problem) {
  const Case& d = problem.description;
  const auto remembers = [](const CaseMaterial& material) { return is_viscoelastic(material.law); };
  const auto damps = [](const Support& support) { return support.damping > 0.0; };
  if (problem.method().damps_only || problem.method().adapts()) return false;
  if (std::ranges::any_of(d.materials, remembers) || follows_a_path(problem)) return false;
  return problem.is_static() ||
         (d.dynamics.damping == 0.0 && std::ranges::none_of(d.forces.of<Support>(), damps));
}

/// Whether a method, or one of its levels, has points in alternate corners: mirrored, or turned with equal
/// edges, an element has them in the other ones (four_point.hpp).
inline bool is_handed(const Problem& problem) {
  bool handed = false;
  with_named_type(Methods{}, problem.choice.method, [&]<class Method>() {
    for_each_type(LevelsOf<Method>{}, [&]<class Level>() {
      handed = handed || std::derived_from<typename Level::Kinematics, FourPoint>;
    });
  });
  return handed;
}

/// The allowed distance between answers that differ only in rounding, over the largest displacement. In
/// motion each of n steps rounds forces by about 20 units of 1e-16, over the strain if coordinates are far
/// away, and that grows as n^2: 1e-8. Static answers have a residual of 1e-8, and bodies here are up to a
/// thousand times softer in bending than in tension. Automatic levels have errors as large as the user
/// allows, new ones at each choice in motion; where forces follow the path, load levels on the way are solved
/// to a tenth.
inline double allowed_for_rounding(const Problem& problem) {
  if (problem.method().adapts()) return 5.0 * problem.choice.accuracy;
  if (!problem.is_static()) return 1e-8;
  return follows_a_path(problem) ? 0.02 : 1e-5;
}

/// Whether elements have no stiffness against hourglass modes: static equilibria are not unique.
inline bool is_loose(const Problem& problem) {
  return problem.is_static() && (!problem.method().controls_hourglass || problem.method().damps_only);
}

/// Whether a search that starts at displacements stays there.
inline bool is_in_equilibrium(const Problem& problem, const NodalField& u, double allowed) {
  if (!problem.is_static() || problem.method().is_condensed || follows_a_path(problem)) return false;
  const Answer near = answer_of(problem, &u);
  return near.failure.empty() && largest_distance(near.u, u) <= allowed * largest_in(u);
}

/// Compares two answers of a problem at the nodes of its mesh. In statics, two equilibria of one problem
/// explain a difference, and an equilibrium that a search missed explains its failure.
inline Verdict compare(const Problem& problem, const Answer& one, const Answer& other, double allowed) {
  const auto first = [&](NodalField field) {
    field.resize(problem.mesh.points.size());
    return field;
  };
  if (is_loose(problem)) return {};
  if (!one.failure.empty() && (one.failure == "refused") == (other.failure == "refused") &&
      !other.failure.empty())
    return {};
  const bool both = one.failure.empty() && other.failure.empty();
  const Answer& found = other.failure.empty() ? other : one;
  const double next_to_nothing = 1e-9 * diagonal(problem.mesh.points);  // where loads act on held nodes
  const double unit = std::max({one.largest, other.largest, next_to_nothing});
  double difference = both ? largest_distance(first(one.u), first(other.u)) / unit : 1.0;
  const bool has_speeds = one.fastest > 0.0 && other.fastest > 0.0;
  if (both && has_speeds && !problem.method().adapts()) {  // which guarantee displacements only
    const double speed = std::max(one.fastest, other.fastest);
    difference = std::max(difference, largest_distance(first(one.v), first(other.v)) / speed);
  }
  if (both && unit > next_to_nothing && other.busiest > 0.0) {
    const double work =
        problem.is_static() ? 0.0 : one.work - other.work;  // depends on the levels in statics
    for (const double energy : {one.energy - other.energy, work})
      difference = std::max(difference, 0.1 * std::abs(energy) / one.busiest);
  }
  if (difference <= allowed) return held_if(true, difference);
  const bool whole = problem.description.refinements.empty();
  const bool two =
      (both || one.failure != "refused") && whole && is_in_equilibrium(problem, found.u, allowed);
  // Path-dependent forces remember that levels are solved to a tenth; some answers are wrong.
  const bool open = problem.is_static() && follows_a_path(problem);
  const Kind kind = two ? Kind::explained : open ? Kind::open : Kind::violated;
  return {kind, difference,
          both ? fmt::format("largest {:.3g} and {:.3g} m, energy {:.3g} and {:.3g} J", one.largest,
                             other.largest, one.energy, other.energy)
               : fmt::format("{} {} / {} {}", one.failure, one.words, other.failure, other.words)};
}

/// The same for the answer of a mapped problem. A static difference is explained if it vanishes once both
/// searches use a finer tolerance, and many levels where forces follow the path.
inline Verdict compare(const Problem& problem, const Answer& own, const std::optional<Mapped>& mapped) {
  if (!mapped) return {};
  const auto mapped_back = [&](const Problem& of) {
    Answer answer = answer_of(of);
    answer.u = mapped->back(answer.u, mapped->length);
    answer.v = mapped->back(answer.v, mapped->speed);
    answer.largest /= mapped->length;
    answer.fastest /= mapped->speed;
    for (double* energy : {&answer.energy, &answer.work, &answer.busiest}) *energy /= mapped->energy;
    return answer;
  };
  Verdict verdict = compare(problem, own, mapped_back(mapped->problem), allowed_for_rounding(problem));
  if (verdict.kind < Kind::open || !problem.is_static() || !own.failure.empty()) return verdict;
  Problem finer = problem, finer_mapped = mapped->problem;
  for (Problem* one : {&finer, &finer_mapped}) {
    one->description.relaxation.tolerance = 1e-12;
    one->description.relaxation.max_steps *= 3;
    if (follows_a_path(problem)) one->description.relaxation.levels = 60;
  }
  const Answer other = mapped_back(finer_mapped);
  const Verdict sharp = compare(finer, answer_of(finer), other, allowed_for_rounding(problem));
  if (sharp.kind == Kind::held) verdict.kind = Kind::explained;
  verdict.words += fmt::format(", {:.1e} with a finer search", sharp.difference);
  return verdict;
}

}  // namespace sandglass::verification
