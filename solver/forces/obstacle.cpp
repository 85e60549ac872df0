#include "forces/obstacle.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "forces/contact_force.hpp"
#include "forces/obstacle_shape.hpp"
#include "mesh/edges.hpp"

namespace sandglass {

namespace {

constexpr std::string_view path_of_friction = "friction depends on the path";

/// The rows that a contact keeps: three of its own, then two for each node if there is friction.
struct Memory {
  Row<double>& pushes;  ///< force on the body, N; energy, J
  Row<double>& moves;   ///< displacement of the obstacle, m; largest depth, m
  Row<double>& loses;   ///< dissipated energy, J
  Row<double>* of_friction;

  static constexpr std::size_t own = 3, by_node = 2;
  explicit Memory(Row<double>* rows)
      : pushes(rows[0]), moves(rows[1]), loses(rows[2]), of_friction(rows + own) {}
};

/// A node that may touch an obstacle.
struct TouchingNode {
  int node;
  Vector X;          ///< m
  double stiffness;  ///< of the contact, N/m
};

std::vector<int> numbers_of(const std::vector<TouchingNode>& nodes) {
  std::vector<int> numbers;
  for (const TouchingNode& one : nodes) numbers.push_back(one.node);
  return numbers;
}

/// An obstacle and the nodes that may touch it. In its frame, a node with the depth d is pushed along the
/// normal by k d. With friction, a spring of the same stiffness k holds it to its anchor, where it first
/// touched; it slips, and its anchor with it, so that the force along the surface is at most the coefficient
/// of friction times k d. A node that sticks thus stays.
class Contact final : public ContactForce {
 public:
  Contact(std::vector<TouchingNode> nodes, const Obstacle& obstacle, ObstacleShape shape, std::size_t curve,
          const Vector& start)
      : ContactForce(numbers_of(nodes), {Obstacle::name, false, obstacle.friction > 0.0,
                                         obstacle.friction > 0.0 ? path_of_friction : ""}),
        nodes_(std::move(nodes)),
        obstacle_(obstacle),
        shape_(std::move(shape)),
        curve_(curve),
        start_(start) {}

  const std::vector<TouchingNode>& touching() const { return nodes_; }

  /// Of a node inside the obstacle, m; negative outside.
  double depth_at_start(const TouchingNode& one) const { return -gap_at(one.X, start_).distance; }

  void add_contact(Factors factors, NodalRows u, Row<double>* rows,
                   AtNodes<Row<double>> forces) const override {
    Memory memory(rows);
    const Vector moved = displacement(factors);
    memory.pushes = {};
    memory.moves = {{moved[0], moved[1], moved[2], 0.0}};
    const bool sticks = obstacle_.friction > 0.0;
    for_each_gap(moved, u, [&](std::size_t k, const Vector& x, const Gap& gap) {
      const auto& [node, X, stiffness] = nodes_[k];
      Row<double>* of_node = memory.of_friction + Memory::by_node * k;
      if (gap.distance >= 0.0) {
        if (sticks && of_node[0][3] != 0.0) let_go(stiffness, of_node, memory);
        return;
      }
      const double depth = -gap.distance;
      memory.pushes[3] += 0.5 * stiffness * depth * depth;
      memory.moves[3] = std::max(memory.moves[3], depth);
      Vector force = sum({}, stiffness * depth, gap.normal);
      if (sticks) force = sum(force, -stiffness, hold(x, gap, stiffness, of_node, memory));
      for (std::size_t i = 0; i < 3; ++i) {
        forces[node][i] += force[i];
        memory.pushes[i] += force[i];
      }
    });
  }

  /// Without friction.
  void add_potential(Factors factors, NodalRows u, double& sum) const override {
    for_each_gap(displacement(factors), u, [&](std::size_t k, const Vector& /*x*/, const Gap& gap) {
      const double depth = std::max(-gap.distance, 0.0);
      sum += 0.5 * nodes_[k].stiffness * depth * depth;
    });
  }

  /// Curved obstacles have no larger stiffness in any direction, nor do springs along them.
  void add_rates(Factors /*largest*/, const std::vector<double>& masses,
                 std::vector<LoadRates>& rates) const override {
    for (const auto& [node, X, stiffness] : nodes_) rates[at(node)].square += stiffness / masses[at(node)];
  }

  void set_contact_stiffness(Factors factors, NodalRows u, AtNodes<Row<float>> roots) const override {
    for_each_gap(displacement(factors), u, [&](std::size_t k, const Vector& /*x*/, const Gap& gap) {
      const auto& [node, X, stiffness] = nodes_[k];
      if (gap.distance > 0.0) return;
      Row<float>& row = roots[node];
      const double there = row[0] * row[0] + row[1] * row[1] + row[2] * row[2];
      if (there >= stiffness) return;
      for (std::size_t i = 0; i < 3; ++i) row[i] = static_cast<float>(std::sqrt(stiffness) * gap.normal[i]);
    });
  }

