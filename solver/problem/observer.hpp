#pragma once

#include <functional>
#include <limits>
#include <map>
#include <string>

#include "mesh/mesh.hpp"
#include "problem/checkpoint.hpp"

namespace sandglass {

/// The forces (N) that hold or drive sets of nodes, and those of obstacles, by name; see
/// Body::reactions_of_sets.
using Reactions = std::map<std::string, Vector>;

/// One row of the dense history.
struct HistoryRow {
  double time;               ///< s; relative load in quasi-static runs, growing beyond 1 while relaxing
  double kinetic;            ///< J; zero in quasi-static runs
  double strain;             ///< J
  double hourglass;          ///< J
  double external_work;      ///< J, done by imposed displacements, forces and moving obstacles
  double residual;           ///< |force on free components| / |reactions and loads|, -
  double step_size;          ///< s; in quasi-static runs the increment of the load
  double adaption = 0.0;     ///< J, energy due to changes of levels in dynamic runs; see Adaption
  Reactions reactions = {};  ///< N
  double contact = 0.0;      ///< J, stored where obstacles are touched
  double friction = 0.0;     ///< J, lost in contact, also in impacts where it moves nodes
  double depth = 0.0;        ///< m, the largest of a node inside an obstacle
  Reactions moments = {};    ///< of obstacles, N m; see Touch
  double damping = 0.0;      ///< J, lost to the damping of free components, by the trapezoidal rule
};

/// A frame of the results, in the numbering of the mesh.
struct Frame {
  double time;
  NodalField u;                                    ///< m
  NodalField v;                                    ///< m/s, at the same time as u
  std::vector<double> jacobians;                   ///< volume ratio of each element
  std::vector<double> hourglass_energy_densities;  ///< J/m^3, per reference volume of each element
  std::vector<double> levels;                      ///< of each element; empty if the method has only one
  std::vector<double> stresses = {};  ///< Pa, Cauchy, the mean of each element: nine numbers, row by row
  Reactions reactions = {};           ///< N
  Reactions moments = {};             ///< of obstacles, N m; see Touch
};

/// The receiver of a stepper's reports. The base class ignores them.
class Observer {
 public:
  Observer() = default;
  Observer(const Observer&) = delete;
  Observer& operator=(const Observer&) = delete;
  virtual ~Observer() = default;

  virtual void frame(const Frame& /*frame*/) {}

  virtual void history(const HistoryRow& /*row*/) {}

  /// Called after every step of a dynamic run with the time (s) at its end and its size (s). If steps proved
  /// too long, times start again at the last check.
  virtual void stepped(double /*time*/, double /*size*/) {}

  /// The next time (s) for which a dynamic run should report displacements; infinite: none.
  virtual double next_sample() const { return std::numeric_limits<double>::infinity(); }

  /// The displacements (m) at `next_sample()`, interpolated within the step that reaches it.
  virtual void sample(const NodalField& /*u*/) {}

  /// Called at every point from which the run can be resumed, after all reports up to there. `checkpoint`
  /// copies the state; it may be called only during this call.
  virtual void resumable(const std::function<Checkpoint()>& /*checkpoint*/) {}

  /// Called in quasi-static runs with the load factor at which an equilibrium is being searched.
  virtual void at_load(double /*factor*/) {}

  /// Called with the completed share of the work, in quasi-static runs after every evaluation, else at every
  /// check; if it returns false at a check, the run ends regularly.
  virtual bool proceed(long /*step*/, double /*share*/, double /*residual*/) { return true; }
};

}  // namespace sandglass
