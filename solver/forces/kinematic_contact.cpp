#include <algorithm>
#include <cmath>

#include "forces/obstacle_contact.hpp"

namespace sandglass {

namespace {

constexpr std::string_view in_steps = "it moves nodes within time steps";

/// A row for the position (m) of the obstacle at the end of the last step, one for its motion in it, and for
/// each node one for what is known of the gap: the normal at the end of the step, or, of a node outside, the
/// place in the frame of the obstacle where its distance was last computed, and the distance (m). Nearer to
/// that place than this, it is still outside.
class KinematicContact final : public ObstacleContact {
 public:
  using ObstacleContact::ObstacleContact;

  void push_out(Factors factors, const NodalPush& nodes) const override {
    ContactMemory memory(nodes.memory);
    const Vector moved = path_.at(factors);
    Row<double>&position = memory.others[0], &last_way = memory.others[1];
    const bool is_first = position[3] == 0.0;
    const Vector before = is_first ? path_.start : Vector{position[0], position[1], position[2]};
    const Step step{difference(moved, before), {last_way[0], last_way[1], last_way[2]}, is_first};
    memory.clear_forces();
    for (std::size_t k = 0; k < nodes_.size(); ++k) {
      const Vector x = place_of(k, nodes.u, moved);
      if (!is_outside(x, memory.others[own + k])) push_out(k, x, step, nodes, memory);
    }
    position = {{moved[0], moved[1], moved[2], 1.0}};
    last_way = row_of(step.way);
  }

  bool moves_nodes() const override { return true; }
  void add_contact(Factors /*factors*/, NodalRows /*u*/, Row<double>* /*memory*/,
                   AtNodes<Row<double>> /*forces*/) const override {}
  void add_contact_potential(Factors /*factors*/, NodalRows /*u*/, const Row<double>* /*memory*/,
                             double& /*sum*/) const override {}
  void add_rates(Factors /*largest*/, const std::vector<double>& /*masses*/,
                 std::vector<LoadRates>& /*rates*/) const override {}
  void add_springs(Factors /*factors*/, NodalRows /*u*/, const Row<double>* /*memory*/,
                   std::vector<Spring>& /*springs*/) const override {}
  std::size_t memory() const override { return ContactMemory::own + own + nodes_.size(); }

 private:
  static constexpr std::size_t own = 2;

  /// The motion of the obstacle in a step.
  struct Step {
    Vector way, last_way;  ///< m, in this step and in the one before
    bool is_first;
  };

  /// Moves a node, at x (m) in the frame of the obstacle, unless it is outside. The force on it is its mass
  /// times the change of velocity over the step. It acts between two steps, so the obstacle works with the
  /// mean of its motions. Out of line, as few nodes are near.
  [[gnu::noinline]] void push_out(std::size_t k, const Vector& x, const Step& step, const NodalPush& nodes,
                                  ContactMemory& memory) const {
    Row<double>& known = memory.others[own + k];
    const int node = nodes_[k].node;
    Row<double>& increment = nodes.increment[node];
    const Vector motion = difference({increment[0], increment[1], increment[2]}, step.way);
    Gap gap = gap_at(x);
    if (passes(x, gap, motion)) memory.note_passed(node);
    if (gap.distance < 0.0) {
      const Vector start = step.is_first || known[3] > 0.0 ? gap_at(difference(x, motion)).normal
                                                           : Vector{known[0], known[1], known[2]};
      const Row<double>& w = nodes.inverse_masses[node];
      const bool in_box = obstacle_.inside && obstacle_.shape == Obstacle::Shape::box;
      const bool across_edge = in_box || dot(start, gap.normal) < same_side;
      const Vector change = across_edge ? correction_at_edge(x, gap, motion, w)
                                        : correction(gap.distance, start, gap.normal, motion, w);
      if (across_edge) gap.normal = gap_at(sum(x, 1.0, change)).normal;
      Vector force{};
      for (std::size_t i = 0; i < 3; ++i) {
        if (!(w[i] > 0.0)) continue;
        nodes.u[node][i] += change[i];
        increment[i] += change[i];
        force[i] = change[i] / (w[i] * nodes.gain);
        memory.sums[1] += 0.5 * force[i] * (step.last_way[i] + step.way[i]);
      }
      memory.add_force(force, difference(sum(x, 1.0, change), obstacle_.point));
    }
    known = gap.distance > 0.0 ? Row<double>{{x[0], x[1], x[2], gap.distance}} : row_of(gap.normal);
  }

