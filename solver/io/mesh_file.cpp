#include "io/mesh_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace sandglass {

namespace {

constexpr std::size_t nodes_of_cell = std::tuple_size_v<Hexahedron>;

/// `what`: "node" or "element".
void require_number(const Hdf5File& file, const std::string& name, std::string_view what, std::int64_t number,
                    std::size_t count) {
  if (number >= 0 && number < static_cast<std::int64_t>(count)) return;
  throw InputError(fmt::format("{}: {} names {} {}; allowed are 0 to {}", file.path().string(), name, what,
                               number, count - 1));
}

void write_sets(const std::map<std::string, std::vector<int>>& sets, const std::string& group,
                Hdf5File& file) {
  for (const auto& [name, members] : sets) {
    const std::vector<std::int64_t> ids(members.begin(), members.end());
    file.write(fmt::format("{}/{}", group, name), {ids.size()}, std::span<const std::int64_t>(ids));
  }
}

/// Sets of `what`, "node" or "element", of which the mesh has `count`.
std::map<std::string, std::vector<int>> read_sets(const Hdf5File& file, const std::string& group,
                                                  std::string_view what, std::size_t count) {
  std::map<std::string, std::vector<int>> sets;
  for (const auto& name : file.names_in(group)) {
    const std::string dataset = fmt::format("{}/{}", group, name);
    const auto members = file.read<std::int64_t>(dataset).entries;
    if (members.size() > count) {
      throw InputError(fmt::format("{}: {} has {} {}s; allowed are the {} of the mesh, each once",
                                   file.path().string(), dataset, members.size(), what, count));
    }
    auto& set = sets[name];
    for (const auto member : members) {
      require_number(file, dataset, what, member, count);
      set.push_back(static_cast<int>(member));
    }
    std::sort(set.begin(), set.end());
    if (const auto twice = std::ranges::adjacent_find(set); twice != set.end()) {
      throw InputError(fmt::format(
          "{}: {} lists {} {} more than once; a set lists numbers from 0, each once (numpy.flatnonzero makes "
          "it from a mask of 0 and 1)",
          file.path().string(), dataset, what, *twice));
    }
  }
  return sets;
}

/// One row for each pair of a tied node and one that it follows.
void write_ties(const Ties& ties, Hdf5File& file) {
  if (ties.empty()) return;
  std::vector<std::int64_t> nodes, of;
  std::vector<double> weights;
  for (const Tie& tie : ties) {
    for (const auto& [node, weight] : tie.mean_of) {
      nodes.push_back(tie.node);
      of.push_back(node);
      weights.push_back(weight);
    }
  }
  file.write("/mesh/ties/node", {nodes.size()}, std::span<const std::int64_t>(nodes));
  file.write("/mesh/ties/of", {of.size()}, std::span<const std::int64_t>(of));
  file.write("/mesh/ties/weight", {weights.size()}, std::span<const double>(weights));
}

}  // namespace

void write_mesh(const Scene& scene, Hdf5File& file) {
  const Mesh& mesh = scene.mesh;
  file.write("/mesh/points", {mesh.points.size(), 3},
             std::span<const double>(mesh.points.front().data(), 3 * mesh.points.size()));
  std::vector<std::int64_t> cells;
  cells.reserve(nodes_of_cell * mesh.cells.size());
  for (const auto& cell : mesh.cells) cells.insert(cells.end(), cell.begin(), cell.end());
  file.write("/mesh/cells", {mesh.cells.size(), nodes_of_cell}, std::span<const std::int64_t>(cells));
  write_sets(scene.sets, "/mesh/sets", file);
  write_sets(scene.element_sets, "/mesh/element_sets", file);
  write_ties(scene.ties, file);
  if (!scene.materials.of_element.empty()) {
    const std::vector<std::int64_t> materials(scene.materials.of_element.begin(),
                                              scene.materials.of_element.end());
    file.write("/mesh/materials", {materials.size()}, std::span<const std::int64_t>(materials));
  }
  if (!scene.materials.axes.empty()) {
    const auto& axes = scene.materials.axes;
    file.write("/mesh/axes", {axes.size(), 3, 3},
               std::span<const double>(axes.front().entries.data(), 9 * axes.size()));
  }
  file.write_attribute("/", "case", scene.settings.name);
  file.write_attribute("/", "case_hash", scene.case_hash);
  file.write_attribute("/", "mesh_hash", scene.mesh_hash);
}

void write_mesh_file(const Scene& scene, const std::filesystem::path& path) {
  auto file = Hdf5File::create(path);
  write_mesh(scene, file);
  file.commit();
}

NodalField read_nodal_field(const Hdf5File& file, const std::string& name, std::size_t n_nodes) {
  const auto array = file.read<double>(name);
  if (array.shape != std::vector<std::size_t>{n_nodes, 3}) {
    throw InputError(fmt::format("{}: dataset '{}' has shape {}; it must be [{}, 3], one row per node",
                                 file.path().string(), name, array.shape, n_nodes));
  }
  NodalField field(n_nodes);
  for (std::size_t k = 0; k < array.entries.size(); ++k) {
    if (!std::isfinite(array.entries[k])) {
      throw InputError(fmt::format("{}: dataset '{}' holds {} at node {}; every value must be finite",
                                   file.path().string(), name, array.entries[k], k / 3));
    }
    field[k / 3][k % 3] = array.entries[k];
  }
  return field;
}

MeshWithSets read_mesh_file(const std::filesystem::path& path) {
  const auto file = Hdf5File::open(path);
  const auto cells = file.read<std::int64_t>("/mesh/cells");
  if (cells.shape.size() != 2 || cells.shape[1] != nodes_of_cell || cells.shape[0] == 0) {
    throw InputError(fmt::format(
        "{}: dataset '/mesh/cells' has shape {}; it must be [elements, 8], hexahedra in VTK order",
        path.string(), cells.shape));
  }
  if (file.contains("/mesh/ties")) {
    throw InputError(
        fmt::format("{}: has /mesh/ties, but a mesh file must have no hanging nodes. Use the mesh before "
                    "refinement, and [[refine]]",
                    path.string()));
  }
  const auto points = file.read<double>("/mesh/points");
  const std::size_t n_nodes = points.shape.empty() ? 0 : points.shape[0];
  MeshWithSets result;
  result.mesh.points = read_nodal_field(file, "/mesh/points", n_nodes);
  result.mesh.cells.resize(cells.shape[0]);
  for (std::size_t k = 0; k < cells.entries.size(); ++k) {
    require_number(file, "/mesh/cells", "node", cells.entries[k], n_nodes);
    result.mesh.cells[k / nodes_of_cell][k % nodes_of_cell] = static_cast<int>(cells.entries[k]);
  }
  std::vector<bool> used(n_nodes, false);
  for (const auto node : cells.entries) used[static_cast<std::size_t>(node)] = true;
  if (const auto unused = std::find(used.begin(), used.end(), false); unused != used.end()) {
    throw InputError(
        fmt::format("{}: node {} of /mesh/points belongs to no element ({} such nodes in all); they have "
                    "no mass and must be left out",
                    path.string(), unused - used.begin(), std::count(used.begin(), used.end(), false)));
  }
  result.sets = read_sets(file, "/mesh/sets", "node", n_nodes);
  result.element_sets = read_sets(file, "/mesh/element_sets", "element", result.mesh.cells.size());
  return result;
}

}  // namespace sandglass