  std::size_t memory() const override {
    return Memory::own + (obstacle_.friction > 0.0 ? Memory::by_node * nodes_.size() : 0);
  }

  Touch touch(const Row<double>* memory) const override {
    const Row<double>&pushes = memory[0], &moves = memory[1];
    return {obstacle_.label,
            {pushes[0], pushes[1], pushes[2]},
            {moves[0], moves[1], moves[2]},
            moves[3],
            pushes[3],
            memory[2][0]};
  }

  /// Holds nodes that touch it at the start: a load may pull them away, but then no equilibrium is found.
  void add_holds(std::vector<Hold>& holds) const override {
    for (const auto& [node, X, stiffness] : nodes_) {
      const Gap gap = gap_at(X, start_);
      if (gap.distance <= 0.0) holds.push_back({{{node, 1.0}}, gap.normal});
    }
  }

  std::string_view no_rest() const override { return traits().no_potential; }

  std::shared_ptr<const BodyForce> restricted_to(const MeshPart& part) const override {
    std::vector<TouchingNode> inside;
    for (TouchingNode one : nodes_) {
      one.node = part.part_of[at(one.node)];
      if (one.node >= 0) inside.push_back(one);
    }
    if (inside.empty()) return nullptr;
    return std::make_shared<Contact>(std::move(inside), obstacle_, shape_, curve_, start_);
  }

 private:
  Vector displacement(Factors factors) const { return sum({}, factors[curve_], obstacle_.displacement); }

  Gap facing_body(Gap gap) const {
    if (!obstacle_.inside) return gap;
    return {-gap.distance, {-gap.normal[0], -gap.normal[1], -gap.normal[2]}};
  }

  Gap gap_at(const Vector& x, const Vector& moved) const {
    return facing_body(std::visit([&](const auto& shape) { return shape.at(difference(x, moved)); }, shape_));
  }

  /// Calls use(k, x, gap) for all nodes, with the position x (m) in the frame of the obstacle.
  template <class Use>
  void for_each_gap(const Vector& moved, NodalRows u, const Use& use) const {
    std::visit(
        [&](const auto& shape) {
          for (std::size_t k = 0; k < nodes_.size(); ++k) {
            const Row<double>& of_node = u[nodes_[k].node];
            Vector x = nodes_[k].X;
            for (std::size_t i = 0; i < 3; ++i) x[i] += of_node[i] - moved[i];
            use(k, x, facing_body(shape.at(x)));
          }
        },
        shape_);
  }

  /// The extension (m) along the surface of the spring that holds a node. Work is the mean of two forces
  /// times the slip, as in the time loop.
  Vector hold(const Vector& x, const Gap& gap, double stiffness, Row<double>* of_node, Memory& memory) const {
    Row<double>&anchor = of_node[0], &stretch = of_node[1];
    if (anchor[3] == 0.0) {
      anchor = {{x[0], x[1], x[2], 1.0}};
      stretch = {};
    }
    const Vector from = difference(x, {anchor[0], anchor[1], anchor[2]});
    Vector along = sum(from, -dot(from, gap.normal), gap.normal);
    const double size = std::sqrt(dot(along, along)), most = obstacle_.friction * -gap.distance;
    if (size > most) {
      const Vector held = sum({}, most / size, along), slip = difference(along, held);
      for (std::size_t i = 0; i < 3; ++i) {
        anchor[i] += slip[i];
        memory.loses[0] += 0.5 * stiffness * (stretch[i] + held[i]) * slip[i];
      }
      along = held;
    }
    stretch = {{along[0], along[1], along[2], 0.0}};
    memory.pushes[3] += 0.5 * stiffness * dot(along, along);
    return along;
  }

  static void let_go(double stiffness, Row<double>* of_node, Memory& memory) {
    const Row<double>& stretch = of_node[1];
    for (std::size_t i = 0; i < 3; ++i) memory.loses[0] += 0.5 * stiffness * stretch[i] * stretch[i];
    of_node[0] = of_node[1] = {};
  }

  std::vector<TouchingNode> nodes_;
  Obstacle obstacle_;
  ObstacleShape shape_;
  std::size_t curve_;
  Vector start_;  // its displacement at the start, m
};

bool is_given(const Vector& v) {
  return v != Vector{};
}

ObstacleShape shape_of(const Obstacle& given) {
  const Vector axis = difference(given.end, given.point);
  switch (given.shape) {
    case Obstacle::Shape::plane:
      return PlaneShape{given.point, direction_of(given.normal, length(given.normal))};
    case Obstacle::Shape::sphere:
      return RoundShape{given.point, {}, 0.0, 0.0, given.radius};
    case Obstacle::Shape::capsule:
      return RoundShape{given.point, axis, 0.0, 1.0, given.radius};
    case Obstacle::Shape::cylinder:
      return RoundShape{given.point, axis, -INFINITY, INFINITY, given.radius};
    case Obstacle::Shape::box:
      return BoxShape{given.point, given.half_sizes};
    case Obstacle::Shape::ellipsoid:
      return EllipsoidShape{given.point, given.half_sizes};
  }
  return {};
}

/// The stiffness per area over the penalty, (lambda + 2 mu) / h, and h, of the elements with a face among
/// these nodes.
struct Scale {
  double modulus = INFINITY;  ///< Pa
  double edge = INFINITY;     ///< m

