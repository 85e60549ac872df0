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

/// Rows accessed by node number, wherever they are stored.
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
  NodalRows u, increment;  ///< m; increment: in the last step
  double step;             ///< s
};

/// Upper bounds of the share of forces in the frequencies of nodes or elements.
struct LoadRates {
  double square = 0.0;   ///< of the frequency, 1/s^2
  double damping = 0.0;  ///< 1/s
};

/// Properties of a force.
struct ForceTraits {
  std::string_view name;  ///< of its table
  bool drives;            ///< proportional to the factors of its curves; otherwise it only resists motion
  bool dissipates;
  std::string_view no_potential;  ///< why it has no potential, as far as is known; empty if it has one
};

/// A motion of a body at displacements u (m), and the derivatives of a power by its undeformed shape: by
/// reference positions of nodes, with u held, and by their masses. All fields are of all nodes.
struct ShapeSlopes {
  const NodalField& points;           ///< reference positions, m
  const std::vector<double>& masses;  ///< kg
  const NodalField& u;                ///< m
  const NodalField& u_rate;           ///< m/s, on which dashpots act; empty: none
  const NodalField& v;                ///< m/s, of the power
  NodalField& by_points;              ///< W/m
  std::vector<double>& by_masses;     ///< W/kg
};

/// The factors of all load curves of a scene.
using Factors = std::span<const double>;

struct FaceForces;

/// A force of a case on a mesh: immutable and shared.
class BodyForce {
 public:
  virtual ~BodyForce() = default;

  /// The nodes on which it acts, in any order.
  const std::vector<int>& nodes() const { return nodes_; }

  const ForceTraits& traits() const { return traits_; }

  /// Adds its forces, N.
  virtual void add_forces(Factors factors, const NodalMotion& motion, AtNodes<Row<double>> forces) const = 0;

  /// Adds the derivatives of the power of its forces at velocities w, as if these were constant, by the
  /// displacements and by the increments: the transposed tangent times w. Throws InputError if they are not
  /// available.
  virtual void add_derivatives_of_power(Factors factors, const NodalMotion& motion, NodalRows w,
                                        AtNodes<Row<double>> by_u,
                                        AtNodes<Row<double>> by_increment) const = 0;

  /// Adds the potential (J) at displacements u (m): the forces are minus its derivative.
  virtual void add_potential(Factors factors, NodalRows u, double& sum) const = 0;

  /// Adds the derivatives of the power of its forces by the shape of the body. Throws InputError if it has
  /// none.
  virtual void add_slopes(Factors factors, const ShapeSlopes& shape) const = 0;

  /// Adds its share to the bounds of the frequencies of all nodes of the mesh, from their masses (kg) and the
  /// largest factors of the curves.
  virtual void add_rates(Factors largest, const std::vector<double>& masses,
                         std::vector<LoadRates>& rates) const = 0;

  /// Adds the diagonal of its stiffness in the undeformed body (N/m), for the preconditioner.
  virtual void add_stiffness(AtNodes<Row<float>> diagonal) const = 0;

  /// Adds the motions that it resists in static equilibrium, however small; loads resist none.
  virtual void add_holds(std::vector<Hold>& /*holds*/) const {}

  /// Adds its magnitude at the factor one (N), whatever its direction; moments as forces at an arm (m).
  virtual void add_size(double arm, double& sum) const = 0;

  /// Its nodal loads at the factor one if they do not depend on the motion of the body; otherwise none.
  virtual std::span<const NodalLoad> dead_loads() const = 0;

  /// Its forces as programs of one face each, for other processors; none if it does not act on faces alone.
  virtual std::vector<FaceForces> face_forces() const;

  /// The same force on a part of the mesh; null if it does not act there.
  virtual std::shared_ptr<const BodyForce> restricted_to(const MeshPart& part) const = 0;

 protected:
  BodyForce(std::vector<int> nodes, const ForceTraits& traits) : nodes_(std::move(nodes)), traits_(traits) {}

 private:
  std::vector<int> nodes_;
  ForceTraits traits_;
};

/// The forces on a body, in the order in which they are summed.
using BodyForces = std::vector<std::shared_ptr<const BodyForce>>;

/// The first force that is not a dead load; null if all are.
const BodyForce* first_not_dead(const BodyForces& forces);

/// All dead loads, at the factor one.
std::vector<NodalLoad> dead_loads(const BodyForces& forces);

/// The faces that have all their nodes in a part, in the numbering of the part.
std::vector<Quadrilateral> faces_in(const MeshPart& part, const std::vector<Quadrilateral>& faces);

/// The nodes of faces, in any order.
std::vector<int> nodes_of(const std::vector<Quadrilateral>& faces);

}  // namespace sandglass
