#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "math/rows.hpp"
#include "mesh/face_load.hpp"
#include "mesh/free_motions.hpp"
#include "mesh/mesh_part.hpp"

namespace sandglass {

/// Rows by the numbers of nodes, which stand at places among others.
template <class T>
class AtNodes {
 public:
  AtNodes(T* rows, const std::vector<int>& place_of_node) : rows_(rows), places_(place_of_node.data()) {}
  T& operator[](int node) const { return rows_[places_[node]]; }

 private:
  T* rows_;
  const int* places_;
};
using NodalRows = AtNodes<const Row<double>>;

/// How the nodes of a force move. Without time, the increment over the step is zero.
struct NodalMotion {
  NodalRows u, increment;  ///< m, the second in the last step
  double step;             ///< s
};

/// Upper bounds of what forces add to the frequencies of nodes, or of elements.
struct LoadRates {
  double square = 0.0;   ///< of the frequency, 1/s^2
  double damping = 0.0;  ///< 1/s
};

/// Properties of a force.
struct ForceTraits {
  std::string_view name;  ///< that of its table
  bool drives;  ///< it is proportional to the factors of its curves; otherwise it only resists motion
  bool dissipates;
  std::string_view no_potential;  ///< why it has none, as far as is known; empty where it has one
};

/// The factors of all load curves of a scene.
using Factors = std::span<const double>;

/// A force of a case on a mesh: immutable, shared by all who compute with it.
class BodyForce {
 public:
  virtual ~BodyForce() = default;

  /// Those that it acts on, in any order.
  const std::vector<int>& nodes() const { return nodes_; }

  const ForceTraits& traits() const { return traits_; }

  /// Adds its forces, N.
  virtual void add_forces(Factors factors, const NodalMotion& motion, AtNodes<Row<double>> forces) const = 0;

  /// Adds the energy (J) of which the forces are minus the derivative, at displacements u (m).
  virtual void add_potential(Factors factors, NodalRows u, double& sum) const = 0;

  /// Adds to bounds of the frequencies of all nodes of the mesh, from their masses (kg) and the largest
  /// factors of the curves.
  virtual void add_rates(Factors largest, const std::vector<double>& masses,
                         std::vector<LoadRates>& rates) const = 0;

  /// Adds the diagonal of its stiffness where nothing is deformed (N/m), with which steps are prepared.
  virtual void add_stiffness(AtNodes<Row<float>> diagonal) const = 0;

  /// Adds what it holds at rest, in any motion and however little; nothing for loads.
  virtual void add_holds(std::vector<Hold>& /*holds*/) const {}

  /// Adds what drives a body at the factor one (N), however it is directed; moments as forces at an arm (m).
  virtual void add_size(double arm, double& sum) const = 0;

  /// Its nodal loads at the factor one if the motion of the body does not change them; otherwise none.
  virtual std::span<const NodalLoad> dead_loads() const = 0;

  /// The same force on a part of the mesh; null where none of it acts there.
  virtual std::shared_ptr<const BodyForce> restricted_to(const MeshPart& part) const = 0;

 protected:
  BodyForce(std::vector<int> nodes, const ForceTraits& traits) : nodes_(std::move(nodes)), traits_(traits) {}

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
