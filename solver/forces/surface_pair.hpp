#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "forces/contact.hpp"
#include "forces/contact_force.hpp"
#include "forces/moving_surface.hpp"

namespace sandglass {

/// What a pair of surfaces acts with: one surface touches itself.
struct SurfacesOfPair {
  std::vector<std::vector<Quadrilateral>> faces;  ///< of one or two surfaces
  double stiffness;                               ///< of a penalty: pressure over depth, Pa/m
  double reach;                                   ///< the largest depth that is followed, m
  std::size_t friction_curve;                     ///< number of the curve with the factor of the friction
};

class SurfacePair;

/// A pair of motions in static equilibrium, between two surfaces. Points that touch are pushed along the
/// normal of a triangle of the face, and rub.
std::shared_ptr<const BodyForce> make_resting_pair(std::shared_ptr<const SurfacePair> pair);

/// Points of a surface against faces of the other, and the other way round, or of a surface against its own
/// faces: what all methods share. A point touches if it is behind a face that opposes it, not deeper than the
/// reach. Points far from all faces are searched again only when nodes have moved far enough to touch.
class SurfacePair : public ContactForce, public std::enable_shared_from_this<SurfacePair> {
 public:
  /// A node, or one next to a point, and its depth, m.
  struct Deepest {
    int node;
    double depth;
  };

  /// The deepest point of the undeformed body; none if there is no contact.
  std::optional<Deepest> deepest_at_start() const;

  const Contact& contact() const { return contact_; }
  std::size_t memory() const final { return memory_; }
  Touch touch(const Row<double>* memory) const final { return touch_of(contact_.label, memory); }
  double half_thickness() const final { return given_.reach; }
  double travel(Factors /*changes*/) const final { return 0.0; }
  std::shared_ptr<const BodyForce> restricted_to(const MeshPart& part) const override;
  std::shared_ptr<const BodyForce> at_rest() const override { return make_resting_pair(shared_from_this()); }

  // In motions there is no search for equilibrium.
  void add_contact_potential(Factors /*factors*/, NodalRows /*u*/, const Row<double>* /*memory*/,
                             double& /*sum*/) const override {}
  void add_springs(Factors /*factors*/, NodalRows /*u*/, const Row<double>* /*memory*/,
                   std::vector<Spring>& /*springs*/) const override {}

 protected:
  /// What a pair remembers in its first row: the sum of the largest relative motions of nodes, m; the last of
  /// them, infinite at first.
  enum OfPair : std::size_t { way_so_far = 0, last_way = 1 };

  /// What points remember in their first row: until which way they touch nothing, m; the face that they
  /// touch; their strength, zero if they do not touch; their depth then, m.
  enum OfPoint : std::size_t { clear_until = 0, touched_face = 1, strength = 2, last_depth = 3 };

  /// The points of one surface against the faces of another.
  struct Side {
    std::size_t from, onto;                    // surfaces
    std::vector<std::vector<int>> neighbours;  // faces that each point never touches
    std::size_t first_row;                     // of its points
  };

  /// `by_point` and `by_node` are the numbers of rows that points and nodes remember.
  SurfacePair(const Contact& contact, SurfacesOfPair given, const NodalField& points,
              std::span<const Hexahedron> cells, std::size_t by_point, std::size_t by_node);

  /// The same surfaces, with as many rows of points.
  SurfacePair(const SurfacePair& other, std::size_t by_point, const ForceTraits& traits);

  /// Moves the surfaces to displacements u (m), and returns the motions of nodes since the last evaluation.
  template <class Displacements>
  Motions move(const Displacements& u, ContactMemory& memory) const;

  Row<double>* of_point(ContactMemory& memory, const Side& side, std::size_t k) const {
    return memory.others + side.first_row + by_point_ * k;
  }

  /// The rows of a surface; then those of its nodes.
  Row<double>* of_surface(ContactMemory& memory, std::size_t s) const { return memory.others + rows_of_[s]; }
  Row<double>* of_nodes(ContactMemory& memory, std::size_t s) const {
    return of_surface(memory, s) + surfaces_[s].rows();
  }

  /// A node with the largest weight.
  static int node_of(const MovingSurface& surface, const SurfacePoint& point);

  /// Coulomb's coefficient now. Throws InputError where the curve makes it negative.
  double friction(Factors factors) const;

