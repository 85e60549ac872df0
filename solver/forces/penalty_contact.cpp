#include <algorithm>
#include <cmath>

#include "forces/obstacle_contact.hpp"

namespace sandglass {

namespace {

constexpr std::string_view path_of_friction = "friction depends on the path";

/// It keeps rows for each node: without friction whether its fixed contact is contrary, its depth and the
/// depth of its constant force, m; with friction its anchor, m. Then whether it touches. With friction also
/// the extension of its spring, m.
class PenaltyContact final : public ObstacleContact {
 public:
  using ObstacleContact::ObstacleContact;

  void add_contact(Factors factors, NodalRows u, Row<double>* rows,
                   AtNodes<Row<double>> forces) const override {
    ContactMemory memory(rows);
    const Vector moved = displacement(factors);
    memory.clear_forces();
    memory.moves = {{moved[0], moved[1], moved[2], 0.0}};
    memory.sums[2] = 0.0;
    const bool fixed = is_fixed(rows);
    const double deepest = deep * half_thickness();
    for_each_gap(moved, u, [&](std::size_t k, const Vector& x, const Gap& gap) {
      const auto& [node, X, stiffness] = nodes_[k];
      Row<double>* of_node = memory.others + by_node() * k;
      const double constant = constant_depth(of_node);
      const bool inside = gap.distance < constant, touched = of_node[0][3] != 0.0;
      const bool touches = fixed ? touched : inside;
      if (touches != inside) ++memory.sums[2];
      if (!touches && touched) let_go(stiffness, of_node, memory);
      if (!sticks()) {
        of_node[0][0] = touches != inside ? 1.0 : 0.0;
        of_node[0][1] = -gap.distance;
      }
      if (!touches) return;
      const double depth = -gap.distance;
      if (depth > deepest) memory.note_passed(node);
      memory.pushes[3] += 0.5 * stiffness * depth * (depth + 2.0 * constant);
      memory.moves[3] = std::max(memory.moves[3], depth);
      Vector force = sum({}, stiffness * (depth + constant), gap.normal);
      if (sticks()) force = sum(force, -stiffness, hold(x, gap, stiffness, of_node, memory));
      of_node[0][3] = 1.0;
      for (std::size_t i = 0; i < 3; ++i) forces[node][i] += force[i];
      memory.add_force(force, difference(x, obstacle_.point));
    });
  }

  /// Without friction.
  void add_contact_potential(Factors factors, NodalRows u, const Row<double>* memory,
                             double& sum) const override {
    for_each_gap(displacement(factors), u, [&](std::size_t k, const Vector& /*x*/, const Gap& gap) {
      const double constant = constant_depth(memory + ContactMemory::own + by_node() * k),
                   depth = std::max(constant - gap.distance, 0.0);
      sum += 0.5 * nodes_[k].stiffness * (depth * depth - constant * constant);
    });
  }

  bool augment(bool augmented, Row<double>* memory) const override {
    if (sticks()) return false;
    bool any = false;
    for (std::size_t k = 0; k < nodes_.size(); ++k) {
      Row<double>& of_node = ContactMemory(memory).others[k];
      of_node[2] = augmented && of_node[3] != 0.0 ? std::max(of_node[1] + of_node[2], 0.0) : 0.0;
      any = any || of_node[2] > 0.0;
    }
    return any;
  }

  /// Curved obstacles have no larger stiffness in any direction, nor do springs along them.
  void add_rates(Factors /*largest*/, const std::vector<double>& masses,
                 std::vector<LoadRates>& rates) const override {
    for (const auto& [node, X, stiffness] : nodes_)
      rates[at(node)].square += rate_of_one_sided * stiffness / masses[at(node)];
  }

  void fix_contact(bool fixed, Row<double>* memory) const override {
    ContactMemory(memory).sums[3] = fixed ? 1.0 : 0.0;
  }

