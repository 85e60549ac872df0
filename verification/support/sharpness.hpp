#pragma once

#include <algorithm>

#include "mesh/quality.hpp"
#include "solve/stable_step.hpp"
#include "support/dense_matrix.hpp"
#include "support/mesh_tangent.hpp"
#include "support/random_hexahedra.hpp"
#include "support/softening.hpp"
#include "support/typed_lists.hpp"

/// How close the bound of the stable step is to the truth: the largest eigenvalue omega^2 of K v = omega^2 M
/// v, K the tangent stiffness and M the lumped masses, over the bound (2/dt)^2. Above 1 a step would be
/// unsafe; the square root of the ratio is the step over the longest possible one.
namespace sandglass::verification {

/// A mesh and the displacements of its nodes.
struct Sample {
  Mesh mesh;
  NodalField u;
};

/// The shape of a sample: random, flat, or slender, one to ten.
struct Shape {
  double thickness;  ///< of the third axis over the first
  double width;      ///< of the second axis
};
inline constexpr std::array<Shape, 3> shapes{{{1.0, 1.0}, {0.1, 1.0}, {0.1, 0.1}}};

/// How much a sample is deformed: stretches, and movements of single nodes in edges.
struct Strain {
  double smallest_stretch;
  double largest_stretch;
  double waviness;
};
inline constexpr Strain undeformed{1.0, 1.0, 0.0};
inline constexpr Strain strongly_deformed{0.5, 2.0, 0.2};

/// A random block of elements that the kernel accepts: nodes of a grid are moved by a quarter of an edge for
/// a single element, otherwise by 0.15, then flattened, sheared, stretched and turned. In its displacements,
/// which stay away from inversion, nodes move independently by `waviness` of the edges before all are
/// stretched and turned.
template <class Pair>
Sample random_sample(RandomGeometry& random, const std::array<int, 3>& elements, const Shape& shape,
                     const Strain& strain) {
  using Kernel = typename Pair::Kernel;
  const bool single = elements == std::array<int, 3>{1, 1, 1};
  const auto law = sample_law<typename Pair::Law>(poisson_ratios[0]);
  for (;;) {
    Tensor<double> press{{1, 0, 0, 0, shape.width, 0, 0, 0, shape.thickness}};
    for (int i = 0; i < 3; ++i) {
      for (int j = i + 1; j < 3; ++j) press(i, j) = random.uniform(-0.5, 0.5) * press(i, i);
      press(i, i) *= random.uniform(0.7, 1.4);
    }
    const Tensor<double> map = random.rotation() * press;
    const Tensor<double> F = strain.waviness > 0.0
                                 ? random.deformation(strain.smallest_stretch, strain.largest_stretch)
                                 : identity<double>();
    const double share = single ? 0.25 : 0.15;
    Sample sample{box({1.0 * elements[0], 1.0 * elements[1], 1.0 * elements[2]}, elements), {}};
    for (auto& point : sample.mesh.points) {
      Vector moved{};
      for (std::size_t i = 0; i < 3; ++i) {
        point[i] += random.uniform(-share, share);
        moved[i] = point[i] + random.uniform(-strain.waviness, strain.waviness);
      }
      point = linear(map, point);
      moved = linear(F * map, moved);
      sample.u.push_back({moved[0] - point[0], moved[1] - point[1], moved[2] - point[2]});
    }
    const bool fits = std::ranges::all_of(sample.mesh.cells, [&](const Hexahedron& cell) {
      const auto X = gather(sample.mesh.points, cell);
      // A quarter can fold a corner; a cube's corner has 1/8.
      return smallest_measure(X) > 0.02 * determinant(map) && Kernel::accepts(X);
    });
    if (!fits) continue;
    if (strain.waviness > 0.0 &&
        !(MeshTangent<Kernel, typename Pair::Law>(sample.mesh, law, {}, sample.u).smallest_jacobian() >
          0.1)) {
      continue;
    }
    return sample;
  }
}

/// The truth over the bound of a sample, at the bound's own step: since velocities are half a step late, a
/// damping D counts as 2/dt D; other methods do not depend on time. If the tangent is not symmetric, as for
/// resistances that turn with the element, its largest eigenvalue's magnitude is used.
template <class Pair>
double true_over_bound(const Sample& sample, const typename Pair::Law& law,
                       std::optional<double> kappa = {}) {
  using Kernel = typename Pair::Kernel;
  const Scene scene = make_scene(plain_case(law), sample.mesh);
  const Model model(scene, {std::string(Pair::Method::name), kappa});
  const double dt = stable_step(model, sample.u).step;
  const MeshTangent<Kernel, typename Pair::Law> tangent(
      scene.mesh, law, {.kappa = kappa, .density = scene.materials.list.front().density}, sample.u);
  const auto K = tangent.over_masses(model.masses(), 2.0 / dt);
  const int size = 3 * static_cast<int>(sample.u.size());
  const double truth =
      Kernel::remembers ? largest_eigenvalue_magnitude(K.data(), size) : symmetric_eigenvalues(K).back();
  return truth * dt * dt / 4.0;
}

/// Whether a law loses its stiffness somewhere in a sample, so that a bound cannot be compared.
template <class Law>
bool loses_stiffness(const Sample& sample) {
  return std::ranges::any_of(sample.mesh.cells, [&](const Hexahedron& cell) {
    return loses_stiffness<Law>(gather(sample.mesh.points, cell), gather(sample.u, cell));
  });
}

/// The distribution of a ratio that must not exceed 1.
struct Distribution {
  std::vector<double> ratios;  ///< where a comparison is possible
  int samples = 0;
  int unsafe = 0;  ///< of all samples; beyond the roundoff of eigenvalues, 1e-10

  double quantile(double q) {
    if (ratios.empty()) return std::numeric_limits<double>::quiet_NaN();
    std::ranges::sort(ratios);
    return ratios[static_cast<std::size_t>(q * static_cast<double>(ratios.size() - 1) + 0.5)];
  }
};

/// The ratios of `samples` random blocks, every shape and Poisson's ratio in turn. Blocks of several elements
/// have two or three per edge.
template <class Pair>
Distribution sharpness(RandomGeometry& random, int samples, bool single, const Strain& strain) {
  using Law = typename Pair::Law;
  Distribution result;
  for (int n = 0; n < samples; ++n) {
    std::array<int, 3> elements{1, 1, 1};
    if (!single) {
      for (int& count : elements) count = random.uniform(0.0, 1.0) < 0.5 ? 2 : 3;
    }
    const Sample sample = random_sample<Pair>(random, elements, shapes[index(n) % shapes.size()], strain);
    const Law law = sample_law<Law>(poisson_ratios[index(n) / shapes.size() % poisson_ratios.size()]);
    const double ratio = true_over_bound<Pair>(sample, law);
    ++result.samples;
    result.unsafe += ratio <= 1.0 + 1e-10 ? 0 : 1;
    if (!loses_stiffness<Law>(sample)) result.ratios.push_back(ratio);
  }
  return result;
}

}  // namespace sandglass::verification
