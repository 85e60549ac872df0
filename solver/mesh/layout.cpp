#include "mesh/layout.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesh/strips.hpp"

namespace sandglass {

namespace {

std::size_t at(int n) {
  return static_cast<std::size_t>(n);
}

/// Elements that fit into a processor's second cache with their nodes.
constexpr std::size_t elements_per_chunk = 2048;
/// Meshes below this size stay in one chunk: cutting them up would cost more than threads bring.
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
    position[e] = std::round(sum / 8.0 / grain);
  }
  std::vector<int> order(mesh.cells.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return position[at(a)] < position[at(b)]; });
  return order;
}

/// Where chunk c of n begins in a list of `size`.
std::size_t chunk_begin(std::size_t size, std::size_t n, std::size_t c) {
  return size * c / n;
}

/// Whether slabs two apart share no node.
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

/// Puts strips side by side and numbers their nodes.
class Grouping {
 public:
  Grouping(const Mesh& mesh, int width) : taken_by_(mesh.points.size(), -1) {
    layout_.width = width;
    layout_.nodes = mesh.points.size();
    layout_.row_of_node.assign(mesh.points.size(), -1);
  }

  void add_chunk(std::vector<Strip> open) {
    const std::size_t first = layout_.groups.size(), first_row = layout_.rows();
    while (!open.empty()) add_group(choose(open));
    layout_.chunks.push_back({first, layout_.groups.size(), first_row, layout_.rows()});
  }

  /// The layout, after the last chunk: spare rows come behind the nodes.
  Layout finish() {
    for (std::size_t node = 0; node < layout_.nodes; ++node) number(static_cast<int>(node));  // in no element
    for (const int row : face_rows_) {
      layout_.face_places.push_back(place_of_row(row < 0 ? layout_.nodes + at(-row - 1) : at(row)));
    }
    layout_.node_of_row.insert(layout_.node_of_row.end(), spare_.begin(), spare_.end());
    return std::move(layout_);
  }

 private:
  /// The greatest length that allows `width` pieces, or 1 when elements are too few.
  std::size_t piece_length(const std::vector<Strip>& open) const {
    std::size_t longest = 0;
    for (const auto& strip : open) longest = std::max(longest, strip.length());
    for (std::size_t length = longest; length > 1; --length) {
      std::size_t pieces = 0;
      for (const auto& strip : open) pieces += strip.length() / length;
      if (pieces >= at(layout_.width)) return length;
    }
    return 1;
  }

  /// Takes up to `width` pieces of equal length off the open strips: first such that share no node, for a
  /// processor waits when lanes add to one row in turn; then any.
  std::vector<Strip> choose(std::vector<Strip>& open) {
    const std::size_t length = piece_length(open);
    std::vector<Strip> chosen;
    ++round_;
    for (const bool apart : {true, false}) {
      for (auto& strip : open) {
        while (strip.length() >= length && chosen.size() < at(layout_.width)) {
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

  /// Takes the first elements off a strip.
  static Strip cut(Strip& strip, std::size_t length) {
    const auto n = static_cast<std::ptrdiff_t>(length);
    Strip piece{{strip.faces.begin(), strip.faces.begin() + n + 1},
                {strip.elements.begin(), strip.elements.begin() + n}};
    strip.faces.erase(strip.faces.begin(), strip.faces.begin() + n);
    strip.elements.erase(strip.elements.begin(), strip.elements.begin() + n);
    return piece;
  }

  void add_group(const std::vector<Strip>& strips) {
    const std::size_t length = strips.front().length();
    layout_.groups.push_back({layout_.levels(), face_rows_.size() / (4 * at(layout_.width)), length});
    for (const auto& strip : strips) {
      for (const auto& face : strip.faces) {
        for (const int node : face) number(node);
      }
    }
    const bool spare = strips.size() < at(layout_.width);
    const std::size_t first_spare = spare_.size();
    for (std::size_t k = 0; k <= length; ++k) {
      for (std::size_t corner = 0; corner < 4; ++corner) {
        for (const auto& strip : strips)
          face_rows_.push_back(layout_.row_of_node[at(strip.faces[k][corner])]);
        const auto spare_row = -static_cast<int>(first_spare + 4 * k + corner) - 1;
        face_rows_.resize(face_rows_.size() + at(layout_.width) - strips.size(), spare_row);
        if (spare) spare_.push_back(strips.front().faces[k][corner]);
      }
    }
    for (std::size_t k = 0; k < length; ++k) {
      for (const auto& strip : strips) layout_.elements.push_back(strip.elements[k]);
      layout_.elements.resize(layout_.elements.size() + at(layout_.width) - strips.size(), -1);
    }
  }

  void number(int node) {
    int& row = layout_.row_of_node[at(node)];
    if (row >= 0) return;
    row = static_cast<int>(layout_.node_of_row.size());
    layout_.node_of_row.push_back(node);
  }

  Layout layout_;
  std::vector<int> face_rows_;  // [face][corner][lane]; -1, -2, ... in spare rows
  std::vector<int> spare_;      // nodes whose coordinates the spare rows take
  std::vector<int> taken_by_;   // round in which a node was last chosen
  int round_ = -1;
};

}  // namespace

Layout make_layout(const Mesh& mesh, int width) {
  const NodeElements neighbours(mesh);
  const std::vector<int> order = sorted_along_the_mesh(mesh);
  const std::size_t n = choose_chunks(mesh, order);
  Grouping grouping(mesh, width);
  for (std::size_t c = 0; c < n; ++c) {
    const std::size_t begin = chunk_begin(order.size(), n, c), end = chunk_begin(order.size(), n, c + 1);
    grouping.add_chunk(cut_into_strips(mesh, neighbours, std::span(order).subspan(begin, end - begin)));
  }
  return grouping.finish();
}

}  // namespace sandglass
