#include "solve/coarse_stiffness.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "mesh/hexahedron.hpp"

namespace sandglass {

namespace {

std::size_t at(int n) {
  return static_cast<std::size_t>(n);
}

/// 1 for free components, 0 for constrained ones.
NodalField free_components(const Scene& scene) {
  NodalField free(scene.mesh.points.size(), Vector{1.0, 1.0, 1.0});
  for (const auto& constraint : scene.constraints) free[at(constraint.node)][at(constraint.component)] = 0.0;
  return free;
}

bool touches_constraint(const Hexahedron& cell, const NodalField& free) {
  return std::any_of(cell.begin(), cell.end(), [&](int n) { return free[at(n)] != Vector{1.0, 1.0, 1.0}; });
}

Vector centre(const Mesh& mesh, const Hexahedron& cell) {
  Vector sum{};
  for (const int n : cell) {
    for (std::size_t i = 0; i < 3; ++i) sum[i] += mesh.points[at(n)][i] / 8.0;
  }
  return sum;
}

/// Whether the functions of a grid are nearly linear within a hexahedron: it is not much wider than half a
/// box.
bool is_small(const Mesh& mesh, const Hexahedron& cell, const Vector& middle, const CoarseGrid& grid) {
  return std::all_of(cell.begin(), cell.end(), [&](int n) {
    bool near = true;
    for (std::size_t i = 0; i < 3; ++i) {
      near = near && std::abs(mesh.points[at(n)][i] - middle[i]) < 0.3 * grid.box_size()[i];
    }
    return near;
  });
}

}  // namespace

CoarseStiffness::CoarseStiffness(const Scene& scene, const CoarseGrid& grid)
    : grid_(grid),
      size_(3 * grid.nodes()),
      lambda_(std::visit([](const auto& law) { return lame_lambda(law); }, scene.description.law)),
      mu_(std::visit([](const auto& law) { return law.shear_modulus(); }, scene.description.law)),
      boxes_(grid.boxes()),
      fixed_(size_ * size_),
      matrix_(fixed_.size()),
      inverse_(size_) {
  for (std::size_t c = 0; c < boxes_.size(); ++c) boxes_[c].nodes = grid.nodes_of(c);
  const NodalField free = free_components(scene);
  const auto& hexahedra = scene.mesh.cells;
  for (std::size_t e = 0; e < hexahedra.size(); ++e) {
    const Vector middle = centre(scene.mesh, hexahedra[e]);
    if (!touches_constraint(hexahedra[e], free) && is_small(scene.mesh, hexahedra[e], middle, grid)) {
      const auto [box, local] = grid.locate(middle);
      boxes_[box].elements.push_back({e, local});
    } else {
      add_fixed_element(scene, hexahedra[e], free);
    }
  }
}

/// V (lambda A_ii B_jj + mu A_ij B_ji + mu delta_ij A_i . B_i), where A_i is the gradient of a grid function
/// that moves component i of the free nodes.
void CoarseStiffness::add_fixed_element(const Scene& scene, const Hexahedron& cell, const NodalField& free) {
  const MeanGradient mean = mean_gradient(gather(scene.mesh.points, cell));
  std::map<std::size_t, Tensor<double>> gradients;  // of each grid node that reaches the element
  for (int I = 0; I < 8; ++I) {
    const std::size_t n = at(cell[at(I)]);
    const auto location = grid_.locate(scene.mesh.points[n]);
    const auto nodes = grid_.nodes_of(location.box);
    const auto w = CoarseGrid::weights(location.local);
    for (std::size_t k = 0; k < 8; ++k) {
      if (w[k] == 0.0) continue;
      Tensor<double>& G = gradients.try_emplace(nodes[k], Tensor<double>{}).first->second;
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) G(i, j) += free[n][at(i)] * w[k] * mean.h(I, j);
      }
    }
  }
  const double lambda = mean.volume * lambda_, mu = mean.volume * mu_;
  for (const auto& [a, A] : gradients) {
    for (const auto& [b, B] : gradients) {
      for (int i = 0; i < 3; ++i) {
        double* row = &fixed_[(3 * a + at(i)) * size_ + 3 * b];
        for (int j = 0; j < 3; ++j) row[j] += lambda * A(i, i) * B(j, j) + mu * A(i, j) * B(j, i);
        row[i] += mu * (A(i, 0) * B(i, 0) + A(i, 1) * B(i, 1) + A(i, 2) * B(i, 2));
      }
    }
  }
}

void CoarseStiffness::add_element(Products& T, const std::array<Vector, 8>& reference,
                                  const ElementTangent& tangent) {
  std::array<double, 24> G;
  for (std::size_t a = 0; a < 8; ++a) {
    for (int j = 0; j < 3; ++j) {
      double sum = 0.0;
      for (int i = 0; i < 3; ++i) sum += reference[a][at(i)] * tangent.inverse(i, j);
      G[3 * a + at(j)] = sum;
    }
  }
  for (std::size_t m = 0; m < 24; ++m) {
    const double VG = tangent.volume * G[m];
    double* const row = T.data() + 24 * m;
#pragma omp simd
    for (std::size_t n = 0; n < 24; ++n) row[n] += VG * G[n];
  }
}

void CoarseStiffness::assemble() {
  matrix_ = fixed_;
  for (const auto& [nodes, elements, T] : boxes_) {
    for (std::size_t a = 0; a < 8; ++a) {
      for (std::size_t b = 0; b < 8; ++b) {
        const double* const corner = T.data() + 72 * a + 3 * b;
        const auto product = [&](std::size_t i, std::size_t j) { return corner[24 * i + j]; };
        const double dot = product(0, 0) + product(1, 1) + product(2, 2);
        for (std::size_t i = 0; i < 3; ++i) {
          double* const row = &entry(3 * nodes[a] + i, 3 * nodes[b]);
          for (std::size_t j = 0; j < 3; ++j) row[j] += lambda_ * product(i, j) + mu_ * product(j, i);
          row[i] += mu_ * dot;
        }
      }
    }
  }
}

}  // namespace sandglass
