#include "problem/scene_refinement.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "mesh/distances.hpp"
#include "problem/scene_rules.hpp"

namespace sandglass {

namespace {

/// Marks `layers` layers of elements at the edge of a set: its nodes on boundary faces that are not within
/// it. Throws InputError if there are none.
void mark_edge(const Scene& scene, const RefinedMesh& refined, const std::string& name, int layers,
               std::vector<bool>& marked) {
  const auto set = refined.nodes_of(node_set(scene, "refine.around", name));
  const auto in_set = [&](int node) { return std::binary_search(set.begin(), set.end(), node); };
  std::vector<int> margin(refined.mesh().points.size(), 0);
  for (const auto& face : refined.boundary()) {
    if (std::all_of(face.begin(), face.end(), in_set)) continue;
    for (const int node : face) {
      if (in_set(node)) margin[at(node)] = layers;
    }
  }
  if (std::find(margin.begin(), margin.end(), layers) == margin.end()) {
    throw InputError(
        fmt::format("{}: refine.around = '{}' has no edge: some of its nodes must be on boundary faces that "
                    "are not within it; elements = NAME refines an element set",
                    scene.settings.file.string(), name));
  }
  Distances(refined.mesh()).mark(std::move(margin), marked);
}

/// The elements of the present mesh that a rule splits, after `splits` splits.
void mark(const Scene& scene, const Refinement& rule, const RefinedMesh& refined, int splits,
          std::vector<bool>& marked) {
  if (!rule.numbers.empty() && splits == rule.after) {
    for (const int e : rule.numbers) {
      if (at(e) >= marked.size()) {
        throw InputError(fmt::format(
            "{}: refine.numbers = {} must be below {}, the number of elements of the mesh after {} splits",
            scene.settings.file.string(), e, marked.size(), splits));
      }
      marked[at(e)] = true;
    }
  }
  if (splits >= rule.depth) return;
  if (!rule.around.empty()) mark_edge(scene, refined, rule.around, rule.layers, marked);
  if (!rule.elements.empty()) {
    const auto& set = element_set(scene, "refine.elements", rule.elements);
    for (const int e : refined.elements_of(set)) marked[at(e)] = true;
  }
}

/// The number of splits of the mesh.
int most_splits(const std::vector<Refinement>& rules) {
  int most = 0;
  for (const Refinement& rule : rules)
    most = std::max(most, rule.numbers.empty() ? rule.depth : rule.after + 1);
  return most;
}

}  // namespace

void refine(const Case& description, Scene& scene) {
  const auto& rules = description.refinements;
  if (rules.empty()) return;
  RefinedMesh refined(scene.mesh);
  for (int splits = 0; splits < most_splits(rules); ++splits) {
    std::vector<bool> marked(refined.mesh().cells.size(), false);
    for (const Refinement& rule : rules) mark(scene, rule, refined, splits, marked);
    refined.split(std::move(marked));
  }
  scene.mesh = refined.mesh();
  scene.ties = to_free_nodes(refined.ties());
  scene.coarser = refined.coarser();
  scene.boundary = refined.boundary();
  scene.materials = materials_of(scene.materials, refined.original());
  for (auto& [name, set] : scene.sets) set = refined.nodes_of(set);
  for (auto& [name, set] : scene.element_sets) set = refined.elements_of(set);
}

Case refined(Case description, std::vector<int> elements) {
  Refinement split;
  split.numbers = std::move(elements);
  split.after = most_splits(description.refinements);
  description.refinements.push_back(std::move(split));
  return description;
}

NodalField prolonged(const CoarserMesh& coarser, NodalField u) {
  for (const auto& corners : coarser.corners) u.push_back(mean_at(corners, u));
  return u;
}

}  // namespace sandglass
