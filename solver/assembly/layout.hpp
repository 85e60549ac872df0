#pragma once

#include <cstdint>
#include <span>

#include "base/ranks.hpp"
#include "math/row_loops.hpp"
#include "math/rows.hpp"
#include "mesh/mesh.hpp"

namespace sandglass {

/// Elements in the order of a time loop. A group consists of up to `width` strips of one material and of
/// equal length side by side, one per lane. Its k-th pack consists of the k-th elements of its strips, which
/// are computed together. Lanes without a strip run along spare rows, which have the coordinates of nodes of
/// the mesh and zero displacements, so that kernels need no branch.
struct ElementGroups {
  struct Group {
    std::size_t first_pack;  ///< into `elements`, counted in packs
    std::size_t first_face;  ///< into `face_places`, counted in faces; a group has one more than packs
    std::size_t packs;
    std::size_t material;
  };

  int width = 1;
  std::vector<Place> face_places;  ///< [face][corner][lane], places of rows
  std::vector<int> elements;       ///< [pack][lane]; -1 in spare lanes
  std::vector<Group> groups;

  std::size_t packs() const { return elements.size() / static_cast<std::size_t>(width); }

  /// Calls use(first, last) for the runs of groups of one material within `first` to `last` - 1.
  template <class Use>
  void for_each_run(std::size_t first, std::size_t last, const Use& use) const {
    for (std::size_t next = first; first < last; first = next) {
      while (next < last && groups[next].material == groups[first].material) ++next;
      use(first, next);
    }
  }

  /// The places of the rows of one corner of a face, one per lane.
  const Place* places(std::size_t face, std::size_t corner) const {
    return face_places.data() + (4 * face + corner) * static_cast<std::size_t>(width);
  }
};

/// The order in which the time loop goes through a mesh, computed once. Groups are divided into chunks, which
/// are slabs of the mesh. Even chunks share no nodes with each other, nor do odd ones, so that any number of
/// threads adds the forces at a node in the same order. Rows are nodes in the order of their first occurrence
/// in the groups; cells are lanes, pack by pack.
///
/// Each rank of a team owns some chunks and the rows that occur first in them. It also computes the first
/// chunk of the rank above, which touches its last rows, so that the forces of all its rows are complete.
struct Layout : ElementGroups {
  /// Groups first to last - 1, in which rows first_row to last_row - 1 occur first. Spare rows for strips of
  /// up to `spare_packs` elements begin at `spare_row`, if the chunk has any.
  struct Chunk {
    std::size_t first;
    std::size_t last;
    std::size_t first_row;
    std::size_t last_row;
    std::size_t spare_row;
    std::size_t spare_packs;
  };

  std::size_t nodes = 0;         ///< of the mesh; rows from here on are spare
  std::vector<int> node_of_row;  ///< the node of a row, or the one whose coordinates a spare row has
  std::vector<int> row_of_node;
  std::vector<Chunk> chunks;
  std::vector<std::uint16_t> materials;  ///< of each element; empty if there is only one

  Team team;
  Blocks::Range own_chunks;             ///< of this rank
  Blocks::Range local_chunks;           ///< that it computes
  Blocks row_blocks;                    ///< of vectors with four numbers for each row
  Blocks cell_blocks;                   ///< of vectors with a number for each cell
  std::vector<std::size_t> rank_rows;   ///< where the own rows of each rank begin, and the end
  std::vector<std::size_t> rank_cells;  ///< the same for its cells

  std::size_t rows() const { return node_of_row.size(); }

  /// Calls body(c) for the chunks that this rank computes, in parallel.
  template <class Body>
  void for_each_local_chunk(const Body& body) const {
    in_parallel(local_chunks.last - local_chunks.first, team.threads,
                [&](std::size_t k) { body(local_chunks.first + k); });
  }

  /// Sends the values of each rank's own rows, or cells, to all others.
  template <class T>
  void gather_rows(T* values, std::size_t of_each = 1) const {
    gather(values, rank_rows, of_each);
  }
  template <class T>
  void gather_cells(T* values, std::size_t of_each = 1) const {
    gather(values, rank_cells, of_each);
  }

  /// Whether this rank owns the row of a node.
  bool owns(int node) const {
    const auto row = static_cast<std::size_t>(row_of_node[static_cast<std::size_t>(node)]);
    const auto rank = static_cast<std::size_t>(team.ranks->rank());
    return row >= rank_rows[rank] && row < rank_rows[rank + 1];
  }

  /// The elements of a chunk, in the order of the loop.
  std::vector<int> elements_of(const Chunk& chunk) const;

 private:
  template <class T>
  void gather(T* values, std::vector<std::size_t> bounds, std::size_t of_each) const {
    for (std::size_t& bound : bounds) bound *= of_each * sizeof(T);
    team.ranks->gather(reinterpret_cast<std::byte*>(values), bounds);
  }
};

/// Which chunks have spare rows: those with spare lanes, or all, for groups made later.
enum class SpareRows { where_needed, everywhere };

/// The layout of a mesh for kernels that compute `width` elements at a time; `materials` as in Layout. Throws
/// InputError if there are more ranks than pairs of chunks.
Layout make_layout(const Mesh& mesh, int width, SpareRows spare_rows = SpareRows::where_needed,
                   std::vector<std::uint16_t> materials = {}, Team team = {});

class NodeElements;

/// Groups of a subset of the elements of a chunk, on the same rows; the layout must have spare rows
/// everywhere.
ElementGroups groups_within(const Layout& layout, const Layout::Chunk& chunk, const Mesh& mesh,
                            const NodeElements& neighbours, std::span<const int> elements);

}  // namespace sandglass
