/// The multigrid method for nearly incompressible bodies: symmetric, and as effective on fine meshes as on
/// coarse ones.

#include <gtest/gtest.h>

#include "multigrid/saddle_multigrid.hpp"
#include "solve/acceleration.hpp"
#include "solve/relaxation.hpp"
#include "support/random_hexahedra.hpp"
#include "support/scenes.hpp"

namespace sandglass::verification::multigrid_test {
namespace {

/// A bar of distorted elements, held at one end; no method involved.
struct HeldBar {
  /// Elements at an edge of the held end are split `depth` times.
  HeldBar(int n, double poisson_ratio, double noise = 0.1, int depth = 0)
      : mesh(box({1.0, 1.0, 2.0}, {n, n, 2 * n})) {
    RandomGeometry random(5);
    for (Vector& X : mesh.points) {
      for (double& x : X) x += noise / n * random.uniform(-1.0, 1.0);
    }
    RefinedMesh refined(mesh);
    for (int d = 0; d < depth; ++d) {
      std::vector<bool> marked;
      for (const auto& cell : refined.mesh().cells) {
        const Vector X = mean_at(cell, refined.mesh().points);
        marked.push_back(std::hypot(X[0], X[2] - 1.5 / n) < 1.5 / n / (1 << d));
      }
      refined.split(std::move(marked));
    }
    mesh = refined.mesh();
    const Ties ties = to_free_nodes(refined.ties());
    coarser = refined.coarser();
    layout = make_layout(mesh, 4);
    free = Rows<float>(layout.rows());
    for (std::size_t row = 0; row < layout.nodes; ++row) {
      const int node = layout.node_of_row[row];
      const bool held = mesh.points[index(node)][2] <= 1.5 / n || is_tied(ties, node);
      if (!held) free[row] = {{1.0f, 1.0f, 1.0f, 0.0f}};
    }
    multigrid = std::make_unique<SaddleMultigrid>(mesh, ties, coarser, layout, free, Rows<float>{});
    const NeoHookean law{.young_modulus = 3.0, .poisson_ratio = poisson_ratio};
    multigrid->update(Rows<float>(layout.rows()), {{lame_lambda(law), law.shear_modulus(), 1.0 / 3.0}},
                      std::vector<float>(layout.elements.size(), 1.0f));
  }

  MixedVector random_vector(std::uint64_t seed) const {
    RandomGeometry random(seed);
    MixedVector b = multigrid->elements().zero();
    for (std::size_t row = 0; row < layout.nodes; ++row) {
      for (std::size_t i = 0; i < 3; ++i)
        b.u[row][i] = free[row][i] * static_cast<float>(random.uniform(-1.0, 1.0));
    }
    for (const std::size_t cell : multigrid->elements().cells()) {
      b.p[cell] = static_cast<float>(random.uniform(-1.0, 1.0) / static_cast<double>(mesh.cells.size()));
    }
    return b;
  }

  /// The number of accelerated cycles that reduce the residual to 1e-4.
  int cycles() const {
    const MixedBlocks& blocks = multigrid->elements().blocks();
    const MixedVector b = random_vector(3);
    MixedVector x = multigrid->elements().zero(), r = b, step = x, correction = x;
    multiply(-1.0f, r, blocks);  // A x - b
    Acceleration acceleration(blocks);
    const double first = std::sqrt(dot(r, r, blocks));
    for (int n = 0; n < 100; ++n) {
      if (std::sqrt(dot(r, r, blocks)) < 1e-4 * first) return n;
      acceleration.combine(r, step);
      multigrid->cycle(r, correction);
      add(-1.0f, correction, step, blocks);
      add(1.0f, step, x, blocks);
      acceleration.moved(step);
      multigrid->elements().residual(b, x, r);
      multiply(-1.0f, r, blocks);
    }
    return 100;
  }

