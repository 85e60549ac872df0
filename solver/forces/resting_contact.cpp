#include <algorithm>
#include <cmath>

#include "forces/obstacle_contact.hpp"

namespace sandglass {

namespace {

/// It keeps two rows for each node: how it would touch if that were not fixed, and contrary; its depth and
/// the depth of its constant force, m; how it touches; and its place at the last load level, in the frame of
/// the obstacle, m, and whether that is known. With friction also two rows of that level: from where the node
/// slips, in the frame of the obstacle and relative to the undeformed body, m; the extension of its spring
/// along the obstacle, m. And one for that extension when nothing was fixed, m.
class RestingContact final : public ObstacleContact {
 public:
  using ObstacleContact::ObstacleContact;

  std::shared_ptr<const BodyForce> at_rest() const override { return nullptr; }
  std::shared_ptr<const BodyForce> in_motion() const override {
    return make_moving_contact(nodes_, obstacle_, shape_, path_);
  }
  bool remembers_path() const override { return rubs(); }

  void add_contact(Factors factors, NodalRows u, Row<double>* rows,
                   AtNodes<Row<double>> forces) const override {
    ContactMemory memory(rows);
    const Vector moved = path_.at(factors);
    memory.clear_forces();
    memory.moves = {{moved[0], moved[1], moved[2], 0.0}};
    memory.sums[2] = 0.0;
    const Fixing fixing = fixing_of(rows);
    for_each_gap(moved, u, [&](std::size_t k, const Vector& x, const Gap& gap) {
      const auto& [node, X, stiffness] = nodes_[k];
      Row<double>* of_node = memory.others + by_node() * k;
      const double constant = of_node[0][2], depth = -gap.distance;
      Vector along = rubs() ? extension(k, x, gap, of_node) : Vector{};
      const double most = most_extension(gap, of_node), size = length(along);
      const bool slips = size > most && fixing != Fixing::friction;
      const double free = depth <= -constant ? not_at_all : slips ? slipping : sticking;
      double touches = fixing == Fixing::all ? of_node[0][3] : free;
      if (rubs() && fixing == Fixing::none) of_node[4] = {{along[0], along[1], along[2], 0.0}};
      if (touches == slipping && slips && turns(along, of_node[4])) touches = sticking;
      const bool is_contrary = !agrees(touches, free);
      if (is_contrary) ++memory.sums[2];
      of_node[0] = {{is_contrary ? 1.0 + free : 0.0, depth, constant, touches}};
      if (touches == not_at_all) return;
      memory.pushes[3] += 0.5 * stiffness * depth * (depth + 2.0 * constant);
      memory.moves[3] = std::max(memory.moves[3], depth);
      Vector force = sum({}, stiffness * (depth + constant), gap.normal);
      if (touches == slipping && size > most) along = sum({}, most / size, along);
      memory.pushes[3] += 0.5 * stiffness * dot(along, along);
      force = sum(force, -stiffness, along);
      for (std::size_t i = 0; i < 3; ++i) forces[node][i] += force[i];
      memory.add_force(force, difference(x, obstacle_.point));
    });
  }

  /// With friction that of a slip under constant pressure.
  void add_contact_potential(Factors factors, NodalRows u, const Row<double>* memory,
                             double& sum) const override {
    for_each_gap(path_.at(factors), u, [&](std::size_t k, const Vector& x, const Gap& gap) {
      const Row<double>* of_node = memory + ContactMemory::own + by_node() * k;
      const double constant = of_node[0][2], depth = std::max(constant - gap.distance, 0.0);
      sum += 0.5 * nodes_[k].stiffness * (depth * depth - constant * constant);
      if (!rubs() || depth == 0.0) return;
      const double size = length(extension(k, x, gap, of_node));
      sum += nodes_[k].stiffness * rubbed(size, most_extension(gap, of_node));
    });
  }

  void end_level(Factors factors, NodalRows u, bool may_shorten, Row<double>* rows) const override {
    ContactMemory memory(rows);
    for_each_gap(path_.at(factors), u, [&](std::size_t k, const Vector& x, const Gap& gap) {
      Row<double>* of_node = memory.others + by_node() * k;
      Row<double>& last = of_node[1];
      const Vector way = last[3] == 0.0 ? Vector{} : difference(x, {last[0], last[1], last[2]});
      const bool touches = of_node[0][3] != not_at_all;  // without any depth, to rounding
      const Gap there{touches ? std::min(gap.distance, -rounding_) : gap.distance, gap.normal};
      if (passes(x, there, way) || (may_shorten && touches && rounds_a_corner(x, gap, way)))
        memory.note_passed(nodes_[k].node);
      last = {{x[0], x[1], x[2], 1.0}};
      if (!rubs()) return;
      Row<double>&from = of_node[2], &stretch = of_node[3];
      Vector along{};
      if (of_node[0][3] != 0.0) {
        along = extension(k, x, gap, of_node);
        memory.sums[0] += nodes_[k].stiffness * slip(along, most_extension(gap, of_node), stretch);
      } else {
        memory.sums[0] += nodes_[k].stiffness * lost(stretch);
      }
      const Vector place = difference(difference(x, along), undeformed(k));
      from = {{place[0], place[1], place[2], 0.0}};
      stretch = {{along[0], along[1], along[2], 0.0}};
    });
  }

  bool augment(Augmentation augmentation, Row<double>* memory) const override {
    bool any = false;
    for (std::size_t k = 0; k < nodes_.size(); ++k) {
      Row<double>& of_node = ContactMemory(memory).others[by_node() * k];
      const bool touches = augmentation != Augmentation::none && of_node[3] != not_at_all;
      of_node[2] = touches ? std::max(of_node[1] + of_node[2], 0.0) : 0.0;
      any = any || of_node[2] > 0.0;
    }
    return any;
  }

