#include "problem/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/error.hpp"
#include "mesh/hash.hpp"
#include "mesh/hexahedron.hpp"
#include "mesh/quality.hpp"
#include "problem/masses.hpp"
#include "problem/scene_materials.hpp"
#include "problem/scene_refinement.hpp"
#include "problem/scene_ties.hpp"

namespace sandglass {

namespace {

/// The paths of the three components of a node at X that turns about a center: with its arm r about the axis
/// a, (R - 1)(X - c) = -(1 - cos) r + sin a x r.
std::array<ImposedPath, 3> turning_paths(const ImposedRotation& turned, const Vector& X, const Vector& center,
                                         std::size_t angle) {
  const Vector& a = turned.axis;
  Vector r{};
  double along = 0.0;
  for (std::size_t i = 0; i < 3; ++i) along += a[i] * (X[i] - center[i]);
  for (std::size_t i = 0; i < 3; ++i) r[i] = X[i] - center[i] - along * a[i];
  std::array<ImposedPath, 3> paths;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    paths[i].share = {turned.displacement[i], -r[i], a[j] * r[k] - a[k] * r[j]};
    const bool turns = angle > 0 && (paths[i].share[1] != 0.0 || paths[i].share[2] != 0.0);
    paths[i] = turns ? ImposedPath{paths[i].share, angle} : ImposedPath{{turned.displacement[i]}};
  }
  return paths;
}

std::string described(const ImposedPath& path, const std::vector<double>& angles) {
  if (path.angle == 0) return fmt::to_string(path.share[0]);
  return fmt::format("{} turning by {:.6g} rad", path.share[0], angles[path.angle]);
}

/// Node and component -> path; a second path must equal the first.
class ImposedPaths {
 public:
  ImposedPaths(const Case& description, const std::vector<double>& angles)
      : description_(description), angles_(angles) {}

  void add(int node, std::size_t component, const ImposedPath& path, const std::string& set) {
    const Origin origin{path, set};
    const Origin& first = imposed_.try_emplace({node, static_cast<int>(component)}, origin).first->second;
    if (first.path == path) return;
    throw InputError(fmt::format(
        "{}: node {} is given two displacements in {}: {} by set '{}' and {} by set '{}'; a node may be in "
        "two sets only if both impose the same value",
        description_.file.string(), node, "xyz"[component], described(first.path, angles_), first.set,
        described(path, angles_), set));
  }

  std::vector<Constraint> constraints() const {
    std::vector<Constraint> all;
    for (const auto& [key, origin] : imposed_) all.push_back({key.first, key.second, origin.path});
    return all;
  }

 private:
  struct Origin {
    ImposedPath path;
    std::string set;
  };
  const Case& description_;
  const std::vector<double>& angles_;
  std::map<std::pair<int, int>, Origin> imposed_;
};

/// Sets the constraints; their angles are added to those that are known.
void make_constraints(Scene& scene) {
  const NodalField& points = scene.mesh.points;
  std::vector<double>& angles = scene.angles;
  ImposedPaths imposed(scene.description, angles);
  for (const auto& displacement : scene.description.displacements) {
    for (const int node : node_set(scene, "displacement.set", displacement.set)) {
      for (std::size_t i = 0; i < 3; ++i) {
        if (!displacement.components[i]) continue;
        imposed.add(node, i, {{displacement.value[i]}}, displacement.set);
      }
    }
  }
  for (const auto& turned : scene.description.rotations) {
    const auto& nodes = node_set(scene, "rotation.set", turned.set);
    const Vector center = turned.center.value_or(mean_at(nodes, points));
    const auto known = std::find(angles.begin(), angles.end(), turned.angle);
    const auto angle = static_cast<std::size_t>(known - angles.begin());
    if (known == angles.end()) angles.push_back(turned.angle);
    for (const int node : nodes) {
      const auto paths = turning_paths(turned, points[at(node)], center, angle);
      for (std::size_t i = 0; i < 3; ++i) imposed.add(node, i, paths[i], turned.set);
    }
  }
  scene.constraints = imposed.constraints();
  std::erase_if(scene.constraints, [&](const Constraint& c) { return is_tied(scene.ties, c.node); });
  const auto drive = [&](const std::string& set) {
    auto& driven = scene.driven[set];
    driven.clear();  // a set may be named twice
    for_each_constraint(scene.constraints, scene.sets.at(set),
                        [&](std::size_t k, std::size_t /*n*/) { driven.push_back(k); });
  };
  for (const auto& displacement : scene.description.displacements) drive(displacement.set);
  for (const auto& turned : scene.description.rotations) drive(turned.set);
}

/// The largest length (m) of the imposed displacements, and of a function of each node that turns: of its
/// final displacement beside the rotation (m), its distance from the axis (m) and the angle (rad).
template <class Turning>
double largest_length(const Scene& scene, const Turning& turning) {
  double largest = 0.0;
  for (const auto& displacement : scene.description.displacements) {
    const auto& d = displacement.value;
    largest = std::max(largest, length(d));
  }
  const auto& constraints = scene.constraints;
  for (std::size_t k = 0; k < constraints.size();) {
    PathTerms square{};
    std::size_t angle = 0;
    for (const int node = constraints[k].node; k < constraints.size() && constraints[k].node == node; ++k) {
      const ImposedPath& path = constraints[k].path;
      for (std::size_t i = 0; i < 3; ++i) square[i] += path.share[i] * path.share[i];
      angle = std::max(angle, path.angle);
    }
    if (angle == 0) continue;
    const double length = turning(std::sqrt(square[0]), std::sqrt(square[1]), std::abs(scene.angles[angle]));
    largest = std::max(largest, length);
  }
  return largest;
}

/// Adds to `sums` what an initial velocity gives to its nodes at X (m): its value, as a wave where there is
/// one, and spin x (X - centre of mass), m/s.
void add_motion(const Scene& scene, const InitialVelocity& velocity, const std::vector<int>& nodes,
                const std::vector<double>& masses, NodalField& sums) {
  const NodalField& points = scene.mesh.points;
  Vector centre{};
  double mass = 0.0;
  for (const int node : nodes) {
    mass += masses[at(node)];
    for (std::size_t i = 0; i < 3; ++i) centre[i] += masses[at(node)] * points[at(node)][i];
  }
  for (double& x : centre) x /= mass;
  const auto [low, high] = bounding_box(values_at(nodes, points));
  for (std::size_t i = 0; i < 3; ++i) {
    if (velocity.half_waves[i] == 0 || low[i] < high[i]) continue;
    throw InputError(
        fmt::format("{}: velocity.half_waves = {} along {}: the set {} has no extent along {}; a wave needs "
                    "one, 0 stands for no wave",
                    scene.description.file.string(), velocity.half_waves[i], "xyz"[i],
                    velocity.set.value_or("of all nodes"), "xyz"[i]));
  }
  for (const int node : nodes) {
    const Vector& X = points[at(node)];
    double wave = 1.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const int n = velocity.half_waves[i];
      if (n != 0) wave *= std::cos(std::numbers::pi * n * (X[i] - low[i]) / (high[i] - low[i]));
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      sums[at(node)][i] += wave * velocity.value[i] + velocity.spin[j] * (X[k] - centre[k]) -
                           velocity.spin[k] * (X[j] - centre[j]);
    }
  }
}