  Mesh mesh;
  std::vector<CoarserMesh> coarser;
  Layout layout;
  Rows<float> free;
  std::unique_ptr<SaddleMultigrid> multigrid;
};

/// With the same smoother before and after and transposed transfers, (b, M c) = (M b, c) up to the rounding
/// of sums of products in single precision.
TEST(Multigrid, a_cycle_is_symmetric) {
  for (const int depth : {0, 1, 3}) {
    const HeldBar bar(4, 0.49, 0.1, depth);
    const MixedVector b = bar.random_vector(1), c = bar.random_vector(2);
    MixedVector Mb = b, Mc = c;
    bar.multigrid->cycle(b, Mb);
    bar.multigrid->cycle(c, Mc);
    const MixedBlocks& blocks = bar.multigrid->elements().blocks();
    const double size = std::sqrt(dot(b, b, blocks) * dot(Mc, Mc, blocks));
    EXPECT_GT(size, 0.0);
    EXPECT_NEAR(dot(b, Mc, blocks), dot(Mb, c, blocks), 1e-5 * size) << "depth " << depth;
  }
}

/// Refinement costs at most a few cycles: the meshes before it are levels. Measured: at most 27.
TEST(Multigrid, cycles_do_not_grow_with_refinement) {
  for (const double poisson_ratio : {0.3, 0.49, 0.4999}) {
    for (const int depth : {1, 2, 4}) {
      EXPECT_LE(HeldBar(4, poisson_ratio, 0.1, depth).cycles(), 30) << poisson_ratio << ", depth " << depth;
    }
  }
}

/// Eight times as many elements cost at most a few cycles more, and so does a Poisson's ratio closer to one
/// half. Measured: 12 to 17.
TEST(Multigrid, cycles_do_not_grow_with_the_mesh_nor_with_lambda) {
  for (const double poisson_ratio : {0.3, 0.49, 0.4999}) {
    for (const int n : {4, 8, 16}) {
      EXPECT_LE(HeldBar(n, poisson_ratio).cycles(), 25) << poisson_ratio << ", " << n;
    }
  }
}

/// Grids have the body's volume, and their functions of constant displacement do not change it.
TEST(Multigrid, levels_conserve_volume) {
  const HeldBar bar(4, 0.3, 0.0);
  GridLevel first(Grid::around(bar.mesh), {});
  ElementTransfer transfer(bar.mesh, bar.layout, bar.multigrid->elements(), first);
  transfer.gather();
  std::array<bool, 3> halved{};
  const Grid coarse = first.grid().coarser(halved);
  GridLevel second(coarse, {});
  GridTransfer to_second(first, second, halved);
  to_second.gather();
  const auto lambda = static_cast<double>(bar.multigrid->elements().tangents().front().lambda);
  for (const GridLevel* level : {&first, &second}) {
    double volume = 0.0;
    for (const BoxProblem& problem : level->problems()) {
      volume += lambda * static_cast<double>(problem.C);
      for (std::size_t i = 0; i < 3; ++i) {
        double sum = 0.0;
        for (std::size_t a = 0; a < 8; ++a) sum += static_cast<double>(problem.B[3 * a + i]);
        EXPECT_NEAR(sum, 0.0, 1e-6);
      }
    }
    EXPECT_NEAR(volume, 2.0, 1e-5);
  }
}

/// A beam one element thick. If cells of the first grid sampled elements at their centres only, they would
/// let it bend freely, and a solution would take thousands of evaluations instead of about a hundred.
TEST(Multigrid, slender_beams_take_no_more_than_others) {
  Case description = plain_case(NeoHookean{.young_modulus = 3000.0, .poisson_ratio = 0.49});
  const Mesh mesh = box({0.01, 0.01, 0.4}, {1, 1, 40});
  const NodeSets sets{{"foot", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.0; })},
                      {"head", nodes_where(mesh.points, [](const Vector& X) { return X[2] > 0.399; })}};
  description.displacements = {{"foot", {}}};
  description.forces.of<DeadForce>() = {{"head", {1e-6, 0.0, 0.0}, {}}};
  Observer silent;
  const Relaxation found = relax(Model(make_scene(description, mesh, sets), {"tl-mean-dilatation"}), silent);
  EXPECT_TRUE(found.converged);
  EXPECT_LE(found.steps, 200);
}

/// Where lambda is zero or less, the pressures of elements carry a share of mu instead, to avoid a division
/// by zero.
TEST(Multigrid, poisson_ratios_of_zero_and_less_take_no_more_than_others) {
  for (const double poisson_ratio : {0.1, 0.0, -0.01, -0.3}) {
    Case description = plain_case(NeoHookean{.young_modulus = 3000.0, .poisson_ratio = poisson_ratio});
    const Mesh mesh = box({0.1, 0.1, 0.2}, {3, 3, 6});
    const NodeSets sets{{"foot", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.0; })},
                        {"head", nodes_where(mesh.points, [](const Vector& X) { return X[2] > 0.199; })}};
    description.displacements = {{"foot", {}}, {"head", {0.02, 0.0, 0.03}}};
    Observer silent;
    for (const char* method : {"tl-mean-dilatation", "tl-perturbation", "tl-full"}) {
      const Relaxation found = relax(Model(make_scene(description, mesh, sets), {method}), silent);
      EXPECT_TRUE(found.converged) << method << ", " << poisson_ratio;
      EXPECT_LE(found.steps, 60) << method << ", " << poisson_ratio;
    }
  }
}

}  // namespace
}  // namespace sandglass::verification::multigrid_test
