#include "app/scene_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "app/si_units.hpp"
#include "comparison/comparison.hpp"
#include "io/case_file.hpp"
#include "mesh/oddities.hpp"
#include "mesh/parts.hpp"
#include "problem/held.hpp"
#include "problem/masses.hpp"
#include "solve/loading_curve.hpp"

namespace sandglass {

namespace {

/// The extent (m) of a mesh from a file above which it is probably not in m.
constexpr double most_length = 10.0;

/// The largest plausible ratio of a body's weight per area of its base to its Young's modulus: gels of a few
/// metres exceed what a body could bear, but not by far.
constexpr double most_weight = 100.0;

std::string plural(std::size_t count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string extent_text(const std::vector<int>& nodes, const NodalField& points) {
  auto [low, high] = bounding_box(values_at(nodes, points));
  const auto [first, last] = bounding_box(points);
  const double roundoff = 1e-12 * distance(first, last);
  std::vector<std::string> words;
  for (std::size_t i = 0; i < 3; ++i) {
    for (double* end : {&low[i], &high[i]}) *end = std::abs(*end) < roundoff ? 0.0 : *end;
    words.push_back(high[i] - low[i] <= roundoff
                        ? fmt::format("{} = {:.9g}", "xyz"[i], low[i])
                        : fmt::format("{} {:.9g} to {:.9g}", "xyz"[i], low[i], high[i]));
  }
  return fmt::format("{} m", fmt::join(words, ", "));
}

std::string shape_text(const SetShape& shape) {
  if (shape.elements > 0) return fmt::format("volume of {}", plural(shape.elements, "element"));
  if (shape.faces > 0) return fmt::format("surface of {}", plural(shape.faces, "face"));
  return shape.edges > 0 ? "edge" : "points";
}

/// The sets that the tables of a case use, by name.
struct UsedSets {
  std::set<std::string> nodes;
  std::set<std::string> elements;

  /// Adds the sets of a table with declared parameters: the texts among them are names of sets.
  template <class Table>
  void add(const Table& table) {
    const auto add_name = [&]<class Value>(const Parameter<Table, Value>& parameter) {
      if constexpr (std::is_same_v<Value, std::string>) {
        (parameter.name == "elements" ? elements : nodes).insert(table.*(parameter.member));
      }
    };
    std::apply([&](const auto&... parameter) { (add_name(parameter), ...); }, Table::parameters());
  }
};

/// The sets that a case names, including those of its comparisons.
UsedSets used_sets(const Case& description) {
  UsedSets used;
  for (const CaseMaterial& material : description.materials) used.elements.insert(material.elements);
  for (const auto& refinement : description.refinements) used.add(refinement);
  for (const auto& tie : description.ties) used.add(tie);
  for (const auto& imposed : description.displacements) used.nodes.insert(imposed.set);
  for (const auto& turned : description.rotations) used.nodes.insert(turned.set);
  description.forces.for_each([&](const auto& force) { used.add(force); });
  for (const auto& start : description.velocities) used.add(start);
  const Comparison comparison = read_comparison(description);
  if (comparison.profile) used.nodes.insert(comparison.profile->set);
  for (const PublishedValue& published : comparison.published) used.nodes.insert(published.set);
  return used;
}

void warn(const std::string& text) {
  fmt::print(stderr, "warning: {}\n", text);
}

void warn_of_units(const Case& description, const Scene& scene, const std::string& of) {
  const auto [low, high] = bounding_box(scene.mesh.points);
  const double longest = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  if (std::holds_alternative<MeshFile>(description.mesh) && longest > most_length) {
    warn(fmt::format(
        "{}the mesh is {} long, and files are read in m: if it is in mm, multiply its points by 0.001 (no "
        "key "
        "does so), or give the whole case in mm, s, t, N and MPa, and read printed units accordingly",
        of, length_text(longest)));
    return;
  }
  for (const Material& material : scene.materials.list) {
    const double modulus = young_modulus(elastic_law(kernel_law(material)));
    if (material.density * 9.81 * longest < most_weight * modulus) continue;
    fmt::print(
        "note: {}a body of {} with a density of {:.4g} kg/m^3 has a weight per area of {:.2g} times its "
        "Young's modulus, {}: units are m, Pa and kg/m^3\n",
        of, length_text(longest), material.density, material.density * 9.81 * longest / modulus,
        with_prefix(modulus, "Pa"));
  }
}

/// The parts of a body that are not joined, if there are several: elements, place, mass.
void print_parts(const Scene& scene, const std::string& of) {
  constexpr std::size_t most = 4;
  const std::vector<int> parts = parts_of_nodes(scene.mesh, scene.ties);
  struct Part {
    std::vector<int> nodes;
    std::size_t elements = 0;
    double mass = 0.0;
  };
  std::vector<Part> all(parts.empty() ? 0 : at(1 + *std::ranges::max_element(parts)));
  if (all.size() < 2) return;
  for (std::size_t n = 0; n < parts.size(); ++n)
    if (parts[n] >= 0) all[at(parts[n])].nodes.push_back(static_cast<int>(n));
  const auto masses = element_masses(scene.mesh, scene.materials);
  for (std::size_t e = 0; e < masses.size(); ++e) {
    Part& part = all[at(parts[at(scene.mesh.cells[e].front())])];
    ++part.elements;
    part.mass += masses[e];
  }
  std::ranges::stable_sort(all, std::ranges::greater{}, &Part::elements);
  std::vector<std::string> words;
  for (const Part& part : all) {
    if (words.size() == most) break;
    words.push_back(fmt::format("{}, {}, {}", plural(part.elements, "element"), mass_text(part.mass),
                                extent_text(part.nodes, scene.mesh.points)));
  }
  if (all.size() > most) words.push_back(fmt::format("{} more", all.size() - most));
  fmt::print("{}parts: {}\n", of, fmt::join(words, "; "));
}

/// A note on each set of the mesh, from its file or of its bodies, that a rule of the case replaces by
/// another.
void print_replaced_sets(const CaseOnMesh& problem, const Scene& scene, const std::string& of) {
  if (!problem.description.refinements.empty()) return;  // which add to sets
  const auto print = [&](const char* table, const char* unit, const auto& rules, const auto& before,
                         const auto& now) {
    for (const NodeSetRule& rule : rules) {
      const auto own = before.find(rule.name);
      if (own == before.end() || own->second == now.at(rule.name)) continue;
      fmt::print("note: {}{}.{} ({}) replaces the set of that name in the mesh ({})\n", of, table, rule.name,
                 plural(now.at(rule.name).size(), unit), plural(own->second.size(), unit));
    }
  };
  print("sets", "node", problem.description.sets, problem.sets, scene.sets);
  print("element_sets", "element", problem.description.element_sets, problem.element_sets,
        scene.element_sets);
}

/// Notes on loads that do not reach what their tables give.
void print_shortened_loads(const Scene& scene, const std::string& of) {
  const DynamicsSettings& motion = scene.settings.dynamics;
  if (!scene.settings.quasi_static) {
    if (motion.ramp_time > motion.duration) {
      fmt::print(
          "note: {}ramp_time = {:g} s is longer than duration = {:g} s: loads reach {:.2g} of their values\n",
          of, motion.ramp_time, motion.duration, loading_curve(motion, motion.duration).value());
    }
    return;
  }
  double last = 0.0;
  for (const LoadCurve& curve : scene.curves) {
    if (!curve.times.empty()) last = std::max(last, curve.times.back());
  }
  if (last > 1.0)
    fmt::print("note: {}times of a load reach {:g}, but static answers end at 1, the whole load\n", of, last);
}

/// The boundary of a scene without the faces of two surfaces that a [[contact]] keeps apart.
std::vector<Quadrilateral> boundary_without_contact(const Case& description, const Scene& scene) {
  std::vector<Quadrilateral> faces = scene.boundary;
  for (const Contact& contact : description.forces.of<Contact>()) {
    if (contact.other.empty()) continue;
    const auto& set = scene.sets.at(contact.set);
    std::erase_if(faces, [&](const Quadrilateral& face) {
      return std::ranges::all_of(face, [&](int node) { return std::ranges::binary_search(set, node); });
    });
  }
  return faces;
}

/// Warnings of probable mistakes, and a note on sets that no table uses.
void warn_of_oddities(const Case& description, const Scene& scene, const std::string& of) {
  const std::string file = description.file.string();
  const auto on_boundary = nodes_of(scene.boundary, scene.mesh.points.size());
  for (const std::string& cut : cut_planes(scene.mesh, on_boundary, description.sets))
    warn(fmt::format("{}: {}, which seem to be one plane; if they are, widen the limits", file, cut));
  const std::string seam =
      described(seam_of(scene.mesh, scene.ties, boundary_without_contact(description, scene)), scene.mesh);
  if (!seam.empty()) warn(of + seam);
  warn_of_units(description, scene, of);
  std::vector<std::string> unused;
  const UsedSets used = used_sets(description);
  for (const NodeSetRule& rule : description.sets) {
    if (!used.nodes.contains(rule.name)) unused.push_back(rule.name);
  }
  if (!unused.empty()) fmt::print("note: {}no table uses the sets {}\n", of, fmt::join(unused, ", "));
}

}  // namespace

void print_sets(const Case& description, const Scene& scene) {
  const UsedSets used = used_sets(description);
  const auto note = [](const std::set<std::string>& names, const std::string& name) {
    return names.contains(name) ? "" : "; no table uses it";
  };
  for (const auto& [name, nodes] : scene.sets) {
    fmt::print("  set {}: {}", name, plural(nodes.size(), "node"));
    if (!nodes.empty()) {
      fmt::print(", {}, {}", shape_text(shape_of(scene.mesh, scene.boundary, nodes)),
                 extent_text(nodes, scene.mesh.points));
    }
    fmt::print("{}\n", note(used.nodes, name));
  }
  for (const auto& [name, elements] : scene.element_sets) {
    fmt::print("  element set {}: {}{}\n", name, plural(elements.size(), "element"),
               note(used.elements, name));
  }
}

void print_understood(const CaseOnMesh& problem, const Scene& scene, const std::string& of) {
  print_parts(scene, of);
  if (!scene.settings.quasi_static) print_free_motions(scene, of);
  print_replaced_sets(problem, scene, of);
  print_shortened_loads(scene, of);
  warn_of_oddities(problem.description, scene, of);
}

void print_free_motions(const Scene& scene, const std::string& of) {
  const std::string free = described_free_motions(scene);
  if (!free.empty()) fmt::print("note: {}nothing holds {}\n", of, free);
}

Scene understood_scene(Case description) {
  const CaseOnMesh problem = with_mesh(std::move(description));
  Scene scene = make_scene(problem);
  if (scene.settings.quasi_static) require_held(scene);
  print_understood(problem, scene, scene.settings.name + ": ");
  return scene;
}

}  // namespace sandglass
