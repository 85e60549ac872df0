#include "assembly/layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "assembly/strips.hpp"
#include "base/error.hpp"

namespace sandglass {

namespace {

/// The number of elements that fit into a processor's second-level cache with their nodes.
constexpr std::size_t elements_per_chunk = 2048;
/// Meshes below this size form one chunk: dividing them would cost more than threads gain.
constexpr std::size_t smallest_cut_mesh = 256;

/// Elements sorted along the longest side of the mesh; those of one layer, equal up to roundoff, keep their
/// order.
std::vector<int> sorted_along_the_mesh(const Mesh& mesh) {
  const auto [low, high] = bounding_box(mesh.points);
  std::size_t axis = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (high[i] - low[i] > high[axis] - low[axis]) axis = i;
  }
  const double grain = 1e-6 * (high[axis] - low[axis]);
  std::vector<double> position(mesh.cells.size());
  for (std::size_t e = 0; e < position.size(); ++e) {
    double sum = 0.0;
    for (const int node : mesh.cells[e]) sum += mesh.points[at(node)][axis] - low[axis];
    position[e] = std::round(sum / static_cast<double>(mesh.cells[e].size()) / grain);
  }
  std::vector<int> order(mesh.cells.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return position[at(a)] < position[at(b)]; });
  return order;
}

/// The index at which chunk c of n begins in a list of `size`.
std::size_t chunk_begin(std::size_t size, std::size_t n, std::size_t c) {
  return size * c / n;
}

/// Whether slabs other than neighbours share no node.
bool neighbours_only_touch(const Mesh& mesh, const std::vector<int>& order, std::size_t n) {
  std::vector<std::size_t> lowest(mesh.points.size(), n);
  for (std::size_t c = 0; c < n; ++c) {
    for (std::size_t k = chunk_begin(order.size(), n, c); k < chunk_begin(order.size(), n, c + 1); ++k) {
      for (const int node : mesh.cells[at(order[k])]) {
        lowest[at(node)] = std::min(lowest[at(node)], c);
        if (lowest[at(node)] + 1 < c) return false;
      }
    }
  }
  return true;
}

/// An even number of slabs, as many as their size and the mesh allow.
std::size_t choose_chunks(const Mesh& mesh, const std::vector<int>& order) {
  if (order.size() < smallest_cut_mesh) return 1;
  std::size_t n = std::max<std::size_t>(4, order.size() / elements_per_chunk / 2 * 2);
  while (n > 2 && !neighbours_only_touch(mesh, order, n)) n = std::max<std::size_t>(2, n * 3 / 8 * 2);
  return n;
}

std::size_t longest(const std::vector<Strip>& strips) {
  std::size_t most = 0;
  for (const auto& strip : strips) most = std::max(most, strip.length());
  return most;
}

/// The strips of one material.
struct MaterialStrips {
  std::size_t material;
  std::vector<Strip> strips;
};

/// Strips of elements, separately for each material.
std::vector<MaterialStrips> cut_by_material(const Mesh& mesh, const NodeElements& neighbours,
                                            std::span<const int> elements,
                                            const std::vector<std::uint16_t>& materials) {
  if (materials.empty()) return {{0, cut_into_strips(mesh, neighbours, elements)}};
  std::map<std::size_t, std::vector<int>> by_material;
  for (const int e : elements) by_material[materials[at(e)]].push_back(e);
  std::vector<MaterialStrips> cut;
  for (const auto& [material, own] : by_material) {
    cut.push_back({material, cut_into_strips(mesh, neighbours, own)});
  }
  return cut;
}

/// The first of the longest strips.
const Strip& longest(const std::vector<MaterialStrips>& parts) {
  const Strip* found = &parts.front().strips.front();
  for (const auto& part : parts) {
    for (const Strip& strip : part.strips) {
      if (strip.length() > found->length()) found = &strip;
    }
  }
  return *found;
}

/// Packs strips of equal length side by side into groups.
class StripPacker {
 public:
  StripPacker(int width, std::size_t nodes) : taken_by_(nodes, -1) { groups_.width = width; }

  /// Adds strips, cut into pieces of at most `most_packs` elements. row_of(node) is called for the nodes of
  /// each group in turn; spare lanes run along the rows from `spare_row` on.
  template <class RowOf>
  void add(MaterialStrips open, std::size_t most_packs, std::size_t spare_row, const RowOf& row_of) {
    while (!open.strips.empty()) {
      add_group(open.material, choose(open.strips, most_packs), spare_row, row_of);
    }
  }

  std::size_t groups() const { return groups_.groups.size(); }

