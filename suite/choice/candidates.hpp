#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "comparison/accuracy.hpp"
#include "problem/make_scene.hpp"
#include "problem/model.hpp"

namespace sandglass {

/// The user's own mesh, or another one of the same body, with the steps of the user's case or longer ones.
struct CandidateMesh {
  std::string difference = {};  ///< the element counts of a coarser mesh, the size of a refined one, or both
  CaseOnMesh problem;
  Scene scene;              ///< of this mesh
  Displacements reference;  ///< the reference's displacements at its nodes, m
  std::string steps = {};   ///< how a motion takes longer steps; empty: it does not

  /// Whether the mesh is the user's.
  bool own() const { return difference.empty(); }

  /// "own mesh" or the difference from it, and the steps if they are longer.
  std::string name() const;

  /// The reference at its largest displacement.
  const NodalField& farthest() const;
};

/// A combination of method, precision and mesh: a candidate of `sandglass choose`, which tries the
/// cheapest first.
struct Candidate {
  MethodChoice choice;
  const CandidateMesh* mesh = nullptr;
  std::string unfit = {};  ///< why it should not be used at any cost; empty: fit
};

/// The choices for the list of candidates.
struct CandidatePlan {
  std::vector<std::string> methods;  ///< none: all of the list
  double tolerance = 0.01;           ///< of the user
  int threads = 1;
};

/// All candidates of some meshes, not yet in order: every method of the list in double and in float. A method
/// whose kappa affects the static answer appears with auto, half and twice that; an adaptive one with several
/// accuracies around the user's tolerance. A method without such an answer, static or in motion, or without
/// hourglass control appears once, as unfit.
std::vector<Candidate> make_candidates(const std::deque<CandidateMesh>& meshes, const CandidatePlan& plan);

/// The name of a candidate: "tl-perturbation kappa 0.00325 float".
std::string name_of(const Candidate& candidate);

}  // namespace sandglass
