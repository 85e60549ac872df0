#pragma once

#include "problem/model.hpp"
#include "problem/observer.hpp"

namespace sandglass {

/// Whether a static answer is known to be a minimum of the potential.
enum class Stability {
  not_decided,
  stable,
  saddle_left  ///< stable, after the search left an unstable equilibrium
};

/// A static answer and the course of the search for it.
struct Relaxation {
  NodalField u;                   ///< m
  long steps = 0;                 ///< evaluations of the internal forces
  double residual = 0.0;          ///< |force on free components| / |reactions and loads|
  bool converged = false;         ///< residual below the tolerance
  bool stagnated = false;         ///< the residual stopped falling above the tolerance
  bool rounded = false;           ///< it stagnated within the rounding of the number type
  bool inverted = false;          ///< an element is inverted at u, or no longer finite
  bool interrupted = false;       ///< the observer ended the run
  StrainEnergies energies;        ///< at u
  double seconds = 0.0;           ///< wall time from the model to the answer
  double adaption_seconds = 0.0;  ///< the share of `seconds` for the choice of levels, adaptive methods
  Stability stability = Stability::not_decided;
  std::string why_not_decided = {};  ///< empty if it is
  long stability_evaluations = 0;    ///< of the forces, beside `steps`
};

/// Finds the static equilibrium with the settings of the case. The imposed displacements and forces grow in
/// load levels (load_levels.hpp), each solved by `Equilibrium`, to a coarse tolerance except at the full
/// load. A load level that fails is repeated with half the increment. A condensed method superposes its
/// answer in one step. Throws InputError for a body that can move without deforming (held.hpp), and
/// ComputationError if an element remains inverted or no increment is small
/// enough. The search can be resumed from the start of every load level; with `from`, a checkpoint of the
/// same model, it starts there, and nothing is reported twice. A condensed method has no checkpoints. If
/// displacements (m) near the answer are given, from another method or a coarser mesh, the search first
/// starts from them at the full load, unless forces depend on the path.
Relaxation relax(const Model& model, Observer& observer, const Checkpoint* from = nullptr,
                 const NodalField* near = nullptr);

/// Whether the answer is in equilibrium within the tolerance, or within roundoff. Roundoff may keep the
/// residual above the tolerance: often in single precision; in double precision if displacements are large
/// and loads small, or if the body is almost incompressible.
bool in_equilibrium(const Relaxation& relaxation);

/// Whether the answer is a minimum, as text: "stable", or the reason why that is unknown.
std::string stability_text(const Relaxation& relaxation);

/// The end of the search as text: "static equilibrium", or the reason why not.
std::string outcome(const Relaxation& relaxation, Precision precision);

}  // namespace sandglass
