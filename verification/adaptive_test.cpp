/// The adaptive method: how levels are chosen and mixed.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "support/level_kernels.hpp"
#include "support/pressed_block.hpp"
#include "support/random_hexahedra.hpp"
#include "support/scenes.hpp"
#include "support/single_element.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::adaptive_test {
namespace {

NodalField some_displacements(const Mesh& mesh) {
  RandomGeometry random(17);
  NodalField u(mesh.points.size());
  for (auto& v : u) {
    for (auto& x : v) x = random.uniform(-0.001, 0.001);
  }
  return u;
}

NodalField forces(const InternalForce<double>& elements, State<double> state) {
  Rows<double> force(state.u.size());
  elements.evaluate(state, force);
  return to_field(force, elements.layout());
}

/// Equal bit by bit if products are not contracted; otherwise within the roundoff of a few hundred operations
/// on the largest of the numbers.
void expect_same(std::vector<double> found, const std::vector<double>& expected) {
  ASSERT_EQ(found.size(), expected.size());
#ifdef SANDGLASS_STRICT_FP
  EXPECT_EQ(found, expected);
#else
  double largest = 0.0;
  for (const double number : expected) largest = std::max(largest, std::abs(number));
  for (std::size_t n = 0; n < found.size(); ++n) EXPECT_NEAR(found[n], expected[n], 1e-13 * largest) << n;
#endif
}

std::vector<double> numbers_in(const NodalField& field) {
  std::vector<double> numbers;
  for (const auto& row : field) numbers.insert(numbers.end(), row.begin(), row.end());
  return numbers;
}

/// With all elements at one level, the method equals that level's method: forces, energies, det F and bounds
/// of the step.
TEST(Adaptive, every_level_by_itself_is_its_method) {
  const Scene scene = pressed_block(0.01);
  const NodalField u = some_displacements(scene.mesh);
  const Model adaptive(scene, {"tl-adaptive"});
  const auto& elements = elements_of(adaptive);
  double level = 0.0;
  for_each_type(LevelsOf<TlAdaptive>{}, [&]<class Method>() {
    SCOPED_TRACE(Method::name);
    const Model fixed(scene, {std::string(Method::name)});
    State<double> state = state_at(elements, u), expected = state_at(elements_of(fixed), u);
    elements.set_levels(state, std::vector<double>(scene.mesh.cells.size(), level));
    expect_same(numbers_in(forces(elements, state)), numbers_in(forces(elements_of(fixed), expected)));
    const auto energies = elements.energies(state), wanted_energies = elements_of(fixed).energies(expected);
    expect_same({energies.strain, energies.hourglass}, {wanted_energies.strain, wanted_energies.hourglass});
    std::vector<double> values(scene.mesh.cells.size()), wanted(values.size());
    const auto expect_same_values = [&](auto quantity) {
      (elements.*quantity)(state, values);
      (elements_of(fixed).*quantity)(expected, wanted);
      expect_same(values, wanted);
    };
    expect_same_values(&InternalForce<double>::jacobians);
    expect_same_values(&InternalForce<double>::smallest_jacobians);
    expect_same_values(&InternalForce<double>::stiffness_bounds);
    expect_same_values(&InternalForce<double>::hourglass_energy_densities);
    level += 1.0;
  });
}

/// Nodal forces of one element.
template <class Kernel>
NodalVectors<double> element_force(const Scene& scene, const NodalField& u, std::size_t e) {
  SingleElement<Kernel, LevelLaw> element(gather(scene.mesh.points, scene.mesh.cells[e]), level_law());
  return element.to(gather(u, scene.mesh.cells[e]));
}
NodalVectors<double> element_force(const Scene& scene, const NodalField& u, std::size_t e, int level) {
  if (level == 0) return element_force<OnePointKernel>(scene, u, e);
  if (level == 1) return element_force<FourPointKernel>(scene, u, e);
  return element_force<EightPointKernel>(scene, u, e);
}

/// With elements at randomly mixed levels, the forces are the sum of those of single elements, and any number
/// of threads gives the same bits.
TEST(Adaptive, mixed_levels_add_up) {
  const Scene scene = pressed_block(0.01);
  const NodalField u = some_displacements(scene.mesh);
  RandomGeometry random(29);
  std::vector<double> levels(scene.mesh.cells.size());
  for (double& level : levels) level = std::floor(random.uniform(0.0, 3.0));
  std::optional<NodalField> first;
  for (const int threads : {1, 2, 3}) {
    const Model model(scene, {.method = "tl-adaptive", .threads = threads});
    State<double> state = state_at(elements_of(model), u);
    elements_of(model).set_levels(state, levels);
    EXPECT_EQ(elements_of(model).levels(state), levels);
    const NodalField together = forces(elements_of(model), state);
    if (first) {
      EXPECT_EQ(together, *first) << threads;
      continue;
    }
    first = together;
    NodalField sum(u.size());
    double largest = 0.0;
    for (std::size_t e = 0; e < levels.size(); ++e) {
      const auto f = element_force(scene, u, e, static_cast<int>(levels[e]));
      for (std::size_t I = 0; I < 8; ++I) {
        for (std::size_t i = 0; i < 3; ++i) {
          sum[index(scene.mesh.cells[e][I])][i] += f(static_cast<int>(I), static_cast<int>(i));
          largest = std::max(largest, std::abs(f(static_cast<int>(I), static_cast<int>(i))));
        }
      }
    }
    for (std::size_t n = 0; n < sum.size(); ++n) {
      for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(together[n][i], sum[n][i], 1e-13 * largest);
    }
  }
}

using Defects = std::vector<std::array<double, 2>>;

/// The levels once the empty lanes that a level leaves in a chunk are given to those elements of the level
/// below that are closest to needing it.
std::vector<double> with_full_lanes(std::vector<double> levels, const Layout& layout,
                                    const Defects& defects) {
  constexpr std::size_t lanes = Lanes<Pack<double>>::width;
  for (const auto& chunk : layout.chunks) {
    const auto elements = layout.elements_of(chunk);
    const auto count = [&](double level) {
      return static_cast<std::size_t>(
          std::count_if(elements.begin(), elements.end(), [&](int e) { return levels[index(e)] == level; }));
    };
    for (const int level : {2, 1}) {
      while (count(level) % lanes != 0 && count(level - 1) > 0) {
        int next = -1;
        for (const int e : elements) {
          if (levels[index(e)] != level - 1) continue;
          if (next < 0 || defects[index(e)][index(level - 1)] > defects[index(next)][index(level - 1)])
            next = e;
        }
        levels[index(next)] = level;
      }
    }
  }
  return levels;
}

/// Levels follow the rule, computed here element by element: the lowest level whose force differs from that
/// of eight points by too little to displace any node by more than the length; and no lane is left empty.
TEST(Adaptive, levels_follow_the_rule) {
  const Scene scene = pressed_block(0.01, {8, 8, 12});
  const NodalField u = some_displacements(scene.mesh);
  const Model model(scene, {"tl-adaptive"});
  const auto& elements = elements_of(model);
  State<double> state = state_at(elements, u);
  RandomGeometry random(31);
  std::vector<double> mobility(scene.mesh.points.size());
  for (double& m : mobility) m = random.uniform(0.0, 1e-3);
  Rows<double> rows(elements.layout().rows());
  for (std::size_t r = 0; r < mobility.size(); ++r) {
    const double m = mobility[index(elements.layout().node_of_row[r])];
    rows[r] = {m, m, m};
  }
  Defects defects(scene.mesh.cells.size());
  std::vector<double> all;
  for (std::size_t e = 0; e < defects.size(); ++e) {
    for (int level = 0; level < 2; ++level) {
      const auto d = element_force(scene, u, e, level) - element_force(scene, u, e, 2);
      double& largest = defects[e][index(level)];
      for (int I = 0; I < 8; ++I) {
        const double m = mobility[index(scene.mesh.cells[e][index(I)])];
        largest = std::max(largest, m * std::hypot(d(I, 0), d(I, 1), d(I, 2)));
      }
      all.push_back(largest);
    }
  }
  // Half of the numbers lie below the length, so all levels occur; it equals none of them up to roundoff.
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
  std::nth_element(all.begin(), middle, all.end());
  const double length = *middle * 1.0001;
  const auto by_the_rule = [&](double most, const std::vector<double>& at_most) {
    std::vector<double> levels;
    for (std::size_t e = 0; e < defects.size(); ++e) {
      levels.push_back(std::min(at_most[e], defects[e][0] <= most ? 0.0 : defects[e][1] <= most ? 1.0 : 2.0));
    }
    return with_full_lanes(levels, elements.layout(), defects);
  };

  const Adaptation up = elements.adapt(state, rows, length, 0.5 * length);
  std::array<std::size_t, 3> seen{};
  const std::vector<double> before = elements.levels(state);
  EXPECT_EQ(before, by_the_rule(length, std::vector<double>(defects.size(), 2.0)));
  for (const double level : before) ++seen[static_cast<std::size_t>(level)];
  EXPECT_EQ(up.promoted, seen[1] + seen[2]);
  EXPECT_EQ(up.demoted, 0U);
  for (const std::size_t count : seen) EXPECT_GT(count, 5U) << "a level that was not tried";

  const double longer = 3.0 * length;
  EXPECT_EQ(elements.adapt(state, rows, longer, 0.0).demoted, 0U);
  EXPECT_EQ(elements.levels(state), before);
  const Adaptation down = elements.adapt(state, rows, longer, 0.5 * longer);
  EXPECT_GT(down.demoted, 0U);
  EXPECT_EQ(elements.levels(state), by_the_rule(0.5 * longer, before));
}

TEST(Adaptive, wrong_input_is_refused) {
  const Scene scene = pressed_block(0.01, {2, 2, 2});
  for (const double accuracy : {0.0, -1.0, std::nan("")}) {
    EXPECT_TRUE(contains(input_error([&] { Model(scene, {.method = "tl-adaptive", .accuracy = accuracy}); }),
                         "accuracy"));
  }
  Scene relaxing = scene;
  relaxing.materials.list.front().law = sample_law<Viscoelastic<NeoHookean>>(0.45);
  EXPECT_TRUE(contains(input_error([&] { Model(relaxing, {"tl-adaptive"}); }), "viscoelastic"));
  const Model model(scene, {"tl-adaptive"});
  State<double> state = elements_of(model).undeformed();
  for (const double level : {-1.0, 0.5, 3.0, std::nan("")}) {
    std::vector<double> levels = elements_of(model).levels(state);
    levels[3] = level;
    EXPECT_TRUE(
        contains(input_error([&] { elements_of(model).set_levels(state, levels); }), "element level"));
  }
}

}  // namespace
}  // namespace sandglass::verification::adaptive_test
