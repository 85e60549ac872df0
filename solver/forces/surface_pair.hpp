#pragma once

#include <optional>

#include "forces/contact.hpp"
#include "forces/contact_force.hpp"
#include "forces/moving_surface.hpp"

namespace sandglass {

/// Points of a surface against faces of the other, and the other way round, or of a surface against its own
/// faces. A point behind a face that opposes it, not deeper than `reach`, is pulled by a spring to the
/// closest point of the face; with friction to a point that slips along the face and stays within the
/// coefficient of friction times the depth of it. The spring pulls both material points along the line
/// between them, so that momentum and its moment are kept. Points far from all faces are searched again only
/// when nodes have moved far enough to touch.
class SurfacePair final : public ContactForce {
 public:
  /// `stiffness` is the pressure over the depth, Pa/m; half of it acts on each side. `reach` in m. One
  /// surface touches itself.
  SurfacePair(const Contact& contact, double stiffness, double reach, const NodalField& points,
              std::span<const Hexahedron> cells, std::vector<std::vector<Quadrilateral>> surfaces);

  /// A node, or one next to a point, and its depth, m.
  struct Deepest {
    int node;
    double depth;
  };

  /// The deepest point of the undeformed body; none if there is no contact.
  std::optional<Deepest> deepest_at_start() const;

  std::size_t memory() const override;
  void add_contact(Factors factors, NodalRows u, Row<double>* rows,
                   AtNodes<Row<double>> forces) const override;
  Touch touch(const Row<double>* memory) const override;
  double half_thickness() const override { return reach_; }
  double travel() const override { return 0.0; }

  /// A spring between material points has at most twice the stiffness on each node that it has at its points.
  /// Points of the other side pull a node with the stiffness of its area and, where they are few, of a face.
  void add_rates(Factors largest, const std::vector<double>& masses,
                 std::vector<LoadRates>& rates) const override;

  std::shared_ptr<const BodyForce> restricted_to(const MeshPart& part) const override;

  // There is no static search.
  void add_contact_potential(Factors /*factors*/, NodalRows /*u*/, const Row<double>* /*memory*/,
                             double& /*sum*/) const override {}
  void set_contact_stiffness(Factors /*factors*/, NodalRows /*u*/, const Row<double>* /*memory*/,
                             AtNodes<Row<float>> /*roots*/) const override {}

 private:
  /// The points of one surface against the faces of another.
  struct Side {
    std::size_t from, onto;                    // surfaces
    std::vector<std::vector<int>> neighbours;  // faces that each point never touches
    std::size_t first_row;                     // of its points
  };

  std::size_t by_point() const { return contact_.friction > 0.0 ? 3 : 1; }

  /// Calls use(side, k, x, foot, of_point) for all points k that are behind a face, with their rows.
  template <class Use>
  void for_each_touch(NodalRows u, Row<double>* rows, const Use& use) const;

  Row<double> hold(const Vector& x, const SurfaceFoot& foot, double stiffness, Row<double>* of_point,
                   const Row<double>* onto, ContactMemory& memory, const MovingSurface& surface) const;
  void let_go(Row<double>* of_point, ContactMemory& memory) const;

  Contact contact_;
  double stiffness_, reach_;
  std::vector<std::vector<Quadrilateral>> faces_;  // of each surface
  std::vector<MovingSurface> surfaces_;
  std::vector<std::size_t> rows_of_;  // the first of each surface
  std::vector<Side> sides_;
  std::size_t memory_;
};

}  // namespace sandglass
