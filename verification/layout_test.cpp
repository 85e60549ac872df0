/// The order of nodes and elements in the time loop.

#include <gtest/gtest.h>

#include <set>

#include "assembly/strips.hpp"
#include "support/mesh_kinds.hpp"
#include "support/scenes.hpp"

namespace sandglass::verification::layout_test {
namespace {

/// Each element occurs once, between two faces that hold exactly its nodes, oriented so that its volume is
/// positive; spare lanes hold none.
TEST(LayoutTest, every_element_stands_once_between_its_faces) {
  for (const Mesh& mesh : meshes()) {
    for (const int width : {1, 2, 4, 8, 16}) {
      const Layout layout = make_layout(mesh, width);
      std::vector<int> met(mesh.cells.size(), 0);
      for (const auto& group : layout.groups) {
        for (std::size_t k = 0; k < group.packs; ++k) {
          for (int lane = 0; lane < width; ++lane) {
            const int e = layout.elements[(group.first_pack + k) * index(width) + index(lane)];
            NodalVectors<double> X{};
            std::set<int> nodes;
            for (int I = 0; I < 8; ++I) {
              const Place place = layout.places(group.first_face + k + index(I) / 4, index(I) % 4)[lane];
              ASSERT_EQ(e < 0, place / 4 >= layout.nodes);
              const int node = layout.node_of_row[place / 4];
              nodes.insert(node);
              for (int i = 0; i < 3; ++i) X(I, i) = mesh.points[index(node)][index(i)];
            }
            EXPECT_GT(mean_gradient(X).volume, 0.0);
            if (e < 0) continue;
            ++met[index(e)];
            const Hexahedron& cell = mesh.cells[index(e)];
            EXPECT_EQ(nodes, std::set<int>(cell.begin(), cell.end()));
          }
        }
      }
      EXPECT_EQ(met, std::vector<int>(mesh.cells.size(), 1));
    }
  }
}

TEST(LayoutTest, rows_and_nodes_are_a_permutation) {
  for (const Mesh& mesh : meshes()) {
    const Layout layout = make_layout(mesh, 8);
    EXPECT_EQ(layout.nodes, mesh.points.size());
    for (std::size_t n = 0; n < layout.nodes; ++n) {
      EXPECT_EQ(layout.node_of_row[index(layout.row_of_node[n])], static_cast<int>(n));
    }
  }
}

/// Threads work on chunks of one parity at a time: they must share no row.
TEST(LayoutTest, chunks_of_one_parity_share_no_row) {
  for (const Mesh& mesh : meshes()) {
    for (const int width : {1, 8, 16}) {
      const Layout layout = make_layout(mesh, width);
      for (const std::size_t parity : {0U, 1U}) {
        std::vector<int> owner(layout.rows(), -1);
        for (std::size_t c = parity; c < layout.chunks.size(); c += 2) {
          for (std::size_t g = layout.chunks[c].first; g < layout.chunks[c].last; ++g) {
            const auto& group = layout.groups[g];
            for (std::size_t n = 0; n < 4 * index(width) * (group.packs + 1); ++n) {
              int& by = owner[layout.places(group.first_face, 0)[n] / 4];
              EXPECT_TRUE(by == -1 || by == static_cast<int>(c));
              by = static_cast<int>(c);
            }
          }
        }
      }
    }
  }
}

/// Strips pay only if they are long: in a box they run from side to side of a chunk.
TEST(LayoutTest, strips_of_a_box_are_long_and_lanes_are_filled) {
  const Layout layout = make_layout(box({3, 2, 2.5}, {24, 16, 20}), 8);
  std::size_t packs = 0;
  for (const auto& group : layout.groups) packs += group.packs;
  EXPECT_GE(packs / layout.groups.size(), 8U);
  EXPECT_LT(layout.packs() * 8, 24U * 16U * 20U * 101 / 100);
}

}  // namespace
}  // namespace sandglass::verification::layout_test
