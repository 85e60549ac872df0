#include "problem/scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "forces/contact_force.hpp"

namespace sandglass {

namespace {

/// Renumbers the members of sets: `there` has their numbers in a part, or -1 for members that it lacks.
template <class Sets>
void renumber(Sets& sets, const std::vector<int>& there) {
  for (auto& [name, set] : sets) {
    for (int& member : set) member = there[at(member)];
    std::erase(set, -1);
  }
}

/// The constraints of a part, whose rim is fixed. Sets `there[k]` to the part's number of the k-th
/// constraint.
std::vector<Constraint> constraints_of(const MeshPart& part, const std::vector<Constraint>& whole,
                                       std::vector<std::size_t>& there) {
  std::vector<Constraint> inside;
  for (std::size_t n = 0; n < part.node_of.size(); ++n) {
    auto next = std::ranges::lower_bound(whole, part.node_of[n], {}, &Constraint::node);
    for (int i = 0; i < 3; ++i) {
      const bool imposed = next != whole.end() && next->node == part.node_of[n] && next->component == i;
      if (!imposed && !part.on_the_rim[n]) continue;
      Constraint constraint{static_cast<int>(n), i, {}};
      if (!part.on_the_rim[n]) constraint = {constraint.node, i, next->path, next->group};
      if (imposed) there[static_cast<std::size_t>(next++ - whole.begin())] = inside.size();
      inside.push_back(constraint);
    }
  }
  return inside;
}

/// The largest value, over imposed nodes, of a function of three arguments: the length of the final
/// displacement without the rotation (m), the distance from the axis (m), and the angle (rad; zero without
/// rotation).
template <class Length>
double largest_length(const Scene& scene, const Length& length_of) {
  double largest = 0.0;
  const auto& constraints = scene.constraints;
  for (std::size_t k = 0; k < constraints.size();) {
    Vector displacement{};
    double square = 0.0;
    std::size_t angle = 0;
    for (const int node = constraints[k].node; k < constraints.size() && constraints[k].node == node; ++k) {
      const ImposedPath& path = constraints[k].path;
      displacement[at(constraints[k].component)] = path.share[0];
      square += path.share[1] * path.share[1];
      angle = std::max(angle, path.angle);
    }
    largest =
        std::max(largest, length_of(length(displacement), std::sqrt(square), std::abs(scene.angles[angle])));
  }
  return largest;
}

}  // namespace

Scene on_part(const Scene& whole, const MeshPart& part) {
  constexpr auto nowhere = static_cast<std::size_t>(-1);
  Scene scene = whole;
  // A new field does not compile until it is named here; fields of the mesh are cut to the part.
  auto& [settings, case_hash, mesh_hash, mesh, ties, coarser, boundary, sets, element_sets, materials,
         constraints, driven, angles, turned, curves, forces, attached_masses, initial_velocities] = scene;
  std::vector<int> element_there(mesh.cells.size(), -1);
  for (std::size_t e = 0; e < part.element_of.size(); ++e)
    element_there[at(part.element_of[e])] = static_cast<int>(e);
  mesh = part.mesh;
  coarser.clear();
  turned.clear();
  boundary = faces_in(part, whole.boundary);
  renumber(sets, part.part_of);
  renumber(element_sets, element_there);
  materials = materials_of(whole.materials, part.element_of);
  std::vector<std::size_t> there(whole.constraints.size(), nowhere);
  constraints = constraints_of(part, whole.constraints, there);
  for (DrivenSet& set : driven) {
    for (std::size_t& k : set.constraints) k = there[k];
    std::erase(set.constraints, nowhere);
  }
  std::erase_if(driven, [](const DrivenSet& set) { return set.constraints.empty(); });
  for (auto& force : forces) force = force->restricted_to(part);
  std::erase(forces, nullptr);
  if (!attached_masses.empty()) {
    attached_masses.clear();
    for (const int node : part.node_of) attached_masses.push_back(whole.attached_masses[at(node)]);
  }
  if (!initial_velocities.empty()) initial_velocities = values_at(part.node_of, whole.initial_velocities);
  return scene;
}

Scene with_load(Scene scene, const std::vector<double>& imposed, double time, double load_factor) {
  scene.case_hash.clear();
  scene.angles = {0.0};
  scene.turned.clear();
  auto next = imposed.begin();
  for (Constraint& one : scene.constraints) one = {one.node, one.component, {{*next++}}};
  for (LoadCurve& curve : scene.curves) curve = {.share = curve.at(time, load_factor)};
  for (const Movable& obstacle : movable_of(scene.forces)) {
    for (std::size_t i = 0; i < 3; ++i) scene.curves[obstacle.first_curve + i].share = *next++;
  }
  scene.forces = at_rest(std::move(scene.forces));
  return scene;
}

Scene in_motion(Scene scene) {
  scene.forces = in_motion(std::move(scene.forces));
  return scene;
}

Scene scaled(Scene scene, double factor) {
  scene.case_hash.clear();
  for (Constraint& constraint : scene.constraints) constraint.path.share[0] *= factor;
  for (double& angle : scene.angles) angle *= factor;
  for (LoadCurve& curve : scene.curves) curve.share *= factor;
  for (Vector& velocity : scene.initial_velocities)
    for (double& v : velocity) v *= factor;
  return scene;
}

const std::vector<int>& node_set(const Scene& scene, const std::string& key, const std::string& name) {
  return named_node_set(scene.sets, scene.settings.file.string(), key, name);
}

const std::vector<int>& element_set(const Scene& scene, const std::string& key, const std::string& name) {
  return named_element_set(scene.element_sets, scene.settings.file.string(), key, name);
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
