#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "math/rows.hpp"
#include "mesh/face_load.hpp"
#include "mesh/mesh_part.hpp"

namespace sandglass {

/// Values at the nodes of a force, in their order, which stand at places among others.
template <class T>
class AtNodes {
 public:
  AtNodes(T* values, const std::vector<std::size_t>& places) : values_(values), places_(places.data()) {}
  T& operator[](std::size_t n) const { return values_[places_[n]]; }

 private:
  T* values_;
  const std::size_t* places_;
};

/// How the nodes of a force move. Without time, the increment over the step is zero.
struct NodalMotion {
  AtNodes<const Row<double>> u, increment;  ///< m, the second in the last step
  double step;                              ///< s
};

/// Upper bounds of what forces add to the frequencies of nodes, or of elements.
struct LoadRates {
  double square = 0.0;   ///< of the frequency, 1/s^2
  double damping = 0.0;  ///< 1/s
};

/// How large forces are, however they are directed.
struct LoadSize {
  double force = 0.0;   ///< N
  double moment = 0.0;  ///< N m
};

/// What a force is like.
struct ForceTraits {
  std::string_view name;  ///< that of its table
  bool drives;  ///< it is proportional to the factors of its curves; else it resists what others drive
  bool dissipates;
  std::string_view no_potential;  ///< why it has none, as far as is known; empty where it has one
};

/// A force of a case on a mesh: immutable, shared by all who compute with it. Factors are those of all load
/// curves of the scene.
class BodyForce {
 public:
  virtual ~BodyForce() = default;

  /// Those that it acts on, sorted.
  const std::vector<int>& nodes() const { return nodes_; }

  const ForceTraits& traits() const { return traits_; }

  /// Adds its forces, N.
  virtual void add_forces(std::span<const double> factors, const NodalMotion& motion,
                          AtNodes<Row<double>> forces) const = 0;

  /// Adds the energy (J) of which the forces are minus the derivative, at displacements u (m).
  virtual void add_potential(std::span<const double> factors, AtNodes<const Row<double>> u,
                             double& sum) const = 0;

  /// Adds to bounds of the frequencies of all nodes of the mesh, from their masses (kg) and the largest
  /// factors of the curves.
  virtual void add_rates(std::span<const double> largest, std::span<const double> masses,
                         std::span<LoadRates> rates) const = 0;

  /// Adds the diagonal of its stiffness where nothing is deformed (N/m), with which steps are prepared.
  virtual void add_stiffness(AtNodes<Row<float>> diagonal) const = 0;

  /// Adds what drives a body at the factor one, however it is directed.
  virtual void add_size(LoadSize& size) const = 0;

  /// What it comes to where the body's motion does not change it, at the factor one; else none.
  virtual std::span<const NodalLoad> dead_loads() const = 0;

  /// The same force on a part of the mesh; null where none of it acts there.
  virtual std::shared_ptr<const BodyForce> restricted_to(const MeshPart& part) const = 0;

  /// The force that follows the load factor of the case, the first curve, to what this one is at factors.
  virtual std::shared_ptr<const BodyForce> held_at(std::span<const double> factors) const = 0;

 protected:
  BodyForce(std::vector<int> nodes, const ForceTraits& traits);

  /// The place of a node among those of the force.
  std::size_t place_of(int node) const;
  std::array<std::size_t, 4> places_of(const Quadrilateral& face) const;

 private:
  std::vector<int> nodes_;
  ForceTraits traits_;
};

/// The forces on a body, in the order in which they are summed.
using BodyForces = std::vector<std::shared_ptr<const BodyForce>>;

/// The first of forces that is no dead load; null where all are.
const BodyForce* first_not_dead(const BodyForces& forces);

/// All dead loads, at the factor one.
std::vector<NodalLoad> dead_loads(const BodyForces& forces);

/// The faces that have all their nodes in a part, in the numbering of the part.
std::vector<Quadrilateral> faces_in(const MeshPart& part, const std::vector<Quadrilateral>& faces);

/// The nodes of faces, in any order.
std::vector<int> nodes_of(const std::vector<Quadrilateral>& faces);

}  // namespace sandglass
