#pragma once

#include "math/rows.hpp"
#include "mesh/mesh.hpp"

namespace sandglass {

/// The order in which the time loop goes through a mesh, made once. Elements stand in strips, `width` strips
/// of equal length side by side in a group; groups stand in chunks that are slabs of the mesh. Chunks of even
/// number touch no node of each other, nor do those of odd number, so that any number of threads adds the
/// forces at a node in the same order. Nodes are rows in the order in which groups first meet them.
struct Layout {
  /// Strips side by side, level by level: the elements of one level are computed together.
  struct Group {
    std::size_t first_level;  ///< into `elements`, counted in levels
    std::size_t first_face;   ///< into `face_places`, counted in faces; a group has one more than levels
    std::size_t levels;
  };
  /// Groups first to last - 1, which are the first to meet rows first_row to last_row - 1.
  struct Chunk {
    std::size_t first;
    std::size_t last;
    std::size_t first_row;
    std::size_t last_row;
  };

  int width = 1;
  std::size_t nodes = 0;  ///< of the mesh; rows from here on are spare
  /// The node that a row stands for. Lanes without a strip of their own run along spare rows, which have the
  /// coordinates of these nodes and stay at rest, so that kernels need no branch.
  std::vector<int> node_of_row;
  std::vector<int> row_of_node;
  std::vector<Place> face_places;  ///< [face][corner][lane], places of rows
  std::vector<int> elements;       ///< [level][lane]; -1 in spare lanes
  std::vector<Group> groups;
  std::vector<Chunk> chunks;

  std::size_t rows() const { return node_of_row.size(); }
  std::size_t levels() const { return elements.size() / static_cast<std::size_t>(width); }

  /// Where the rows of one corner of a face stand, one per lane.
  const Place* places(std::size_t face, std::size_t corner) const {
    return face_places.data() + (4 * face + corner) * static_cast<std::size_t>(width);
  }
};

/// The layout of a mesh for kernels that compute `width` elements at a time.
Layout make_layout(const Mesh& mesh, int width);

}  // namespace sandglass
