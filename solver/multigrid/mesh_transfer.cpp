#include "multigrid/mesh_transfer.hpp"

#include "math/row_loops.hpp"

namespace sandglass {

MeshTransfer::MeshTransfer(const CoarserMesh& coarser_mesh, const Layout& fine_layout,
                           const ElementLevel& fine, const Layout& coarse_layout, const ElementLevel& coarse)
    : fine_(fine), coarse_(coarse), common_(coarse_layout.rows(), 0) {
  std::vector<std::vector<std::pair<std::uint32_t, float>>> from_coarse(fine_layout.rows()),
      from_fine(coarse_layout.rows());
  const auto row_in = [](const Layout& layout, int node) {
    return static_cast<std::uint32_t>(layout.row_of_node[at(node)]);
  };
  const auto add = [&](int fine_node, int coarse_node, float weight) {
    const std::uint32_t from = row_in(coarse_layout, coarse_node), to = row_in(fine_layout, fine_node);
    from_coarse[to].emplace_back(from, weight);
    from_fine[from].emplace_back(to, weight);
  };
  const auto common = static_cast<int>(coarser_mesh.mesh.points.size());
  for (int node = 0; node < common; ++node) {
    add(node, node, 1.0f);
    common_[row_in(coarse_layout, node)] = row_in(fine_layout, node);
  }
  for (std::size_t k = 0; k < coarser_mesh.corners.size(); ++k) {
    const auto& corners = coarser_mesh.corners[k];
    for (const int node : corners)
      add(common + static_cast<int>(k), node, 1.0f / static_cast<float>(corners.size()));
  }
  from_coarse_ = weights(from_coarse);
  from_fine_ = weights(from_fine);
  for (std::size_t e = 0; e < coarser_mesh.element_of.size(); ++e) {
    const auto of = at(coarser_mesh.element_of[e]);
    cells_.emplace_back(fine.cells()[e], coarse.cells()[of]);
  }
}

auto MeshTransfer::weights(const std::vector<std::vector<std::pair<std::uint32_t, float>>>& rows) -> Weights {
  Weights weights;
  for (const auto& row : rows) {
    weights.shares.insert(weights.shares.end(), row.begin(), row.end());
    weights.first.push_back(weights.shares.size());
  }
  return weights;
}

Rows<float> MeshTransfer::at_common_nodes(const Rows<float>& fine) const {
  Rows<float> u(common_.size());
  for (std::size_t row = 0; row + 1 < from_fine_.first.size(); ++row) {
    if (from_fine_.first[row] < from_fine_.first[row + 1]) u[row] = fine[common_[row]];
  }
  coarse_.follow(u);
  return u;
}

std::vector<float> MeshTransfer::means(const std::vector<float>& fine) const {
  std::vector<float> sums(coarse_.tangents().size(), 0.0f), parts = sums;
  for (const auto& [from, to] : cells_) {
    sums[to] += fine[from];
    parts[to] += 1.0f;
  }
  for (std::size_t cell = 0; cell < sums.size(); ++cell)
    sums[cell] = parts[cell] > 0.0f ? sums[cell] / parts[cell] : 1.0f;
  return sums;
}

void MeshTransfer::restrict_residual(const MixedVector& r, MixedVector& b) const {
  coarse_.blocks().u.for_each([&](std::size_t first, std::size_t last) {
    for (std::size_t row = first / 4; row < last / 4; ++row) {
      Row<float> sum;
      for (std::size_t k = from_fine_.first[row]; k < from_fine_.first[row + 1]; ++k) {
        const auto& [from, weight] = from_fine_.shares[k];
        for (std::size_t i = 0; i < 4; ++i) sum[i] += weight * r.u[from][i];
      }
      b.u[row] = sum;
    }
  });
  coarse_.ties().hand_on(b.u);
  std::fill(b.p.begin(), b.p.end(), 0.0f);
  for (const auto& [from, to] : cells_) b.p[to] += r.p[from];
}

void MeshTransfer::add_correction(const MixedVector& x, MixedVector& fine) const {
  const auto& free = fine_.free();
  fine_.blocks().u.for_each([&](std::size_t first, std::size_t last) {
    for (std::size_t row = first / 4; row < last / 4; ++row) {
      for (std::size_t k = from_coarse_.first[row]; k < from_coarse_.first[row + 1]; ++k) {
        const auto& [from, weight] = from_coarse_.shares[k];
        for (std::size_t i = 0; i < 4; ++i) fine.u[row][i] += free[row][i] * weight * x.u[from][i];
      }
    }
  });
  fine_.follow(fine.u);
  for (const auto& [to, from] : cells_) fine.p[to] += x.p[from];
}

}  // namespace sandglass