  bool correct_contact(Row<double>* memory) const override {
    Row<double>* others = ContactMemory(memory).others;
    for (std::size_t k = nodes_.size(); k-- > 0;) {
      Row<double>& of_node = others[by_node() * k];
      if (of_node[0] == 0.0) continue;
      of_node = {{0.0, of_node[1], of_node[2], 1.0 - of_node[3]}};
      return true;
    }
    return false;
  }

  void slide(Factors factors, NodalRows before, const Row<double>* memory,
             AtNodes<Row<double>> u) const override {
    const Vector moved = displacement(factors);
    for_each_gap(moved, before, [&](std::size_t k, const Vector& from, const Gap& gap) {
      if (!touches(k, gap, memory)) return;
      const auto& [node, X, stiffness] = nodes_[k];
      Vector x = X;
      for (std::size_t i = 0; i < 3; ++i) x[i] += u[node][i] - moved[i];
      const Gap there = gap_at(x);
      const double up = gap.distance + dot(gap.normal, difference(x, from)) - there.distance;
      for (std::size_t i = 0; i < 3; ++i) u[node][i] += up * there.normal[i];
    });
  }

  void add_springs(Factors factors, NodalRows u, const Row<double>* memory,
                   std::vector<Spring>& springs) const override {
    for_each_gap(displacement(factors), u, [&](std::size_t k, const Vector& /*x*/, const Gap& gap) {
      if (!touches(k, gap, memory)) return;
      springs.push_back({{nodes_[k].node}, {1.0f}, 1, root_of(nodes_[k].stiffness, gap.normal)});
    });
  }

  std::size_t memory() const override { return ContactMemory::own + by_node() * nodes_.size(); }

  /// Holds nodes that touch it at the start: a load may pull them away, but then no equilibrium is found.
  void add_holds(std::vector<Hold>& holds) const override {
    const Rows<double> undeformed(nodes_.size());
    std::vector<int> places;
    for (const TouchingNode& one : nodes_) places.resize(std::max(places.size(), at(one.node) + 1), 0);
    for_each_gap(start_, NodalRows(undeformed.data(), places),
                 [&](std::size_t k, const Vector& /*x*/, const Gap& gap) {
                   if (gap.distance <= 0.0) holds.push_back({{{nodes_[k].node, 1.0}}, gap.normal});
                 });
  }

 private:
  bool sticks() const { return obstacle_.friction > 0.0; }
  std::size_t by_node() const { return sticks() ? 2 : 1; }

  /// Whether a node is linearized as touching: unless it is fixed, also where body and obstacle just fit.
  bool touches(std::size_t k, const Gap& gap, const Row<double>* memory) const {
    const Row<double>* of_node = memory + ContactMemory::own + by_node() * k;
    return is_fixed(memory) ? of_node[0][3] != 0.0 : gap.distance <= constant_depth(of_node) + rounding_;
  }

  /// The depth (m) whose force is constant.
  double constant_depth(const Row<double>* of_node) const { return sticks() ? 0.0 : of_node[0][2]; }

  static bool is_fixed(const Row<double>* memory) { return memory[2][3] != 0.0; }

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
    if (!sticks()) return;
    Row<double>& stretch = of_node[1];
    for (std::size_t i = 0; i < 3; ++i) memory.sums[0] += 0.5 * stiffness * stretch[i] * stretch[i];
    stretch = {};
  }
};

}  // namespace

std::shared_ptr<ObstacleContact> make_penalty_contact(std::vector<TouchingNode> nodes,
                                                      const Obstacle& obstacle, const ObstacleShape& shape,
                                                      const ObstacleCurves& curves, const Vector& start) {
  const bool rubs = obstacle.friction > 0.0;
  return std::make_shared<PenaltyContact>(
      std::move(nodes), obstacle, shape, curves, start,
      ForceTraits{Obstacle::name, false, rubs, rubs ? path_of_friction : ""});
}

}  // namespace sandglass