  /// Calls use(side, k, x, foot) for all points k at x (m) that touch at displacements u (m), and
  /// let_go(of_point) for points that touched before and do not now.
  template <class Displacements, class Use, class LetGo>
  void for_each_touch(const Displacements& u, ContactMemory& memory, const Use& use,
                      const LetGo& let_go) const;

  const Contact contact_;
  const SurfacesOfPair given_;
  std::vector<MovingSurface> surfaces_;
  std::vector<Side> sides_;

 private:
  /// Places the rows in the memory.
  void lay_out(std::size_t by_node);

  const std::size_t by_point_;
  std::vector<std::size_t> rows_of_;  // the first of each surface
  std::size_t memory_ = ContactMemory::own + 1;
};

template <class Displacements>
Motions SurfacePair::move(const Displacements& u, ContactMemory& memory) const {
  Row<double>& of_pair = memory.others[0];
  double& way = of_pair[way_so_far];
  const bool is_first = way == 0.0;
  Motions motions;
  for (std::size_t s = 0; s < surfaces_.size(); ++s)
    surfaces_[s].move(u, is_first, of_surface(memory, s), motions);
  of_pair[last_way] = is_first ? INFINITY : motions.largest_relative();
  way += is_first ? given_.reach : of_pair[last_way];
  return motions;
}

template <class Displacements, class Use, class LetGo>
void SurfacePair::for_each_touch(const Displacements& u, ContactMemory& memory, const Use& use,
                                 const LetGo& let_go) const {
  const Motions motions = move(u, memory);
  const double way = memory.others[0][way_so_far];
  constexpr double opposed = -0.1;  // see closest; sides of bodies may lean over points beside them
  // Within one step, points of fast bodies may pass deeper than the reach.
  const double range = std::max(given_.reach, motions.largest_relative());
  bool fits = false;
  for (const Side& side : sides_) {
    const MovingSurface &from = surfaces_[side.from], &onto = surfaces_[side.onto];
    Row<double>*of_from = of_surface(memory, side.from), *of_onto = of_surface(memory, side.onto);
    for (std::size_t k = 0; k < from.points().size(); ++k) {
      Row<double>& one = of_point(memory, side, k)[0];
      if (one[clear_until] > way) continue;
      if (!fits) {
        for (std::size_t s = 0; s < surfaces_.size(); ++s) surfaces_[s].fit(of_surface(memory, s));
        fits = true;
      }
      const SurfacePoint& point = from.points()[k];
      const Vector x = MovingSurface::position(point.nodes, point.weights, of_from);
      const SurfaceFoot foot = onto.closest(x, from.normal(point.nodes, point.weights, of_from), opposed,
                                            range, side.neighbours[k], of_onto);
      one[clear_until] = foot.behind ? way : way + foot.distance();
      const bool is_deeper = foot.behind && foot.distance() > given_.reach;
      if (is_deeper) memory.note_passed(node_of(from, point));
      if (foot.behind && !is_deeper) {
        use(side, k, x, foot);
        one[touched_face] = foot.face;
        one[last_depth] = foot.distance();
      } else if (one[strength] > 0.0) {
        if (one[last_depth] > deep * given_.reach) memory.note_passed(node_of(from, point));
        let_go(&one);
        one[strength] = 0.0;
      }
    }
  }
}

/// By a penalty: a spring pulls a point that touches to the closest point of the face; with friction to a
/// point that slips along the face and stays within the coefficient of friction times the depth of it. The
/// spring pulls both material points along the line between them, so that momentum and its moment are kept.
/// Half of the stiffness acts on each side. Springs of points are not stiffer than those of the faces they
/// touch.
std::shared_ptr<SurfacePair> make_penalty_pair(const Contact& contact, SurfacesOfPair given,
                                               const NodalField& points, std::span<const Hexahedron> cells);

/// By moving nodes: within a step, points that touch are moved back to the closest point of the face, and the
/// face to them, by impulses along the line between them, the smallest that separate all points. Friction
/// takes from their relative motion along the face at most the coefficient of friction times the impulse.
std::shared_ptr<SurfacePair> make_kinematic_pair(const Contact& contact, SurfacesOfPair given,
                                                 const NodalField& points, std::span<const Hexahedron> cells);

/// By the method of the contact.
std::shared_ptr<SurfacePair> make_surface_pair(const Contact& contact, SurfacesOfPair given,
                                               const NodalField& points, std::span<const Hexahedron> cells);

}  // namespace sandglass
