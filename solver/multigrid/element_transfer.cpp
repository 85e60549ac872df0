#include "multigrid/element_transfer.hpp"

#include <algorithm>
#include <cmath>

#include "math/row_loops.hpp"

namespace sandglass {

namespace {

/// The stiffness of the springs at constrained components over the node's own: high enough to hold the grid's
/// functions, low enough not to spoil its smoother.
constexpr float spring = 10.0f;

/// An element wider than this share of a box along an axis bends within the box: a single sample at its
/// centre would miss that stiffness.
constexpr double wide = 0.6;

bool is_wide(const Vector& extent, const Vector& box) {
  return extent[0] > wide * box[0] || extent[1] > wide * box[1] || extent[2] > wide * box[2];
}

/// At the body's edge, a node of the grid may move nodes of elements, and so receive their forces, but hardly
/// any sample: it would be a millionfold too soft. If the elements' centres contribute less than this share
/// of their nodes' contribution, the elements there are also sampled at their nodes, with this share of their
/// volume.
constexpr float sparse = 0.25f, sparse_share_at_nodes = 0.4f;

/// The gradients (1/m) of a box's functions, by corner.
std::array<std::array<float, 3>, 8> gradients(const std::array<float, 3>& local, const Vector& size) {
  const auto factor = [&](std::size_t c, std::size_t i) {
    return (c >> i & 1) != 0 ? local[i] : 1.0f - local[i];
  };
  std::array<std::array<float, 3>, 8> G;
  for (std::size_t c = 0; c < 8; ++c) {
    for (std::size_t i = 0; i < 3; ++i) {
      const float slope = ((c >> i & 1) != 0 ? 1.0f : -1.0f) / static_cast<float>(size[i]);
      G[c][i] = slope * factor(c, (i + 1) % 3) * factor(c, (i + 2) % 3);
    }
  }
  return G;
}

/// The same in the current configuration.
std::array<float, 24> pushed_forward(const std::array<std::array<float, 3>, 8>& G,
                                     const ElementTangent& tangent) {
  std::array<float, 24> g;
  for (std::size_t a = 0; a < 8; ++a) {
    for (std::size_t j = 0; j < 3; ++j) {
      g[3 * a + j] =
          G[a][0] * tangent.inverse[j] + G[a][1] * tangent.inverse[3 + j] + G[a][2] * tangent.inverse[6 + j];
    }
  }
  return g;
}

}  // namespace

ElementTransfer::ElementTransfer(const Mesh& mesh, const Layout& layout, const ElementLevel& elements,
                                 GridLevel& grid)
    : elements_(elements),
      grid_(grid),
      boxes_(layout.elements.size()),
      contents_(grid.grid().nodes()),
      sums_(contents_.size()) {
  for (std::size_t row = 0; row < layout.rows(); ++row) {
    places_.push_back(grid.grid().locate(mesh.points[static_cast<std::size_t>(layout.node_of_row[row])]));
    if (row < layout.nodes && elements.ties().shares_of(row).empty())
      contents_[places_[row].box].rows.push_back(static_cast<std::uint32_t>(row));
  }
  const std::vector<bool> sparse = sparse_boxes(mesh);
  for (std::size_t element = 0; element < mesh.cells.size(); ++element) {
    const bool reaches = std::any_of(mesh.cells[element].begin(), mesh.cells[element].end(), [&](int n) {
      return sparse[grid.grid().locate(mesh.points[at(n)]).box];
    });
    sample(mesh, element, reaches ? sparse_share_at_nodes : 0.0f);
  }
}

/// The boxes with a corner that has few elements' centres around it, compared with elements' nodes.
std::vector<bool> ElementTransfer::sparse_boxes(const Mesh& mesh) const {
  const Grid& grid = grid_.grid();
  std::vector<float> centres(grid.nodes()), nodes(centres);
  const auto add = [&](const Vector& x, float share, std::vector<float>& sums) {
    const Grid::Location place = grid.locate(x);
    const auto w = weights(place.local);
    for (std::size_t a = 0; a < 8; ++a) sums[place.box + grid.corner(a)] += share * w[a];
  };
  for (const auto& cell : mesh.cells) {
    add(mean_at(cell, mesh.points), 1.0f, centres);
    for (const int n : cell) add(mesh.points[at(n)], 0.125f, nodes);
  }
  std::vector<bool> boxes(grid.nodes());
  for (std::size_t node = 0; node < nodes.size(); ++node) {
    if (centres[node] >= sparse * nodes[node]) continue;
    for (std::size_t a = 0; a < 8; ++a) boxes[node - grid.corner(a)] = true;
  }
  return boxes;
}

/// Samples an element at its centre or at eight Gauss points, and with a share at its nodes.
void ElementTransfer::sample(const Mesh& mesh, std::size_t element, float share_at_nodes) {
  const Grid& grid = grid_.grid();
  const auto cell = static_cast<std::uint32_t>(elements_.cells()[element]);
  const Vector middle = mean_at(mesh.cells[element], mesh.points);
  const Grid::Location place = grid.locate(middle);
  boxes_[cell] = place.box;
  contents_[place.box].cells.push_back(cell);
  const auto sample_corners = [&](double distance, float share) {
    for (const int n : mesh.cells[element]) {
      Vector x = middle;
      for (std::size_t i = 0; i < 3; ++i) x[i] += distance * (mesh.points[at(n)][i] - middle[i]);
      const Grid::Location corner = grid.locate(x);
      contents_[corner.box].samples.push_back({cell, 0.125f * share, corner.local});
    }
  };
  const float rest = 1.0f - share_at_nodes;
  if (share_at_nodes > 0.0f) sample_corners(1.0, share_at_nodes);
  if (is_wide(extent(mesh, mesh.cells[element]), grid.size)) {
    sample_corners(1.0 / std::sqrt(3.0), rest);
  } else {
    contents_[place.box].samples.push_back({cell, rest, place.local});
  }
}

void ElementTransfer::gather() {
  grid_.for_each_line(0, [&](std::size_t first, std::size_t count) {
    for (std::size_t box = first; box < first + count; ++box) {
      grid_.problems()[box] = problem_of(contents_[box]);
    }
  });
  without_contact_.clear();
  if (!elements_.touching().empty()) gather_contact();
}

void ElementTransfer::gather_contact() {
  if (without_contact_.empty()) {
    without_contact_ = grid_.problems();
    has_contact_.assign(contents_.size(), 0);
  }
  grid_.for_each_line(0, [&](std::size_t first, std::size_t count) {
    for (std::size_t box = first; box < first + count; ++box) {
      const bool touches = std::ranges::any_of(
          contents_[box].rows, [&](std::uint32_t row) { return elements_.touching_at(row) != nullptr; });
      if (!touches && has_contact_[box] == 0) continue;
      has_contact_[box] = touches ? 1 : 0;
      grid_.problems()[box] = without_contact_[box];
      if (touches) add_contact(contents_[box], grid_.problems()[box]);
    }
  });
}

BoxProblem ElementTransfer::problem_of(const Contents& contents) const {
  BoxProblem problem{};
  std::array<float, 576> T{};  // integral of mu times the products of gradients
  for (const auto& [cell, share, local] : contents.samples) {
    const ElementTangent& tangent = elements_.tangents()[cell];
    const float volume = share * tangent.volume;
    const std::array<float, 24> g = pushed_forward(gradients(local, grid_.grid().size), tangent);
    for (std::size_t m = 0; m < 24; ++m) {
      const float Vg = volume * g[m], mu_Vg = tangent.mu * Vg;
      float* row = T.data() + 24 * m;
#pragma omp simd
      for (std::size_t n = 0; n < 24; ++n) row[n] += mu_Vg * g[n];
      problem.B[m] += tangent.jacobian * Vg;
    }
    problem.C += volume / tangent.lambda;
  }
  // 2 mu sym(grad u) : sym(grad v)
  for (std::size_t a = 0; a < 8; ++a) {
    for (std::size_t b = 0; b < 8; ++b) {
      const auto product = [&](std::size_t i, std::size_t j) { return T[24 * (3 * a + i) + 3 * b + j]; };
      const float scalar = product(0, 0) + product(1, 1) + product(2, 2);
      for (std::size_t i = 0; i < 3; ++i) {
        float* row = &problem.A[24 * (3 * a + i) + 3 * b];
        for (std::size_t j = 0; j < 3; ++j) row[j] += product(j, i);
        row[i] += scalar;
      }
    }
  }
  for (const std::uint32_t row : contents.rows) {
    for (std::size_t i = 0; i < 3; ++i) {
      const bool held = elements_.free()[row][i] == 0.0f;
      const float k = held                           ? spring * elements_.stiffness()[row][i]
                      : !elements_.springs().empty() ? elements_.springs()[row][i]
                                                     : 0.0f;
      if (k == 0.0f) continue;
      const auto w = weights(places_[row].local);
      for (std::size_t a = 0; a < 8; ++a) {
        for (std::size_t b = 0; b < 8; ++b) problem.A[24 * (3 * a + i) + 3 * b + i] += k * w[a] * w[b];
      }
    }
  }
  return problem;
}

void ElementTransfer::add_contact(const Contents& contents, BoxProblem& problem) const {
  for (const std::uint32_t row : contents.rows) {
    const SaddleLevel::Touching* one = elements_.touching_at(row);
    if (one == nullptr) continue;
    const auto w = weights(places_[row].local);
    for (std::size_t a = 0; a < 24; ++a) {
      for (std::size_t b = 0; b < 24; ++b) {
        const int i = static_cast<int>(a % 3), j = static_cast<int>(b % 3);
        problem.A[24 * a + b] += w[a / 3] * w[b / 3] * one->ground(i, j);
      }
    }
  }
}

void ElementTransfer::restrict_residual(const MixedVector& r, MixedVector& b) {
  grid_.set_by_lines(0, sums_, [&](std::size_t first, std::size_t count) {
    for (std::size_t box = first; box < first + count; ++box) {
      auto& sums = sums_[box];
      sums.fill({});
      for (const std::uint32_t row : contents_[box].rows) {
        const auto w = weights(places_[row].local);
        for (std::size_t a = 0; a < 8; ++a) {
          for (std::size_t i = 0; i < 4; ++i) sums[a][i] += w[a] * r.u[row][i];
        }
      }
    }
  });
  grid_.set_by_lines(0, b.p, [&](std::size_t first, std::size_t count) {
    for (std::size_t box = first; box < first + count; ++box) {
      float p = 0.0f;
      for (const std::uint32_t cell : contents_[box].cells) p += r.p[cell];
      b.p[box] = p;
    }
  });
  grid_.set_by_lines(1, b.u, [&](std::size_t first, std::size_t count) {
    for (std::size_t n = first; n < first + count; ++n) {
      Row<float> sum;
      for (std::size_t a = 0; a < 8; ++a) {
        for (std::size_t i = 0; i < 4; ++i) sum[i] += sums_[n - grid_.grid().corner(a)][a][i];
      }
      b.u[n] = sum;
    }
  });
}

void ElementTransfer::add_correction(const MixedVector& x, MixedVector& fine) const {
  const auto& free = elements_.free();
  elements_.blocks().u.for_each([&](std::size_t first, std::size_t last) {
    for (std::size_t row = first / 4; row < last / 4; ++row) {
      const auto w = weights(places_[row].local);
      Row<float> sum;
      for (std::size_t a = 0; a < 8; ++a) {
        const Row<float>& v = x.u[places_[row].box + grid_.grid().corner(a)];
        for (std::size_t i = 0; i < 4; ++i) sum[i] += w[a] * v[i];
      }
      for (std::size_t i = 0; i < 4; ++i) fine.u[row][i] += free[row][i] * sum[i];
    }
  });
  elements_.follow(fine.u);
  elements_.blocks().p.for_each([&](std::size_t first, std::size_t last) {
    for (std::size_t cell = first; cell < last; ++cell) fine.p[cell] += x.p[boxes_[cell]];
  });
}

}  // namespace sandglass
