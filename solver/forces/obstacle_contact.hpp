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

/// The displacement of an obstacle: vectors times the factors of curves, and what a program adds.
struct ObstaclePath {
  struct Leg {
    std::size_t curve;  ///< its number
    Vector along;       ///< at the factor one, m
  };
  std::vector<Leg> legs;
  std::size_t first_move;  ///< the first of three curves, set by a program, m
  Vector start;            ///< at the start, m

  Vector at(Factors factors) const {
    Vector moved{factors[first_move], factors[first_move + 1], factors[first_move + 2]};
    for (const auto& [curve, along] : legs) moved = sum(moved, factors[curve], along);
    return moved;
  }
};

/// An obstacle where it is, and the nodes that may touch it: what all methods share.
class ObstacleContact : public ContactForce {
 public:
  ObstacleContact(std::vector<TouchingNode> nodes, const Obstacle& obstacle, ObstacleShape shape,
                  ObstaclePath path, const ForceTraits& traits)
      : ContactForce(numbers_of(nodes), traits),
        nodes_(std::move(nodes)),
        obstacle_(obstacle),
        shape_(std::move(shape)),
        path_(std::move(path)),
        rounding_(1e-6 * extent_of(nodes_)) {}

  const std::vector<TouchingNode>& touching() const { return nodes_; }
  const Obstacle& given() const { return obstacle_; }
  const ObstacleShape& shape() const { return shape_; }

  /// Of an undeformed node inside the obstacle displaced by `moved` (m), m; negative outside.
  double depth(const TouchingNode& one, const Vector& moved) const {
    return -gap_at(difference(one.X, moved)).distance;
  }
  double depth_at_start(const TouchingNode& one) const { return depth(one, path_.start); }

  /// A point of the obstacle at the start, m; none of shapes without end, which reach out of any body.
  std::optional<Vector> point_of_shape() const {
    using Shape = Obstacle::Shape;
    if (obstacle_.shape == Shape::plane || obstacle_.shape == Shape::cylinder) return std::nullopt;
    const bool is_surface = obstacle_.shape == Shape::surface;
    return sum(is_surface ? std::get<SurfaceShape>(shape_).point() : obstacle_.point, 1.0, path_.start);
  }

  double half_thickness() const final { return obstacle_.inside ? INFINITY : half_of_shape(); }
  double travel(Factors changes) const final {
    double way = 0.0;
    for (std::size_t i = 0; i < 3; ++i) way += changes[path_.first_move + i];
    for (const auto& [curve, along] : path_.legs) way += changes[curve] * length(along);
    return way;
  }
  std::optional<Movable> movable() const final { return Movable{obstacle_.label, path_.first_move}; }

  Touch touch(const Row<double>* memory) const final {
    Touch touch = touch_of(obstacle_.label, memory);
    const Row<double>& turns = memory[3];
    touch.moment = Vector{turns[0], turns[1], turns[2]};
    return touch;
  }