  void add_rates(Factors /*largest*/, const std::vector<double>& /*masses*/,
                 std::vector<LoadRates>& /*rates*/) const override {}

  void fix_contact(Fixing fixing, Row<double>* memory) const override {
    ContactMemory(memory).sums[3] = static_cast<double>(fixing);
  }

  bool correct_contact(Row<double>* memory) const override {
    Row<double>* others = ContactMemory(memory).others;
    for (std::size_t k = nodes_.size(); k-- > 0;) {
      Row<double>& of_node = others[by_node() * k];
      if (of_node[0] == 0.0) continue;
      of_node = {{0.0, of_node[1], of_node[2], of_node[0] - 1.0}};
      return true;
    }
    return false;
  }

  void slide(Factors factors, NodalRows before, const Row<double>* memory,
             AtNodes<Row<double>> u) const override {
    const Vector moved = path_.at(factors);
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
    for_each_gap(path_.at(factors), u, [&](std::size_t k, const Vector& x, const Gap& gap) {
      if (!touches(k, gap, memory)) return;
      const double stiffness = nodes_[k].stiffness;
      Spring spring{{nodes_[k].node}, {1.0f}, 1, root_of(stiffness, gap.normal)};
      if (!rubs()) return springs.push_back(spring);
      const Row<double>* of_node = memory + ContactMemory::own + by_node() * k;
      const Vector along = extension(k, x, gap, of_node);
      const double most = most_extension(gap, of_node);
      const Fixing fixing = fixing_of(memory);
      const bool may_slip = fixing == Fixing::none || (fixing == Fixing::all && of_node[0][3] == slipping);
      const bool slips = may_slip && length(along) > most;
      add_with_friction(spring, stiffness, gap.normal, along, most, slips, obstacle_.friction, springs);
    });
  }

  std::size_t memory() const override { return ContactMemory::own + by_node() * nodes_.size(); }

  /// Holds nodes that touch it at the start: a load may pull them away, but then no equilibrium is found.
  void add_holds(std::vector<Hold>& holds) const override {
    const Rows<double> undeformed(nodes_.size());
    std::vector<int> places;
    for (const TouchingNode& one : nodes_) places.resize(std::max(places.size(), at(one.node) + 1), 0);
    for_each_gap(path_.start, NodalRows(undeformed.data(), places),
                 [&](std::size_t k, const Vector& /*x*/, const Gap& gap) {
                   if (gap.distance > rounding_) return;
                   hold_point({{nodes_[k].node, 1.0}}, gap.normal, rubs(), holds);
                 });
  }

 private:
  std::size_t by_node() const { return rubs() ? 5 : 2; }

  /// Whether a node is linearized as touching: unless it is fixed, also where body and obstacle just fit.
  bool touches(std::size_t k, const Gap& gap, const Row<double>* memory) const {
    const Row<double>* of_node = memory + ContactMemory::own + by_node() * k;
    return fixing_of(memory) == Fixing::all ? of_node[0][3] != 0.0
                                            : gap.distance <= of_node[0][2] + rounding_;
  }

  static Fixing fixing_of(const Row<double>* memory) { return static_cast<Fixing>(memory[2][3]); }

  std::shared_ptr<const BodyForce> on(std::vector<TouchingNode> nodes) const override {
    return make_resting_contact(std::move(nodes), obstacle_, shape_, path_);
  }

  /// Where a node of the undeformed body was in the frame of the obstacle, m.
  Vector undeformed(std::size_t k) const { return difference(nodes_[k].X, path_.start); }

  /// The extension (m) along the surface of the spring of a node, before it slips: its way since the last
  /// load level, or since it met the surface if it was outside.
  Vector extension(std::size_t k, const Vector& x, const Gap& gap, const Row<double>* of_node) const {
    const Row<double>& from = of_node[2];
    const Vector place = sum(undeformed(k), 1.0, {from[0], from[1], from[2]});
    return way_along(difference(x, place), gap.normal, gap.distance, gap_at(place).distance);
  }

  /// Whether a node that touches, and comes to a place x (m, in its frame) with this gap straight along a way
  /// (m), came from another side: then the way does not show on which side the load leaves it.
  bool rounds_a_corner(const Vector& x, const Gap& gap, const Vector& way) const {
    constexpr double same_side = 0.5;  // the cosine of the largest turn of the normal
    return length(way) > shallow * half_of_shape() &&
           dot(gap_at(difference(x, way)).normal, gap.normal) < same_side;
  }

  /// Whether a node that slips would now slip back: friction that stops it would push it to and fro.
  static bool turns(const Vector& along, const Row<double>& before) {
    return dot(along, {before[0], before[1], before[2]}) < 0.0;
  }

  /// The largest extension (m) that friction allows.
  double most_extension(const Gap& gap, const Row<double>* of_node) const {
    return obstacle_.friction * std::max(of_node[0][2] - gap.distance, 0.0);
  }
};

}  // namespace

std::shared_ptr<ObstacleContact> make_resting_contact(std::vector<TouchingNode> nodes,
                                                      const Obstacle& obstacle, const ObstacleShape& shape,
                                                      ObstaclePath path) {
  const bool rubs = obstacle.friction > 0.0;
  return std::make_shared<RestingContact>(
      std::move(nodes), obstacle, shape, std::move(path),
      ForceTraits{Obstacle::name, false, rubs, rubs ? path_of_friction : ""});
}

}  // namespace sandglass