  /// Whether one of the groups from number `first` on has a lane without a strip.
  bool has_spare_lanes(std::size_t first) const {
    if (first >= groups()) return false;
    const auto pack = static_cast<std::ptrdiff_t>(groups_.groups[first].first_pack * at(groups_.width));
    return std::find(groups_.elements.begin() + pack, groups_.elements.end(), -1) != groups_.elements.end();
  }

  ElementGroups finish() { return std::move(groups_); }

 private:
  /// The greatest length that allows `width` pieces, or 1 if there are too few elements.
  std::size_t piece_length(const std::vector<Strip>& open, std::size_t most) const {
    for (std::size_t length = std::min(most, longest(open)); length > 1; --length) {
      std::size_t pieces = 0;
      for (const auto& strip : open) pieces += strip.length() / length;
      if (pieces >= at(groups_.width)) return length;
    }
    return 1;
  }

  /// Cuts up to `width` pieces of equal length off the open strips: preferably pieces that share no node,
  /// since lanes that add to the same row in turn stall the processor.
  std::vector<Strip> choose(std::vector<Strip>& open, std::size_t most_packs) {
    const std::size_t length = piece_length(open, most_packs);
    std::vector<Strip> chosen;
    ++round_;
    for (const bool apart : {true, false}) {
      for (auto& strip : open) {
        while (strip.length() >= length && chosen.size() < at(groups_.width)) {
          if (apart && !is_free(strip, length)) break;
          chosen.push_back(cut(strip, length));
          if (apart) break;
        }
      }
    }
    std::erase_if(open, [](const Strip& strip) { return strip.length() == 0; });
    return chosen;
  }

  /// Whether no node of the strip's first elements has been chosen in this round; marks them if so.
  bool is_free(const Strip& strip, std::size_t length) {
    for (std::size_t k = 0; k <= length; ++k) {
      for (const int node : strip.faces[k]) {
        if (taken_by_[at(node)] == round_) return false;
      }
    }
    for (std::size_t k = 0; k <= length; ++k) {
      for (const int node : strip.faces[k]) taken_by_[at(node)] = round_;
    }
    return true;
  }

  /// Cuts the first `length` elements off a strip.
  static Strip cut(Strip& strip, std::size_t length) {
    const auto n = static_cast<std::ptrdiff_t>(length);
    Strip piece{{strip.faces.begin(), strip.faces.begin() + n + 1},
                {strip.elements.begin(), strip.elements.begin() + n}};
    strip.faces.erase(strip.faces.begin(), strip.faces.begin() + n);
    strip.elements.erase(strip.elements.begin(), strip.elements.begin() + n);
    return piece;
  }

  template <class RowOf>
  void add_group(std::size_t material, const std::vector<Strip>& strips, std::size_t spare_row,
                 const RowOf& row_of) {
    const std::size_t length = strips.front().length(), width = at(groups_.width);
    groups_.groups.push_back({groups_.packs(), groups_.face_places.size() / (4 * width), length, material});
    for (const auto& strip : strips) {
      for (const auto& face : strip.faces) {
        for (const int node : face) row_of(node);
      }
    }
    std::vector<Place>& places = groups_.face_places;
    for (std::size_t k = 0; k <= length; ++k) {
      for (std::size_t corner = 0; corner < 4; ++corner) {
        for (const auto& strip : strips) places.push_back(place_of_row(row_of(strip.faces[k][corner])));
        places.resize(places.size() + width - strips.size(), place_of_row(spare_row + 4 * k + corner));
      }
    }
    for (std::size_t k = 0; k < length; ++k) {
      for (const auto& strip : strips) groups_.elements.push_back(strip.elements[k]);
      groups_.elements.resize(groups_.elements.size() + width - strips.size(), -1);
    }
  }

  ElementGroups groups_;
  std::vector<int> taken_by_;  // the round in which each node was last chosen
  int round_ = -1;
};

