#include "model/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/names.hpp"
#include "element/hexahedron.hpp"
#include "mesh/hash.hpp"
#include "mesh/quality.hpp"

namespace sandglass {

namespace {

std::vector<std::string> names(const NodeSets& sets) {
  std::vector<std::string> known;
  for (const auto& [name, nodes] : sets) known.push_back(name);
  return known;
}

const std::vector<int>& find_set(const Case& scene, const NodeSets& sets, const std::string& key,
                                 const std::string& name) {
  const auto found = sets.find(name);
  if (found == sets.end()) {
    throw InputError(fmt::format("{}: {} = '{}' is not a node set of this case; {}", scene.file.string(), key,
                                 name, suggestion(name, names(sets))));
  }
  return found->second;
}

/// Node and component -> value; a second value must equal the first.
std::vector<Constraint> make_constraints(const Case& scene, const NodeSets& sets) {
  struct Origin {
    double value;
    std::string set;
  };
  std::map<std::pair<int, int>, Origin> imposed;
  for (const auto& displacement : scene.displacements) {
    for (const int node : find_set(scene, sets, "displacement.set", displacement.set)) {
      for (std::size_t i = 0; i < 3; ++i) {
        if (!displacement.components[i]) continue;
        const double value = displacement.value[i];
        const Origin origin{value, displacement.set};
        const Origin& first = imposed.try_emplace({node, static_cast<int>(i)}, origin).first->second;
        if (first.value == value) continue;
        throw InputError(fmt::format(
            "{}: node {} is given two displacements in {}: {} by set '{}' and {} by set '{}'; a node may be "
            "in "
            "two sets only if both impose the same value",
            scene.file.string(), node, "xyz"[i], first.value, first.set, value, displacement.set));
      }
    }
  }
  std::vector<Constraint> constraints;
  for (const auto& [key, origin] : imposed) constraints.push_back({key.first, key.second, origin.value});
  return constraints;
}

/// The sum of all imposed forces at each node.
std::vector<NodalLoad> make_loads(const Case& scene, const Mesh& mesh, const NodeSets& sets) {
  std::map<int, Vector> sums;
  for (const auto& [name, total, moment] : scene.forces) {
    const auto& nodes = find_set(scene, sets, "force.set", name);
    const auto faces = faces_within(mesh, nodes);
    if (faces.empty()) {
      throw InputError(
          fmt::format("{}: force.set = '{}' has no boundary face among its {} nodes; a force acts on faces "
                      "of the boundary "
                      "whose four nodes all lie in its set",
                      scene.file.string(), name, nodes.size()));
    }
    for (const auto& [node, force] : consistent_loads(mesh.points, faces, total, moment)) {
      for (std::size_t i = 0; i < 3; ++i) sums[node][i] += force[i];
    }
  }
  std::vector<NodalLoad> loads;
  loads.reserve(sums.size());
  for (const auto& [node, force] : sums) loads.push_back({node, force});
  return loads;
}

}  // namespace

Mesh generate_mesh(const AnyGenerator& generator) {
  return std::visit([](const auto& g) { return g.build(); }, generator);
}

Scene make_scene(Case description, Mesh mesh, NodeSets sets_of_file) {
  Scene scene{.description = std::move(description),
              .mesh = std::move(mesh),
              .sets = std::move(sets_of_file),
              .constraints = {},
              .loads = {},
              .case_hash = {},
              .mesh_hash = {}};
  const std::string file = scene.description.file.string();
  try {
    require_positive_jacobians(scene.mesh);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file, error.what()));
  }
  const auto on_boundary = boundary_nodes(scene.mesh);
  for (const auto& rule : scene.description.sets) {
    auto nodes = select_nodes(scene.mesh, on_boundary, rule);
    if (nodes.empty()) {
      throw InputError(fmt::format(
          "{}: sets.{} selects no node; its rule must hold for at least one of the {} nodes of the mesh",
          file, rule.name, scene.mesh.points.size()));
    }
    scene.sets[rule.name] = std::move(nodes);
  }
  if (scene.description.profile) {
    find_set(scene.description, scene.sets, "profile.set", scene.description.profile->set);
  }
  for (const auto& published : scene.description.published) {
    find_set(scene.description, scene.sets, "published.set", published.set);
  }
  scene.constraints = make_constraints(scene.description, scene.sets);
  scene.loads = make_loads(scene.description, scene.mesh, scene.sets);
  scene.case_hash = case_hash(scene.description);
  scene.mesh_hash = mesh_hash(scene.mesh, scene.sets);
  return scene;
}

double largest_imposed(const Scene& scene) {
  double largest = 0.0;
  for (const auto& displacement : scene.description.displacements) {
    const auto& d = displacement.value;
    largest = std::max(largest, std::hypot(d[0], d[1], d[2]));
  }
  return largest;
}

double displacement_unit(const Scene& scene, const NodalField& reference) {
  double unit = largest_imposed(scene);
  if (unit > 0.0) return unit;
  for (const auto& u : reference) unit = std::max(unit, std::hypot(u[0], u[1], u[2]));
  return unit;
}

Model::Model(const Scene& scene, MethodChoice choice)
    : scene_(scene),
      choice_(std::move(choice)),
      internal_force_(
          make_internal_force(scene.mesh, scene.description.law, choice_, scene.description.density)),
      masses_(scene.mesh.points.size(), 0.0) {
  element_masses_.reserve(scene.mesh.cells.size());
  for (const auto& cell : scene.mesh.cells) {
    const double mass = scene.description.density * mean_gradient(gather(scene.mesh.points, cell)).volume;
    element_masses_.push_back(mass);
    for (const int node : cell) masses_[static_cast<std::size_t>(node)] += mass / 8.0;
  }
}

NodalField internal_forces(const Model& model, const NodalField& u) {
  return std::visit(
      [&]<class Real>(const std::unique_ptr<InternalForce<Real>>& elements) {
        State<Real> state = state_at(*elements, u);
        Rows<Real> force(state.u.size());
        elements->evaluate(state, force);
        return to_field(force, elements->layout());
      },
      model.internal_force());
}

StrainEnergies strain_energies(const Model& model, const NodalField& u) {
  return std::visit(
      [&]<class Real>(const std::unique_ptr<InternalForce<Real>>& elements) {
        State<Real> state = state_at(*elements, u);
        Rows<Real> unused(state.u.size());
        elements->evaluate(state, unused);  // takes along what elements remember
        return elements->energies(state);
      },
      model.internal_force());
}

}  // namespace sandglass
