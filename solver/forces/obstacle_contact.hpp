#pragma once

#include "forces/contact_force.hpp"
#include "forces/obstacle.hpp"
#include "forces/triangle_surface.hpp"

namespace sandglass {

/// A node that may touch an obstacle.
struct TouchingNode {
  int node;
  Vector X;          ///< m
  double stiffness;  ///< of a penalty, N/m
};

/// The curves of the displacement of an obstacle.
struct ObstacleCurves {
  std::size_t path;        ///< in the case
  std::size_t first_move;  ///< of three, by a program, m
};

/// An obstacle where it is, and the nodes that may touch it: what all methods share.
class ObstacleContact : public ContactForce {
 public:
  ObstacleContact(std::vector<TouchingNode> nodes, const Obstacle& obstacle, ObstacleShape shape,
                  const ObstacleCurves& curves, const Vector& start, const ForceTraits& traits)
      : ContactForce(numbers_of(nodes), traits),
        nodes_(std::move(nodes)),
        obstacle_(obstacle),
        shape_(std::move(shape)),
        curves_(curves),
        start_(start),
        rounding_(1e-6 * extent_of(nodes_)) {}

  const std::vector<TouchingNode>& touching() const { return nodes_; }
  const Obstacle& given() const { return obstacle_; }
  const ObstacleShape& shape() const { return shape_; }

  /// Of an undeformed node inside the obstacle displaced by `moved` (m), m; negative outside.
  double depth(const TouchingNode& one, const Vector& moved) const {
    return -gap_at(difference(one.X, moved)).distance;
  }
  double depth_at_start(const TouchingNode& one) const { return depth(one, start_); }

  /// A point of the obstacle at the start, m; none of shapes without end, which reach out of any body.
  std::optional<Vector> point_of_shape() const {
    using Shape = Obstacle::Shape;
    if (obstacle_.shape == Shape::plane || obstacle_.shape == Shape::cylinder) return std::nullopt;
    const bool is_surface = obstacle_.shape == Shape::surface;
    return sum(is_surface ? std::get<SurfaceShape>(shape_).point() : obstacle_.point, 1.0, start_);
  }

  double half_thickness() const final {
    if (obstacle_.inside) return INFINITY;
    return std::visit([](const auto& shape) { return shape.half_thickness(); }, shape_);
  }
  double travel() const final { return length(obstacle_.displacement); }
  std::optional<Movable> movable() const final { return Movable{obstacle_.label, curves_.first_move}; }

  Touch touch(const Row<double>* memory) const final {
    Touch touch = touch_of(obstacle_.label, memory);
    const Row<double>& turns = memory[3];
    touch.moment = Vector{turns[0], turns[1], turns[2]};
    return touch;
  }

  std::shared_ptr<const BodyForce> at_rest() const override;

  std::shared_ptr<const BodyForce> restricted_to(const MeshPart& part) const final {
    std::vector<TouchingNode> inside;
    for (TouchingNode one : nodes_) {
      one.node = part.part_of[at(one.node)];
      if (one.node >= 0) inside.push_back(one);
    }
    return inside.empty() ? nullptr : on(std::move(inside));
  }

 protected:
  /// The same contact of other nodes.
  virtual std::shared_ptr<const BodyForce> on(std::vector<TouchingNode> nodes) const = 0;

  bool rubs() const { return obstacle_.friction > 0.0; }

  Vector displacement(Factors factors) const {
    const Factors moves = factors.subspan(curves_.first_move, 3);
    return sum({moves[0], moves[1], moves[2]}, factors[curves_.path], obstacle_.displacement);
  }

