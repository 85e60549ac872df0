#include "problem/scene_refinement.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "mesh/distances.hpp"
#include "mesh/refinement.hpp"

namespace sandglass {

namespace {

/// Marks `layers` layers of elements at the edge of a set: its nodes in a boundary face that is not within
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
    throw InputError(fmt::format(
        "{}: refine.around = '{}' has no edge: its nodes must be on the boundary, and some at faces that "
        "are not within it; elements = NAME refines an element set",
        scene.description.file.string(), name));
  }
  Distances(refined.mesh()).mark(std::move(margin), marked);
}

/// The elements that a rule wants split in the present mesh, after `splits` splits.
void mark(const Scene& scene, const Refinement& rule, const RefinedMesh& refined, int splits,
          std::vector<bool>& marked) {
  if (!rule.numbers.empty() && splits == rule.after) {
    for (const int e : rule.numbers) {
      if (at(e) >= marked.size()) {
        throw InputError(fmt::format(
            "{}: refine.numbers = {} must be below {}, the number of elements of the mesh after {} splits",
            scene.description.file.string(), e, marked.size(), splits));
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

}  // namespace

void refine(Scene& scene) {
  const auto& rules = scene.description.refinements;
  if (rules.empty()) return;
  RefinedMesh refined(scene.mesh);
  int most = 0;
  for (const Refinement& rule : rules)
    most = std::max(most, rule.numbers.empty() ? rule.depth : rule.after + 1);
  for (int splits = 0; splits < most; ++splits) {
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

Scene remade(const Scene& scene, Case description) {
  if (scene.coarser.empty())
    return make_scene(std::move(description), scene.mesh, scene.sets, scene.element_sets);
  const Mesh& original = scene.coarser.back().mesh;
  NodeSets sets = scene.sets;
  for (auto& [name, nodes] : sets) {
    std::erase_if(nodes, [&](int node) { return at(node) >= original.points.size(); });
  }
  ElementSets element_sets = scene.element_sets;
  for (auto& [name, elements] : element_sets) {
    for (int& e : elements) {
      for (const CoarserMesh& coarser : scene.coarser) e = coarser.element_of[at(e)];
    }
    elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
  }
  return make_scene(std::move(description), original, std::move(sets), std::move(element_sets));
}

Scene refined(const Scene& scene, std::vector<int> elements) {
  Case description = scene.description;
  Refinement split;
  split.numbers = std::move(elements);
  split.after = static_cast<int>(scene.coarser.size());
  description.refinements.push_back(std::move(split));
  return remade(scene, std::move(description));
}

NodalField prolonged(const CoarserMesh& coarser, NodalField u) {
  for (const auto& corners : coarser.corners) u.push_back(mean_at(corners, u));
  return u;
}

}  // namespace sandglass
