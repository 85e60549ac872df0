#include "problem/make_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "base/error.hpp"
#include "forces/contact_force.hpp"
#include "mesh/hash.hpp"
#include "mesh/hexahedron.hpp"
#include "mesh/quality.hpp"
#include "problem/masses.hpp"
#include "problem/scene_rules.hpp"

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

/// Sets the constraints, their angles and the driven sets.
void make_constraints(const Case& description, Scene& scene) {
  const NodalField& points = scene.mesh.points;
  std::vector<double>& angles = scene.angles;
  struct Origin {
    Constraint constraint;
    const std::string& set;
  };
  std::map<std::pair<int, int>, Origin> imposed;  // by node and component
  const auto impose = [&](const Constraint& c, const std::string& set) {
    const Origin& first = imposed.try_emplace({c.node, c.component}, Origin{c, set}).first->second;
    if (first.constraint.path == c.path) return;
    throw InputError(fmt::format(
        "{}: node {} is given two displacements in {}: {} by set '{}' and {} by set '{}'; a node may be in "
        "two sets only if both impose the same value",
        description.file.string(), c.node, "xyz"[c.component], described(first.constraint.path, angles),
        first.set, described(c.path, angles), set));
  };
  std::map<std::string, std::array<bool, 3>> components_of;  // that the entries of a set impose
  const auto drive = [&](const std::string& set, const std::array<bool, 3>& components) {
    if (!components_of.contains(set)) scene.driven.push_back({set, {}});
    for (std::size_t i = 0; i < 3; ++i) components_of[set][i] |= components[i];
  };
  int group = 0;
  for (const auto& displacement : description.displacements) {
    for (const int node : node_set(scene, "displacement.set", displacement.set)) {
      for (int i = 0; i < 3; ++i) {
        if (displacement.components[at(i)])
          impose({node, i, {{displacement.value[at(i)]}}, group}, displacement.set);
      }
    }
    drive(displacement.set, displacement.components);
    ++group;
  }
  for (const auto& turned : description.rotations) {
    const auto& nodes = node_set(scene, "rotation.set", turned.set);
    const Vector center = turned.center.value_or(mean_at(nodes, points));
    const auto known = std::find(angles.begin(), angles.end(), turned.angle);
    const auto angle = static_cast<std::size_t>(known - angles.begin());
    if (known == angles.end()) angles.push_back(turned.angle);
    for (const int node : nodes) {
      const auto paths = turning_paths(turned, points[at(node)], center, angle);
      for (int i = 0; i < 3; ++i) impose({node, i, paths[at(i)]}, turned.set);
    }
    scene.turned.push_back({nodes, turned.axis, angle, !turned.center});
    drive(turned.set, {true, true, true});
  }
  for (const auto& [at_node, origin] : imposed) {
    if (!is_tied(scene.ties, at_node.first)) scene.constraints.push_back(origin.constraint);
  }
  for (DrivenSet& driven : scene.driven) {
    const auto& imposed_by_set = components_of.at(driven.name);
    for_each_constraint(scene.constraints, scene.sets.at(driven.name), [&](std::size_t k, std::size_t /*n*/) {
      if (imposed_by_set[at(scene.constraints[k].component)]) driven.constraints.push_back(k);
    });
  }
}

/// Adds an initial velocity (m/s) to the `sums` of its nodes at X (m): its value, as a wave if it has one,
/// and spin x (X - centre of mass).
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
                    "one; 0 means no wave",
                    scene.settings.file.string(), velocity.half_waves[i], "xyz"[i],
                    velocity.set.empty() ? "of all nodes" : velocity.set, "xyz"[i]));
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

/// Whether all components of each node are held or driven.
std::vector<bool> held_nodes(const Scene& scene) {
  std::vector<int> imposed(scene.mesh.points.size(), 0);
  for (const Constraint& one : scene.constraints) ++imposed[at(one.node)];
  std::vector<bool> held;
  for (const int components : imposed) held.push_back(components == 3);
  return held;
}