  /// Calls use(k, x, compute_gap) for all nodes, with the position x (m) in the frame of the obstacle.
  template <class Rows, class Use>
  void for_each_node(const Vector& moved, const Rows& u, const Use& use) const {
    std::visit(
        [&](const auto& shape) {
          for (std::size_t k = 0; k < nodes_.size(); ++k) {
            const Row<double>& of_node = u[nodes_[k].node];
            Vector x = nodes_[k].X;
            for (std::size_t i = 0; i < 3; ++i) x[i] += of_node[i] - moved[i];
            use(k, x, [&] { return facing_body(shape.at(x)); });
          }
        },
        shape_);
  }

  /// Calls use(k, x, gap) for all nodes.
  template <class Rows, class Use>
  void for_each_gap(const Vector& moved, const Rows& u, const Use& use) const {
    for_each_node(moved, u,
                  [&](std::size_t k, const Vector& x, const auto& compute_gap) { use(k, x, compute_gap()); });
  }

  /// At a position (m) in its frame.
  Gap gap_at(const Vector& x) const {
    return facing_body(std::visit([&](const auto& shape) { return shape.at(x); }, shape_));
  }

  const std::vector<TouchingNode> nodes_;
  const Obstacle obstacle_;
  const ObstacleShape shape_;
  const ObstacleCurves curves_;
  const Vector start_;     // its displacement at the start, m
  const double rounding_;  // of coordinates in files, m

 private:
  static double extent_of(const std::vector<TouchingNode>& nodes) {
    double extent = 0.0;
    for (const TouchingNode& one : nodes) extent = std::max(extent, distance(one.X, nodes.front().X));
    return extent;
  }

  static std::vector<int> numbers_of(const std::vector<TouchingNode>& nodes) {
    std::vector<int> numbers;
    for (const TouchingNode& one : nodes) numbers.push_back(one.node);
    return numbers;
  }

  Gap facing_body(const Gap& gap) const {
    if (!obstacle_.inside) return gap;
    return {-gap.distance, {-gap.normal[0], -gap.normal[1], -gap.normal[2]}};
  }
};

/// By a penalty. In the frame of the obstacle, a node with the depth d is pushed along the normal by k d.
/// With friction, a spring of the same stiffness k holds it to its anchor, where it first touched; it slips,
/// and its anchor with it, so that the force along the surface is at most the coefficient of friction times k
/// d. A node that sticks thus stays.
std::shared_ptr<ObstacleContact> make_penalty_contact(std::vector<TouchingNode> nodes,
                                                      const Obstacle& obstacle, const ObstacleShape& shape,
                                                      const ObstacleCurves& curves, const Vector& start);

/// In static equilibrium, by a penalty. With friction, nodes remember where they stick from one load level to
/// the next, not from one evaluation to the next.
std::shared_ptr<ObstacleContact> make_resting_contact(std::vector<TouchingNode> nodes,
                                                      const Obstacle& obstacle, const ObstacleShape& shape,
                                                      const ObstacleCurves& curves, const Vector& start);

inline std::shared_ptr<const BodyForce> ObstacleContact::at_rest() const {
  return make_resting_contact(nodes_, obstacle_, shape_, curves_, start_);
}

/// By moving nodes. The velocity that a node would have inside the obstacle is corrected so that it ends the
/// step on the surface; it is never held there. Friction takes from its motion along the surface at most the
/// coefficient of friction times this correction, and no more than there is.
std::shared_ptr<ObstacleContact> make_kinematic_contact(std::vector<TouchingNode> nodes,
                                                        const Obstacle& obstacle, const ObstacleShape& shape,
                                                        const ObstacleCurves& curves, const Vector& start);

/// In motion, by the method of the obstacle.
inline std::shared_ptr<ObstacleContact> make_moving_contact(std::vector<TouchingNode> nodes,
                                                            const Obstacle& obstacle,
                                                            const ObstacleShape& shape,
                                                            const ObstacleCurves& curves,
                                                            const Vector& start) {
  const auto make =
      obstacle.method == Obstacle::Method::penalty ? make_penalty_contact : make_kinematic_contact;
  return make(std::move(nodes), obstacle, shape, curves, start);
}

}  // namespace sandglass
