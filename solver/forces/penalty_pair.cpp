#include <algorithm>

#include "forces/surface_pair.hpp"

namespace sandglass {

namespace {

/// Points remember also a depth that does not push: where the closest point jumps, as at a rim or an edge,
/// the depth grows by more than the surfaces move, and a spring of this length would come from nothing.
/// With friction, they remember the weights of the point of the face to which a spring pulls them, and
/// its extension along the face, m. Their strength is the stiffness of the spring, N/m.
class PenaltyPair final : public SurfacePair {
 public:
  PenaltyPair(const Contact& contact, SurfacesOfPair given, const NodalField& points,
              std::span<const Hexahedron> cells)
      : SurfacePair(contact, std::move(given), points, cells, contact.friction > 0.0 ? 4 : 2, 0) {}

  void add_contact(Factors factors, NodalRows u, Row<double>* rows,
                   AtNodes<Row<double>> forces) const override {
    ContactMemory memory(rows);
    memory.pushes = memory.moves = {};
    const double friction_now = friction(factors);
    const auto use = [&](const Side& side, std::size_t k, const Vector& x, const SurfaceFoot& foot) {
      const MovingSurface &from = surfaces_[side.from], &onto = surfaces_[side.onto];
      const SurfacePoint& point = from.points()[k];
      const Row<double>* of_onto = of_surface(memory, side.onto);
      const double stiffness = 0.5 * given_.stiffness * std::min(point.area, onto.area(foot.face));
      memory.moves[3] = std::max(memory.moves[3], foot.distance());
      Row<double>* remembered = of_point(memory, side, k);
      const double pushes = share_of_depth(foot.distance(), stiffness, remembered, memory);
      const Row<double> anchor = contact_.friction > 0.0 ? hold(x, foot, friction_now, pushes * stiffness,
                                                                remembered, of_onto, memory, onto)
                                                         : foot.weights;
      remembered[0][strength] = stiffness;
      const Quadrilateral& corners = onto.corners(foot.face);
      const Vector pull = sum({}, pushes, difference(MovingSurface::position(corners, anchor, of_onto), x));
      memory.pushes[3] += 0.5 * stiffness * dot(pull, pull);
      for (std::size_t i = 0; i < 3; ++i) {
        const double force = stiffness * pull[i];
        for (std::size_t I = 0; I < 4; ++I) {
          forces[from.nodes()[at(point.nodes[I])]][i] += point.weights[I] * force;
          forces[onto.nodes()[at(corners[I])]][i] -= anchor[I] * force;
        }
        if (side.from != side.onto) memory.pushes[i] += side.from == 0 ? force : -force;
      }
    };
    for_each_touch(u, memory, use, [&](Row<double>* remembered) {
      share_of_depth(0.0, remembered[0][strength], remembered, memory);
      if (contact_.friction == 0.0) return;
      memory.sums[0] += remembered[0][strength] * lost(remembered[3]);
    });
  }

  /// A spring between material points has at most twice the stiffness on each node that it has at its points.
  /// Points of the other side pull a node with the stiffness of its area and, where they are few, of a face.
  void add_rates(Factors /*largest*/, const std::vector<double>& masses,
                 std::vector<LoadRates>& rates) const override {
    for (const Side& side : sides_) {
      const MovingSurface& surface = surfaces_[side.from];
      std::vector<double> areas(surface.nodes().size()), largest(areas.size());
      for (const SurfacePoint& point : surface.points()) {
        for (std::size_t I = 0; I < 4; ++I) areas[at(point.nodes[I])] += point.weights[I] * point.area;
      }
      for (int face = 0; face < static_cast<int>(given_.faces[side.from].size()); ++face) {
        for (const int node : surface.corners(face))
          largest[at(node)] = std::max(largest[at(node)], surface.area(face));
      }
      for (std::size_t n = 0; n < areas.size(); ++n) {
        const std::size_t node = at(surface.nodes()[n]);
        rates[node].square +=
            rate_of_one_sided * given_.stiffness * (2.0 * areas[n] + largest[n]) / masses[node];
      }
    }
  }

 private:
  /// The share of the depth (m) of a point that pushes. What the depth loses in a jump is dissipated.
  static double share_of_depth(double depth, double stiffness, Row<double>* remembered,
                               ContactMemory& memory) {
    const bool touched = remembered[0][strength] > 0.0;
    const double before = touched ? remembered[0][last_depth] : 0.0, step = memory.others[0][last_way];
    double& idle = remembered[1][0];
    if (!touched) idle = 0.0;
    const double stretched = before - idle, kept = std::max(depth + step - idle, 0.0);
    if (stretched > kept) memory.sums[0] += 0.5 * stiffness * (stretched * stretched - kept * kept);
    idle = std::min(idle + std::max(depth - before - step, 0.0), depth);
    return depth > 0.0 ? 1.0 - idle / depth : 0.0;
  }

  /// The weights of the point of the face to which the spring of a point pulls.
  Row<double> hold(const Vector& x, const SurfaceFoot& foot, double friction, double stiffness,
                   Row<double>* remembered, const Row<double>* onto, ContactMemory& memory,
                   const MovingSurface& surface) const {
    Row<double>&anchor = remembered[2], &stretch = remembered[3];
    Vector along{};
    if (remembered[0][strength] > 0.0) {
      const Quadrilateral& corners = surface.corners(static_cast<int>(remembered[0][touched_face]));
      along = difference(foot.x, MovingSurface::position(corners, anchor, onto));
      const Vector inwards = difference(foot.x, x);
      along = sum(along, -dot(along, inwards) / dot(inwards, inwards), inwards);
      // Where the closest point jumps, the point does not slip that far.
      const Vector before{stretch[0], stretch[1], stretch[2]}, change = difference(along, before);
      const double way = length(change), most = memory.others[0][last_way];
      if (way > most) along = sum(before, most / way, change);
    } else {
      stretch = {};
    }
    memory.sums[0] += stiffness * slip(along, friction * foot.distance(), stretch);
    stretch = {{along[0], along[1], along[2]}};
    anchor = surface.weights_at(foot, difference(foot.x, along), onto);
    return anchor;
  }
};

}  // namespace

std::shared_ptr<SurfacePair> make_penalty_pair(const Contact& contact, SurfacesOfPair given,
                                               const NodalField& points, std::span<const Hexahedron> cells) {
  return std::make_shared<PenaltyPair>(contact, std::move(given), points, cells);
}

}  // namespace sandglass