  /// No distance changes by more than a point moves.
  static bool is_outside(const Vector& x, const Row<double>& known) {
    double square = 0.0;
    for (std::size_t i = 0; i < 3; ++i) square += (x[i] - known[i]) * (x[i] - known[i]);
    return square < known[3] * known[3];
  }

  static Row<double> row_of(const Vector& v) { return {{v[0], v[1], v[2], 0.0}}; }

  std::shared_ptr<const BodyForce> on(std::vector<TouchingNode> nodes) const override {
    return make_kinematic_contact(std::move(nodes), obstacle_, shape_, path_);
  }

  /// The least cosine between the normals where a step starts and where it ends, unless an edge of the
  /// obstacle is between them.
  static constexpr double same_side = 0.95;

  /// Near an edge the nearest side of an obstacle need not be the one through which a node came: it stops at
  /// that one, and if it is still inside, at the nearest. In a cavity the nearest place is right; in a box
  /// always, whose sides are flat.
  Vector correction_at_edge(const Vector& x, const Gap& gap, const Vector& motion,
                            const Row<double>& w) const {
    if (obstacle_.inside) return correction(gap.distance, gap.normal, gap.normal, motion, w);
    const Gap start = gap_at(difference(x, motion));
    Vector change = correction(std::min(start.distance + dot(motion, start.normal), 0.0), start.normal,
                               start.normal, motion, w);
    constexpr int most_sides = 3;
    for (int side = 1; side < most_sides; ++side) {
      const Gap left = gap_at(sum(x, 1.0, change));
      if (left.distance >= 0.0) break;
      change =
          sum(change, 1.0, correction(left.distance, left.normal, left.normal, sum(motion, 1.0, change), w));
    }
    return change;
  }

  /// The change (m) of the motion of a node in a step that brings it from a distance (m, negative) to the
  /// surface with a normal, with friction; zero where a component is constrained (w = 0). The force has the
  /// direction of the normal where the step starts, as it acts there: over the steps before and after it, a
  /// node that slides along a curve moves at right angles to it. The normal at the end would push it on with
  /// every step.
  Vector correction(double distance, const Vector& direction, const Vector& normal, const Vector& motion,
                    const Row<double>& w) const {
    Vector free = direction;
    for (std::size_t i = 0; i < 3; ++i) free[i] = w[i] > 0.0 ? free[i] : 0.0;
    const double share = dot(free, normal);
    constexpr double least_share = 1e-6;
    if (share < least_share) return {};
    const double outwards = -distance / share;
    Vector change = sum({}, outwards, free);
    if (obstacle_.friction == 0.0) return change;
    const Vector along = sum(motion, -dot(motion, direction), direction);
    const double size = std::sqrt(dot(along, along)), most = obstacle_.friction * outwards;
    if (size > 0.0) change = sum(change, -std::min(1.0, most / size), along);
    for (std::size_t i = 0; i < 3; ++i) change[i] = w[i] > 0.0 ? change[i] : 0.0;
    return change;
  }
};

}  // namespace

std::shared_ptr<ObstacleContact> make_kinematic_contact(std::vector<TouchingNode> nodes,
                                                        const Obstacle& obstacle, const ObstacleShape& shape,
                                                        ObstaclePath path) {
  return std::make_shared<KinematicContact>(std::move(nodes), obstacle, shape, std::move(path),
                                            ForceTraits{Obstacle::name, false, true, in_steps});
}

}  // namespace sandglass