/// Divides the chunks of a layout among the ranks of its team, in pairs.
void divide_among_ranks(Layout& layout) {
  const std::size_t chunks = layout.chunks.size(), pairs = (chunks + 1) / 2;
  const auto ranks = at(layout.team.ranks->count()), rank = at(layout.team.ranks->rank());
  if (ranks > pairs) {
    throw InputError(fmt::format(
        "ranks: {} are too many for a mesh of {} elements; allowed: at most {}, or threads instead", ranks,
        layout.elements.size() - at(static_cast<int>(std::ranges::count(layout.elements, -1))), pairs));
  }
  std::vector<std::size_t> first_chunk;
  for (std::size_t r = 0; r <= ranks; ++r) first_chunk.push_back(std::min(chunks, 2 * (pairs * r / ranks)));
  layout.own_chunks = {first_chunk[rank], first_chunk[rank + 1]};
  layout.local_chunks = {layout.own_chunks.first, std::min(chunks, layout.own_chunks.last + 1)};
  std::vector<std::size_t> row_ends, cell_ends;
  const auto first_cell = [&](std::size_t group) {
    const bool end = group == layout.groups.size();
    return end ? layout.elements.size() : layout.groups[group].first_pack * at(layout.width);
  };
  for (const auto& chunk : layout.chunks) {
    row_ends.push_back(4 * chunk.last_row);
    cell_ends.push_back(first_cell(chunk.last));
  }
  // The neighbours' rows that own elements touch are those of one chunk on each side.
  const bool last = rank + 1 == ranks;
  const std::size_t below = layout.own_chunks.first - (rank > 0 ? 1 : 0);
  row_ends.push_back(4 * layout.rows());  // nodes in no element, and spare rows
  layout.row_blocks = Blocks(row_ends, {layout.own_chunks.first, last ? chunks + 1 : layout.own_chunks.last},
                             {below, last ? chunks + 1 : layout.local_chunks.last}, layout.team);
  layout.cell_blocks = Blocks(cell_ends, layout.own_chunks, layout.local_chunks, layout.team);
  for (std::size_t r = 0; r < ranks; ++r) {
    layout.rank_rows.push_back(layout.chunks[first_chunk[r]].first_row);
    layout.rank_cells.push_back(first_cell(layout.chunks[first_chunk[r]].first));
  }
  layout.rank_rows.push_back(layout.rows());
  layout.rank_cells.push_back(layout.elements.size());
}

}  // namespace

std::vector<int> Layout::elements_of(const Chunk& chunk) const {
  std::vector<int> found;
  for (std::size_t g = chunk.first; g < chunk.last; ++g) {
    const auto first = elements.begin() + static_cast<std::ptrdiff_t>(groups[g].first_pack * at(width));
    std::copy_if(first, first + static_cast<std::ptrdiff_t>(groups[g].packs * at(width)),
                 std::back_inserter(found), [](int e) { return e >= 0; });
  }
  return found;
}

Layout make_layout(const Mesh& mesh, int width, SpareRows spare_rows, std::vector<std::uint16_t> materials,
                   Team team) {
  const NodeElements neighbours(mesh);
  const std::vector<int> order = sorted_along_the_mesh(mesh);
  const std::size_t n = choose_chunks(mesh, order);
  Layout layout;
  layout.nodes = mesh.points.size();
  layout.materials = std::move(materials);
  layout.team = std::move(team);
  layout.row_of_node.assign(layout.nodes, -1);
  const auto number = [&](int node) {
    int& row = layout.row_of_node[at(node)];
    if (row < 0) {
      row = static_cast<int>(layout.rows());
      layout.node_of_row.push_back(node);
    }
    return at(row);
  };
  std::vector<int>
      spare;  // nodes whose coordinates spare rows have: those of the longest strip of each chunk
  StripPacker packer(width, layout.nodes);
  for (std::size_t c = 0; c < n; ++c) {
    const std::size_t begin = chunk_begin(order.size(), n, c), end = chunk_begin(order.size(), n, c + 1);
    const auto parts =
        cut_by_material(mesh, neighbours, std::span(order).subspan(begin, end - begin), layout.materials);
    const Strip& longest_strip = longest(parts);
    const std::size_t first = packer.groups(), first_row = layout.rows(),
                      spare_row = layout.nodes + spare.size(), spare_packs = longest_strip.length();
    for (const auto& part : parts) packer.add(part, spare_packs, spare_row, number);
    layout.chunks.push_back({first, packer.groups(), first_row, layout.rows(), spare_row, spare_packs});
    if (spare_rows == SpareRows::where_needed && !packer.has_spare_lanes(first)) continue;
    for (const auto& face : longest_strip.faces) spare.insert(spare.end(), face.begin(), face.end());
  }
  for (std::size_t node = 0; node < layout.nodes; ++node) number(static_cast<int>(node));  // in no element
  layout.node_of_row.insert(layout.node_of_row.end(), spare.begin(), spare.end());
  static_cast<ElementGroups&>(layout) = packer.finish();
  divide_among_ranks(layout);
  return layout;
}

ElementGroups groups_within(const Layout& layout, const Layout::Chunk& chunk, const Mesh& mesh,
                            const NodeElements& neighbours, std::span<const int> elements) {
  StripPacker packer(layout.width, layout.nodes);
  for (const auto& part : cut_by_material(mesh, neighbours, elements, layout.materials)) {
    packer.add(part, chunk.spare_packs, chunk.spare_row,
               [&](int node) { return at(layout.row_of_node[at(node)]); });
  }
  return packer.finish();
}

}  // namespace sandglass
