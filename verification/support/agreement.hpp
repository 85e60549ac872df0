#pragma once

#include "support/problem_maps.hpp"

/// Whether two answers of a problem agree, and what explains that they do not.
namespace sandglass::verification {

enum class Kind { none, held, explained, open, violated };

/// What became of a relation on a problem; `none` where it says nothing, `open` where it is known not to
/// hold, though it should.
struct Verdict {
  Kind kind = Kind::none;
  double difference = 0.0;  ///< relative
  std::string words = {};
};

/// Held or violated.
inline Verdict held_if(bool holds, double difference, const std::string& words = {}) {
  return {holds ? Kind::held : Kind::violated, difference, words};
}

/// Whether forces have a potential, but for pressures, and nothing damps.
inline bool is_conservative(const Problem& problem) {
  const Case& d = problem.description;
  const auto remembers = [](const CaseMaterial& material) { return is_viscoelastic(material.law); };
  const auto damps = [](const Support& support) { return support.damping > 0.0; };
  if (problem.method().damps_only || problem.method().adapts()) return false;
  if (std::ranges::any_of(d.materials, remembers) || follows_a_path(problem)) return false;
  return problem.at_rest() ||
         (d.dynamics.damping == 0.0 && std::ranges::none_of(d.forces.of<Support>(), damps));
}

/// Whether a method, or one of its levels, has points in alternate corners: which ones, mirrors and turned
/// elements of equal edges decide otherwise (four_point.hpp).
inline bool is_handed(const Problem& problem) {
  bool handed = false;
  with_named_type(Methods{}, problem.choice.method, [&]<class Method>() {
    for_each_type(LevelsOf<Method>{}, [&]<class Level>() {
      handed = handed || std::derived_from<typename Level::Kinematics, FourPoint>;
    });
  });
  return handed;
}

/// How far answers may be apart, over the largest displacement, that differ in rounding alone. In motion each
/// of n steps rounds forces by some 20 units of 1e-16, over the strain where coordinates are moved far away,
/// and carries that on as n^2: 1e-8. At rest a residual of 1e-8 is asked for, and bodies here are up to a
/// thousand times softer in bending than in tension. Levels that a method chooses err by as much as the user
/// allows, each time anew in motion; where forces follow the path, levels of the load are solved to a tenth
/// on the way.
inline double allowed_for_rounding(const Problem& problem) {
  if (problem.method().adapts()) return 5.0 * problem.choice.accuracy;
  if (!problem.at_rest()) return 1e-8;
  return follows_a_path(problem) ? 0.02 : 1e-5;
}

/// Whether elements have no stiffness against hourglass modes: no rest is the only one.
inline bool is_loose(const Problem& problem) {
  return problem.at_rest() && (!problem.method().controls_hourglass || problem.method().damps_only);
}

/// Whether a search that starts at displacements stays there.
inline bool is_at_rest(const Problem& problem, const NodalField& u, double allowed) {
  if (!problem.at_rest() || problem.method().is_condensed || follows_a_path(problem)) return false;
  const Answer near = answer_of(problem, &u);
  return near.failure.empty() && largest_distance(near.u, u) <= allowed * largest_in(u);
}

/// Compares two answers of a problem, at the nodes of its mesh. At rest, two equilibria of one problem
/// explain a difference, and one that a search missed explains its failure.
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
  const double next_to_nothing = 1e-9 * diagonal(problem.mesh.points);  // where loads act on what is held
  const double unit = std::max({one.largest, other.largest, next_to_nothing});
  double difference = both ? largest_distance(first(one.u), first(other.u)) / unit : 1.0;
  const bool has_speeds = one.fastest > 0.0 && other.fastest > 0.0;
  if (both && has_speeds && !problem.method().adapts()) {  // which promise displacements
    const double speed = std::max(one.fastest, other.fastest);
    difference = std::max(difference, largest_distance(first(one.v), first(other.v)) / speed);
  }
  if (both && unit > next_to_nothing && other.busiest > 0.0) {
    const double work = problem.at_rest() ? 0.0 : one.work - other.work;  // at rest it depends on the levels
    for (const double energy : {one.energy - other.energy, work})
      difference = std::max(difference, 0.1 * std::abs(energy) / one.busiest);
  }
  if (difference <= allowed) return held_if(true, difference);
  const bool whole = problem.description.refinements.empty();
  const bool two = (both || one.failure != "refused") && whole && is_at_rest(problem, found.u, allowed);
  // Levels are solved to a tenth, which such forces remember, and some are wrong.
  const bool open = problem.at_rest() && follows_a_path(problem);
  const Kind kind = two ? Kind::explained : open ? Kind::open : Kind::violated;
  return {kind, difference,
          both ? fmt::format("largest {:.3g} and {:.3g} m, energy {:.3g} and {:.3g} J", one.largest,
                             other.largest, one.energy, other.energy)
               : fmt::format("{} {} / {} {}", one.failure, one.words, other.failure, other.words)};
}

/// The same for the answer of a mapped problem. A difference at rest that goes where both searches take a
/// finer tolerance, and many levels where forces follow the path, is explained by that.
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
  if (verdict.kind < Kind::open || !problem.at_rest() || !own.failure.empty()) return verdict;
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