  void begin_again(const Vector& force, const Vector& moment, Row<double>* memory) const final {
    ContactForce::begin_again(force, moment, memory);
    memory[3][3] = 0.0;
    std::fill(memory + ContactMemory::own, memory + this->memory(), Row<double>{});
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

  double half_of_shape() const {
    return std::visit([](const auto& shape) { return shape.half_thickness(); }, shape_);
  }

  /// The place (m) of a node in the frame of the obstacle.
  template <class Rows>
  Vector place_of(std::size_t k, const Rows& u, const Vector& moved) const {
    const Row<double>& of_node = u[nodes_[k].node];
    Vector x = nodes_[k].X;
    for (std::size_t i = 0; i < 3; ++i) x[i] += of_node[i] - moved[i];
    return x;
  }

  /// Calls use(k, x, gap) for all nodes, with such places x.
  template <class Rows, class Use>
  void for_each_gap(const Vector& moved, const Rows& u, const Use& use) const {
    std::visit(
        [&](const auto& shape) {
          for (std::size_t k = 0; k < nodes_.size(); ++k) {
            const Vector x = place_of(k, u, moved);
            use(k, x, facing_body(shape.at(x)));
          }
        },
        shape_);
  }

  /// At a position (m) in its frame.
  Gap gap_at(const Vector& x) const {
    return facing_body(std::visit([&](const auto& shape) { return shape.at(x); }, shape_));
  }

  /// Whether a node may have passed through, or cannot be pushed back to where it came from, that comes to a
  /// place x (m, in its frame) with this gap, straight along a way (m).
  bool passes(const Vector& x, const Gap& gap, const Vector& way) const;

  const std::vector<TouchingNode> nodes_;
  const Obstacle obstacle_;
  const ObstacleShape shape_;
  const ObstaclePath path_;
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

/// A node that comes to the inside must be pushed back against its way; one that stays outside may not have
/// been inside, except that it may cut a corner. No distance changes by more than a point moves, so that the
/// way is followed from place to place by the distance there. What is closer than `finest` may be inside.
/// Most ways are too short to cut more of a corner than is allowed, or to turn; surfaces of triangles may be
/// thinner than the box around them.
inline bool ObstacleContact::passes(const Vector& x, const Gap& gap, const Vector& way) const {
  const double far = length(way), half = half_of_shape(), most_cut = shallow * half;
  if (!obstacle_.inside && gap.distance < -deep * half) return true;
  const bool is_short = far < 2.0 * most_cut, may_be_thinner = std::holds_alternative<SurfaceShape>(shape_);
  if (gap.distance >= far || (is_short && !may_be_thinner)) return false;
  const Gap start = gap_at(difference(x, way));
  if (start.distance + gap.distance >= far) return false;
  constexpr double beyond_right_angle = -0.01;  // as sides of a box are, to the rounding of a file
  const bool turned = dot(start.normal, gap.normal) < beyond_right_angle;
  if (gap.distance < 0.0) return turned;
  if (!turned && (is_short || obstacle_.inside)) return false;
  constexpr double finest = 1e-3;  // of the way
  const double least = turned ? finest * far : -most_cut;
  for (double done = 0.0; done < 1.0;) {
    const double distance = gap_at(sum(x, done - 1.0, way)).distance;
    if (distance < least) return true;
    done += std::max(finest, std::abs(distance) / far);
  }
  return false;
}

/// By a penalty. In the frame of the obstacle, a node with the depth d is pushed along the normal by k d.
/// With friction, a spring of the same stiffness k holds it to its anchor, where it first touched; it slips,
/// and its anchor with it, so that the force along the surface is at most the coefficient of friction times k
/// d. A node that sticks thus stays.
std::shared_ptr<ObstacleContact> make_penalty_contact(std::vector<TouchingNode> nodes,
                                                      const Obstacle& obstacle, const ObstacleShape& shape,
                                                      ObstaclePath path);

/// In static equilibrium, by a penalty. With friction, nodes remember where they stick from one load level to
/// the next, not from one evaluation to the next.
std::shared_ptr<ObstacleContact> make_resting_contact(std::vector<TouchingNode> nodes,
                                                      const Obstacle& obstacle, const ObstacleShape& shape,
                                                      ObstaclePath path);

inline std::shared_ptr<const BodyForce> ObstacleContact::at_rest() const {
  return make_resting_contact(nodes_, obstacle_, shape_, path_);
}

/// By moving nodes. The velocity that a node would have inside the obstacle is corrected so that it ends the
/// step on the surface; it is never held there. Friction takes from its motion along the surface at most the
/// coefficient of friction times this correction, and no more than there is.
std::shared_ptr<ObstacleContact> make_kinematic_contact(std::vector<TouchingNode> nodes,
                                                        const Obstacle& obstacle, const ObstacleShape& shape,
                                                        ObstaclePath path);

/// In motion, by the method of the obstacle.
inline std::shared_ptr<ObstacleContact> make_moving_contact(std::vector<TouchingNode> nodes,
                                                            const Obstacle& obstacle,
                                                            const ObstacleShape& shape, ObstaclePath path) {
  const auto make =
      obstacle.method == Obstacle::Method::penalty ? make_penalty_contact : make_kinematic_contact;
  return make(std::move(nodes), obstacle, shape, std::move(path));
}

}  // namespace sandglass