/// Resolves the forces of the case, whose curves become those of the scene.
void make_forces(Scene& scene, const std::vector<double>& element_masses, const std::vector<double>& masses) {
  ForceResolver resolver{.file = scene.description.file.string(),
                         .points = scene.mesh.points,
                         .boundary = scene.boundary,
                         .sets = scene.sets,
                         .element_masses = element_masses,
                         .masses = masses};
  scene.description.forces.for_each([&](const auto& force) { force.resolve(resolver); });
  scene.forces = resolver.all();
  scene.curves = std::move(resolver.curves);
}

/// The sum of all initial velocities at each node, from their masses (kg); empty where a case has none.
NodalField make_initial_velocities(const Scene& scene, const std::vector<double>& masses) {
  if (scene.description.velocities.empty()) return {};
  std::vector<int> body(masses.size());
  std::iota(body.begin(), body.end(), 0);
  NodalField sums(masses.size());
  for (const auto& velocity : scene.description.velocities) {
    const auto& nodes = velocity.set ? node_set(scene, "velocity.set", *velocity.set) : body;
    add_motion(scene, velocity, nodes, masses, sums);
  }
  return sums;
}

}  // namespace

const std::vector<int>& node_set(const Scene& scene, const std::string& key, const std::string& name) {
  return named_node_set(scene.sets, scene.description.file.string(), key, name);
}

const std::vector<int>& element_set(const Scene& scene, const std::string& key, const std::string& name) {
  return named_element_set(scene.element_sets, scene.description.file.string(), key, name);
}

Mesh generate_mesh(const AnyGenerator& generator) {
  return std::visit([](const auto& g) { return g.build(); }, generator);
}

Scene make_scene(Case description, Mesh mesh, NodeSets sets_of_file, ElementSets element_sets_of_file) {
  Scene scene{.description = std::move(description),
              .mesh = std::move(mesh),
              .sets = std::move(sets_of_file),
              .element_sets = std::move(element_sets_of_file),
              .angles = {0.0}};
  const std::string file = scene.description.file.string();
  try {
    require_positive_jacobians(scene.mesh);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file, error.what()));
  }
  scene.boundary = boundary_faces(scene.mesh.cells);
  const auto on_boundary = nodes_of(scene.boundary, scene.mesh.points.size());
  for (const auto& rule : scene.description.sets) {
    auto nodes = select_nodes(scene.mesh, on_boundary, rule);
    if (nodes.empty()) {
      throw InputError(fmt::format("{}: sets.{} selects no node of the {} of the mesh; {}", file, rule.name,
                                   scene.mesh.points.size(), nearest_miss(scene.mesh, on_boundary, rule)));
    }
    scene.sets[rule.name] = std::move(nodes);
  }
  for (const auto& rule : scene.description.element_sets) {
    scene.element_sets[rule.name] = select_elements(scene.mesh, rule);
  }
  scene.materials = make_materials(scene);
  refine(scene);
  make_constraints(scene);
  tie(scene);
  const auto of_elements = element_masses(scene.mesh, scene.materials);
  const auto masses = lumped_masses(scene.mesh, of_elements);
  make_forces(scene, of_elements, masses);
  scene.initial_velocities = make_initial_velocities(scene, masses);
  scene.case_hash = case_hash(scene.description);
  scene.mesh_hash = mesh_hash(scene.mesh, scene.sets, scene.materials.of_element);
  return scene;
}

double largest_imposed(const Scene& scene) {
  return largest_length(scene, [](double displacement, double radius, double angle) {
    return displacement + 2.0 * radius * std::sin(0.5 * std::min(angle, std::numbers::pi));
  });
}

double fastest_imposed(const Scene& scene) {
  return largest_length(
      scene, [](double displacement, double radius, double angle) { return displacement + radius * angle; });
}

double final_value(const Scene& scene, const Constraint& constraint) {
  return constraint.path.along(path_terms(scene.angles[constraint.path.angle], 1.0));
}

double displacement_unit(const Scene& scene, const NodalField& reference) {
  double unit = largest_imposed(scene);
  if (unit > 0.0) return unit;
  for (const auto& u : reference) unit = std::max(unit, length(u));
  return unit;
}

}  // namespace sandglass