/// Resolves the forces of the case, keeps their curves in the scene, and adds to the `masses` (kg) of nodes
/// what is attached to them.
void make_forces(const Case& description, Scene& scene, std::vector<double>& masses) {
  ForceResolver resolver{.file = scene.settings.file.string(),
                         .points = scene.mesh.points,
                         .boundary = scene.boundary,
                         .sets = scene.sets,
                         .masses = masses,
                         .cells = scene.mesh.cells,
                         .young_moduli = young_moduli(scene.mesh, scene.materials),
                         .ties = scene.ties,
                         .held = held_nodes(scene),
                         .in_motion = !description.quasi_static};
  description.forces.for_each([&](const auto& force) { force.resolve(resolver); });
  scene.forces = description.quasi_static ? at_rest(resolver.all()) : resolver.all();
  scene.curves = std::move(resolver.curves);
  scene.attached_masses = std::move(resolver.attached);
}

/// The sum of all initial velocities at each node, from their masses (kg); empty if the case has none.
NodalField make_initial_velocities(const Case& description, const Scene& scene,
                                   const std::vector<double>& masses) {
  if (description.velocities.empty()) return {};
  std::vector<int> body(masses.size());
  std::iota(body.begin(), body.end(), 0);
  NodalField sums(masses.size());
  for (const auto& velocity : description.velocities) {
    const auto& nodes = velocity.set.empty() ? body : node_set(scene, "velocity.set", velocity.set);
    add_motion(scene, velocity, nodes, masses, sums);
  }
  return sums;
}

}  // namespace

std::vector<double> young_moduli(const Mesh& mesh, const Materials& materials) {
  const std::vector<double> lambdas = lame_lambdas(materials), moduli = shear_moduli(materials);
  std::vector<double> of_elements(mesh.cells.size());
  for (std::size_t e = 0; e < of_elements.size(); ++e) {
    const double lambda = lambdas[materials.of(e)], mu = moduli[materials.of(e)];
    of_elements[e] = mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu);
  }
  return of_elements;
}

Mesh generate_mesh(const AnyGenerator& generator) {
  return std::visit([](const auto& g) { return g.build(); }, generator);
}

Scene make_scene(const CaseOnMesh& on_mesh) {
  const auto& [description, mesh, sets, element_sets] = on_mesh;
  return make_scene(description, mesh, sets, element_sets);
}

Scene make_scene(const Case& description, Mesh mesh, NodeSets sets_of_file,
                 ElementSets element_sets_of_file) {
  const std::string file = description.file.string();
  Scene scene;
  scene.settings = static_cast<const CaseSettings&>(description);
  scene.case_hash = case_hash(description);
  scene.mesh = std::move(mesh);
  scene.sets = std::move(sets_of_file);
  scene.element_sets = std::move(element_sets_of_file);
  scene.angles = {0.0};
  try {
    require_positive_jacobians(scene.mesh);
    scene.boundary = boundary_faces(scene.mesh.cells);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file, error.what()));
  }
  const auto on_boundary = nodes_of(scene.boundary, scene.mesh.points.size());
  for (const auto& rule : description.sets) {
    auto nodes = select_nodes(scene.mesh, on_boundary, rule);
    if (nodes.empty()) {
      throw InputError(fmt::format("{}: sets.{} selects no node of the {} of the mesh; {}", file, rule.name,
                                   scene.mesh.points.size(), nearest_miss(scene.mesh, on_boundary, rule)));
    }
    scene.sets[rule.name] = std::move(nodes);
  }
  for (const auto& rule : description.element_sets) {
    scene.element_sets[rule.name] = select_elements(scene.mesh, rule);
  }
  scene.materials = make_materials(description, scene);
  refine(description, scene);
  make_constraints(description, scene);
  tie(description, scene);
  auto masses = lumped_masses(scene.mesh, element_masses(scene.mesh, scene.materials));
  make_forces(description, scene, masses);
  scene.initial_velocities = make_initial_velocities(description, scene, masses);
  scene.mesh_hash = mesh_hash(scene.mesh, scene.sets, scene.materials.of_element);
  return scene;
}

}  // namespace sandglass
