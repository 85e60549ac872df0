#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "assembly/state.hpp"
#include "forces/face_forces.hpp"

namespace sandglass {

/// What acts on the nodes of a body that moves by central differences, by rows of its layout.
template <class Real>
struct NodalProblem {
  using Share = std::array<double, 3>;

  /// A component that follows a path: the sum of `share` (m) times the terms of its angle.
  struct Constraint {
    std::size_t row;
    std::size_t component;
    Share share;
    std::size_t angle;
    double mass;  ///< kg
  };

  std::vector<Real> inverse_masses;     ///< 1/kg, by row
  std::vector<Constraint> constraints;  ///< sorted by node
  std::vector<NodalLoad> dead_loads;    ///< N, at nodes of the mesh
  std::vector<FaceForces> face_forces;  ///< on nodes of the mesh
  std::size_t angles = 0, curves = 0;   ///< how many there are
};

/// The numbers of a step: the increment becomes keep * increment - gain * force / mass.
struct ResidentStep {
  /// Of the paths of an angle: their terms after the step, the changes of these, and their second derivatives
  /// by time (1/s^2).
  struct Angle {
    std::array<double, 3> terms, moved, accelerations;
  };

  double keep, gain, step;      ///< gain in s^2, the step in s
  std::vector<double> factors;  ///< of load curves, after the step
  std::vector<Angle> angles;
};

/// A moving body at the end of a step, and what it has gathered on the way. By constraint, `driving` is the
/// force (N) that moves it, which is its reaction plus the inertia of its mass; works (J) are those since the
/// last time that the body was read or written.
template <class Real>
struct ResidentBody {
  Rows<Real> u, increment;  ///< m; the increment of constrained components is zero
  Rows<Real> force;         ///< N, internal minus loads; zero on constrained components
  Rows<Real> loads;         ///< N, of the last evaluation
  std::vector<Real> reactions, driving, works;
  std::vector<Real> works_of_loads;  ///< J, by row
};

/// What a step costs there. Each array is counted once, as if caches held what neighbours share.
struct StepTraffic {
  int launches = 0;
  std::size_t bytes = 0;
};

/// The state of a body on another processor, which takes steps there.
template <class Real>
class ResidentState {
 public:
  ResidentState() = default;
  ResidentState(const ResidentState&) = delete;
  ResidentState& operator=(const ResidentState&) = delete;
  virtual ~ResidentState() = default;

  virtual StepTraffic step_traffic() const = 0;

  /// Gives constraints, in the order of the problem, other shares of their paths in the steps from now on.
  virtual void redirect(std::span<const typename NodalProblem<Real>::Share> shares) = 0;

  /// Starts from a body; its reactions and works are not used.
  virtual void write(const ResidentBody<Real>& body) = 0;

  /// Takes steps, without waiting for their end.
  virtual void take(std::span<const ResidentStep> steps) = 0;

  /// Waits for the end of all steps.
  virtual void wait() = 0;

  /// Whether det F is positive and finite at all integration points.
  virtual bool is_healthy() = 0;

  /// Waits for the end of all steps and copies the body, whose vectors have the right sizes.
  virtual void read(ResidentBody<Real>& body) = 0;
};

/// Elements on another processor that can keep the whole state there.
template <class Real>
class StateKeeper {
 public:
  virtual ~StateKeeper() = default;
  virtual std::unique_ptr<ResidentState<Real>> resident(const NodalProblem<Real>& problem) const = 0;
};

}  // namespace sandglass
