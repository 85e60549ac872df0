#include <algorithm>
#include <cmath>

#include "forces/obstacle_contact.hpp"

namespace sandglass {

namespace {

constexpr std::string_view in_motions = "it acts in motions";

/// It keeps a row for each node: its place at the last evaluation, in the frame of the obstacle, m; whether
/// that is known, and whether it touched. With friction also two rows: its anchor and the extension of its
/// spring, m.
class PenaltyContact final : public ObstacleContact {
 public:
  using ObstacleContact::ObstacleContact;

  void add_contact(Factors factors, NodalRows u, Row<double>* rows,
                   AtNodes<Row<double>> forces) const override {
    ContactMemory memory(rows);
    const Vector moved = path_.at(factors);
    memory.clear_forces();
    memory.moves = {{moved[0], moved[1], moved[2], 0.0}};
    for_each_gap(moved, u, [&](std::size_t k, const Vector& x, const Gap& gap) {
      const auto& [node, X, stiffness] = nodes_[k];
      Row<double>* of_node = memory.others + by_node() * k;
      const Row<double> last = of_node[0];
      const double depth = -gap.distance;
      of_node[0] = {{x[0], x[1], x[2], depth > 0.0 ? touching : apart}};
      const Vector way = last[3] == unknown ? Vector{} : difference(x, {last[0], last[1], last[2]});
      if (passes(x, gap, way)) memory.note_passed(node);
      if (!(depth > 0.0)) {
        if (last[3] == touching && rubs()) let_go(stiffness, of_node[2], memory);
        return;
      }
      memory.pushes[3] += 0.5 * stiffness * depth * depth;
      memory.moves[3] = std::max(memory.moves[3], depth);
      Vector force = sum({}, stiffness * depth, gap.normal);
      if (rubs())
        force = sum(force, -stiffness, hold(x, gap, stiffness, last[3] != touching, of_node, memory));
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
  /// What is known of the last place of a node.
  static constexpr double unknown = 0.0, apart = 1.0, touching = 2.0;

  std::size_t by_node() const { return rubs() ? 3 : 1; }

  std::shared_ptr<const BodyForce> on(std::vector<TouchingNode> nodes) const override {
    return make_penalty_contact(std::move(nodes), obstacle_, shape_, path_);
  }

  /// The extension (m) along the surface of the spring that holds a node, from here if it is new.
  Vector hold(const Vector& x, const Gap& gap, double stiffness, bool is_new, Row<double>* of_node,
              ContactMemory& memory) const {
    Row<double>&anchor = of_node[1], &stretch = of_node[2];
    if (is_new) {
      anchor = {{x[0], x[1], x[2], 0.0}};
      stretch = {};
    }
    const Vector from = difference(x, {anchor[0], anchor[1], anchor[2]});
    Vector along = sum(from, -dot(from, gap.normal), gap.normal);
    memory.sums[0] += stiffness * slip(along, obstacle_.friction * -gap.distance, stretch);
    // At the depth of the node: where a normal turns, at an edge, the spring is not stretched.
    const Vector now = difference(x, along);
    anchor = {{now[0], now[1], now[2], 0.0}};
    stretch = {{along[0], along[1], along[2], 0.0}};
    memory.pushes[3] += 0.5 * stiffness * dot(along, along);
    return along;
  }

  static void let_go(double stiffness, Row<double>& stretch, ContactMemory& memory) {
    memory.sums[0] += stiffness * lost(stretch);
    stretch = {};
  }
};

}  // namespace

std::shared_ptr<ObstacleContact> make_penalty_contact(std::vector<TouchingNode> nodes,
                                                      const Obstacle& obstacle, const ObstacleShape& shape,
                                                      ObstaclePath path) {
  return std::make_shared<PenaltyContact>(
      std::move(nodes), obstacle, shape, std::move(path),
      ForceTraits{Obstacle::name, false, obstacle.friction > 0.0, in_motions});
}

}  // namespace sandglass
