#include <algorithm>
#include <cmath>

#include "forces/obstacle_contact.hpp"

namespace sandglass {

namespace {

constexpr std::string_view in_motions = "it acts in motions";

/// It keeps a row for each node: with friction its anchor, m; then whether it touches. With friction also a
/// row with the extension of its spring, m.
class PenaltyContact final : public ObstacleContact {
 public:
  using ObstacleContact::ObstacleContact;

  void add_contact(Factors factors, NodalRows u, Row<double>* rows,
                   AtNodes<Row<double>> forces) const override {
    ContactMemory memory(rows);
    const Vector moved = displacement(factors);
    memory.clear_forces();
    memory.moves = {{moved[0], moved[1], moved[2], 0.0}};
    const double deepest = deep * half_thickness();
    for_each_gap(moved, u, [&](std::size_t k, const Vector& x, const Gap& gap) {
      const auto& [node, X, stiffness] = nodes_[k];
      Row<double>* of_node = memory.others + by_node() * k;
      const double depth = -gap.distance;
      if (!(depth > 0.0)) {
        if (of_node[0][3] != 0.0) let_go(stiffness, of_node, memory);
        return;
      }
      if (depth > deepest) memory.note_passed(node);
      memory.pushes[3] += 0.5 * stiffness * depth * depth;
      memory.moves[3] = std::max(memory.moves[3], depth);
      Vector force = sum({}, stiffness * depth, gap.normal);
      if (rubs()) force = sum(force, -stiffness, hold(x, gap, stiffness, of_node, memory));
      of_node[0][3] = 1.0;
      for (std::size_t i = 0; i < 3; ++i) forces[node][i] += force[i];
      memory.add_force(force, difference(x, obstacle_.point));
    });
  }

  void add_contact_potential(Factors /*factors*/, NodalRows /*u*/, const Row<double>* /*memory*/,
                             double& /*sum*/) const override {}
  void add_springs(Factors /*factors*/, NodalRows /*u*/, const Row<double>* /*memory*/,
                   std::vector<Spring>& /*springs*/) const override {}

  /// Curved obstacles have no larger stiffness in any direction, nor do springs along them.
  void add_rates(Factors /*largest*/, const std::vector<double>& masses,
                 std::vector<LoadRates>& rates) const override {
    for (const auto& [node, X, stiffness] : nodes_)
      rates[at(node)].square += rate_of_one_sided * stiffness / masses[at(node)];
  }

  std::size_t memory() const override { return ContactMemory::own + by_node() * nodes_.size(); }

 private:
  std::size_t by_node() const { return rubs() ? 2 : 1; }

  std::shared_ptr<const BodyForce> on(std::vector<TouchingNode> nodes) const override {
    return make_penalty_contact(std::move(nodes), obstacle_, shape_, curves_, start_);
  }

  /// The extension (m) along the surface of the spring that holds a node.
  Vector hold(const Vector& x, const Gap& gap, double stiffness, Row<double>* of_node,
              ContactMemory& memory) const {
    Row<double>&anchor = of_node[0], &stretch = of_node[1];
    if (anchor[3] == 0.0) {
      anchor = {{x[0], x[1], x[2], 1.0}};
      stretch = {};
    }
    const Vector from = difference(x, {anchor[0], anchor[1], anchor[2]});
    Vector along = sum(from, -dot(from, gap.normal), gap.normal);
    memory.sums[0] += stiffness * slip(along, obstacle_.friction * -gap.distance, stretch);
    // At the depth of the node: where a normal turns, at an edge, the spring is not stretched.
    const Vector now = difference(x, along);
    anchor = {{now[0], now[1], now[2], 1.0}};
    stretch = {{along[0], along[1], along[2], 0.0}};
    memory.pushes[3] += 0.5 * stiffness * dot(along, along);
    return along;
  }

  void let_go(double stiffness, Row<double>* of_node, ContactMemory& memory) const {
    of_node[0][3] = 0.0;
    if (!rubs()) return;
    Row<double>& stretch = of_node[1];
    memory.sums[0] += stiffness * lost(stretch);
    stretch = {};
  }
};

}  // namespace

std::shared_ptr<ObstacleContact> make_penalty_contact(std::vector<TouchingNode> nodes,
                                                      const Obstacle& obstacle, const ObstacleShape& shape,
                                                      const ObstacleCurves& curves, const Vector& start) {
  return std::make_shared<PenaltyContact>(
      std::move(nodes), obstacle, shape, curves, start,
      ForceTraits{Obstacle::name, false, obstacle.friction > 0.0, in_motions});
}

}  // namespace sandglass
