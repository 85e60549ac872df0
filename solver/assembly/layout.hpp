#pragma once

#include <span>

#include "math/rows.hpp"
#include "mesh/mesh.hpp"

namespace sandglass {

/// Elements as a time loop goes through them: strips of equal length side by side, `width` of them to a
/// group, rank by rank, so that the elements of one rank are computed together. Lanes without a strip of
/// their own run along spare rows, which have the coordinates of nodes of the mesh and stay at rest, so that
/// kernels need no branch.
struct ElementGroups {
  struct Group {
    std::size_t first_rank;  ///< into `elements`, counted in ranks
    std::size_t first_face;  ///< into `face_places`, counted in faces; a group has one more than ranks
    std::size_t ranks;
  };

  int width = 1;
  std::vector<Place> face_places;  ///< [face][corner][lane], places of rows
  std::vector<int> elements;       ///< [rank][lane]; -1 in spare lanes
  std::vector<Group> groups;

  std::size_t ranks() const { return elements.size() / static_cast<std::size_t>(width); }

  /// Where the rows of one corner of a face stand, one per lane.
  const Place* places(std::size_t face, std::size_t corner) const {
    return face_places.data() + (4 * face + corner) * static_cast<std::size_t>(width);
  }
};

/// The order in which the time loop goes through a mesh, made once. Groups stand in chunks that are slabs of
/// the mesh. Chunks of even number touch no node of each other, nor do those of odd number, so that any
/// number of threads adds the forces at a node in the same order. Nodes are rows in the order in which groups
/// first meet them.
struct Layout : ElementGroups {
  /// Groups first to last - 1, which are the first to meet rows first_row to last_row - 1. Spare rows for
  /// strips of up to `spare_ranks` elements begin at `spare_row`, where the chunk has any.
  struct Chunk {
    std::size_t first;
    std::size_t last;
    std::size_t first_row;
    std::size_t last_row;
    std::size_t spare_row;
    std::size_t spare_ranks;
  };

  std::size_t nodes = 0;         ///< of the mesh; rows from here on are spare
  std::vector<int> node_of_row;  ///< the node that a row stands for, or whose coordinates a spare one has
  std::vector<int> row_of_node;
  std::vector<Chunk> chunks;

  std::size_t rows() const { return node_of_row.size(); }

  /// The elements of a chunk, in the order of the loop.
  std::vector<int> elements_of(const Chunk& chunk) const;
};

/// Which chunks have spare rows: those with lanes to spare, or all, for groups to come.
enum class SpareRows { where_needed, everywhere };

/// The layout of a mesh for kernels that compute `width` elements at a time.
Layout make_layout(const Mesh& mesh, int width, SpareRows spare_rows = SpareRows::where_needed);

class NodeElements;

/// Groups of some elements of a chunk by themselves, on the same rows; the layout must have spare rows
/// everywhere.
ElementGroups groups_within(const Layout& layout, const Layout::Chunk& chunk, const Mesh& mesh,
                            const NodeElements& neighbours, std::span<const int> elements);

}  // namespace sandglass