  Scale(const ForceResolver& resolver, const std::vector<Quadrilateral>& faces) {
    std::vector<bool> touches(resolver.points.size(), false);
    for (const int node : nodes_of(faces)) touches[at(node)] = true;
    for (std::size_t e = 0; e < resolver.cells.size(); ++e) {
      const Hexahedron& cell = resolver.cells[e];
      if (std::ranges::count_if(cell, [&](int node) { return touches[at(node)]; }) < 4) continue;
      modulus = std::min(modulus, resolver.wave_moduli[e]);
      for (const auto& [a, b] : hexahedron_edges)
        edge = std::min(edge, distance(resolver.points[at(cell[a])], resolver.points[at(cell[b])]));
    }
  }
};

}  // namespace

std::optional<BrokenRule> Obstacle::broken_rule() const {
  if (label.empty() || label.find('/') != std::string::npos)
    return BrokenRule{"name", fmt::format("= '{}' must be a word without '/'", label)};
  const std::string_view word = words_of(shape)[static_cast<std::size_t>(shape)];
  const bool is_plane = shape == Shape::plane, has_sizes = shape == Shape::box || shape == Shape::ellipsoid;
  const bool has_axis = shape == Shape::capsule || shape == Shape::cylinder;
  struct Need {
    const char* parameter;
    bool needed, given;
    const char* rule;
  };
  for (const auto& [parameter, needed, given, rule] :
       {Need{"normal", is_plane, is_given(normal), "must have a length"},
        Need{"end", has_axis, has_axis ? end != point : is_given(end), "must differ from point"},
        Need{"radius", !is_plane && !has_sizes, radius > 0.0, "must be positive"},
        Need{"half_sizes", has_sizes,
             has_sizes ? *std::ranges::min_element(half_sizes) > 0.0 : is_given(half_sizes),
             "must be positive"}}) {
    if (needed == given) continue;
    return BrokenRule{parameter, needed ? fmt::format("is needed for shape = '{}' and {}", word, rule)
                                        : fmt::format("has no meaning for shape = '{}'; leave it out", word)};
  }
  return std::nullopt;
}

void Obstacle::resolve(ForceResolver& resolver) const {
  const auto refuse = [&](const std::string& why) {
    throw InputError(fmt::format("{}: obstacle '{}': {}", resolver.file, label, why));
  };
  if (resolver.sets.contains(label))
    refuse("a node set has the same name, and forces are reported by name; allowed: a name of its own");
  for (const ContactForce* other : contacts_of(resolver.forces)) {
    if (other->touch(std::vector<Row<double>>(other->memory()).data()).name == label)
      refuse("another obstacle has the same name; allowed: a name of its own");
  }
  const auto faces = resolver.faces(name, set);
  const Scale scale(resolver, faces);
  std::map<int, double> areas;
  for (const Quadrilateral& face : faces) {
    for (const FacePoint& gauss : gauss_points_of(corners_of(resolver.points, face))) {
      for (std::size_t I = 0; I < 4; ++I) areas[face[I]] += gauss.N[I] * gauss.area;
    }
  }
  std::vector<TouchingNode> touching;
  for (const auto& [node, area] : areas)
    touching.push_back({node, resolver.points[at(node)], penalty * scale.modulus / scale.edge * area});
  const Vector start = sum({}, curve.at(0.0, 0.0), displacement);
  auto contact = std::make_shared<Contact>(std::move(touching), *this, shape_of(*this),
                                           resolver.number_of(curve), start);
  const auto depth_of = [&](const TouchingNode& one) { return contact->depth_at_start(one); };
  const TouchingNode deepest = *std::ranges::max_element(contact->touching(), {}, depth_of);
  constexpr double rounding = 1e-6;  // of coordinates in files, over the edge
  if (const double depth = depth_of(deepest); depth > rounding * scale.edge) {
    refuse(fmt::format(
        "node {} at ({:.6g}, {:.6g}, {:.6g}) m is {:.3g} m inside of it at the start; allowed: a body "
        "that is {} of it",
        deepest.node, deepest.X[0], deepest.X[1], deepest.X[2], depth, inside ? "within" : "outside"));
  }
  resolver.forces.push_back(std::move(contact));
}

}  // namespace sandglass
