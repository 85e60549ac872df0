/// Random scenes come to rest, with load levels that nobody chose.

#include <gtest/gtest.h>

#include "solve/relaxation.hpp"
#include "support/balance.hpp"
#include "support/random_scene.hpp"

namespace sandglass::verification {
namespace {

/// Lets a scene come to rest, holds it against a plain assembly of the elements, and returns the evaluations.
long evaluations_to_rest(long seed, long number) {
  const std::string which = fmt::format("scene {} of seed {}", number, seed);
  RandomScene random(seed, number);
  const Scene scene = random.scene();
  Observer silent;
  const Relaxation found = relax(Model(scene, {"tl-mean-dilatation"}), silent);
  EXPECT_TRUE(found.converged) << which << ": " << outcome(found, Precision::double_precision);
  const Balance<FormulationOf<TlMeanDilatation, NeoHookean>, NeoHookean> balance(scene, random.law());
  std::vector<double> u;
  for (const Vector& row : found.u) u.insert(u.end(), row.begin(), row.end());
  std::vector<double> forces = balance.forces(u), loads(forces.size());
  for (const auto& [node, load, curve] : scene.loads) {
    for (std::size_t i = 0; i < 3; ++i) loads[3 * index(node) + i] = load[i];
  }
  double all = 0.0, carried = 0.0, free = 0.0;
  for (std::size_t k = 0; k < forces.size(); ++k) {
    all += (forces[k] - loads[k]) * (forces[k] - loads[k]);
    carried += loads[k] * loads[k];
    forces[k] -= loads[k];
  }
  for (const double force : balance.free_of(forces)) free += force * force;
  EXPECT_LT(std::sqrt(free / (all - free + carried)), 1.1e-8) << which;
  return found.steps;
}

/// More scenes, or others: SANDGLASS_SCENES=500 SANDGLASS_SEED=7 random_scenes_test.
TEST(RandomScenes, come_to_rest) {
  const long first = from_environment("SANDGLASS_FIRST", 0), count = from_environment("SANDGLASS_SCENES", 25);
  const long seed = from_environment("SANDGLASS_SEED", 20);
  std::vector<long> evaluations;
  for (long number = first; number < first + count; ++number) {
    try {
      evaluations.push_back(evaluations_to_rest(seed, number));
    } catch (const ComputationError& error) {
      ADD_FAILURE() << "scene " << number << " of seed " << seed << ": " << error.what();
    }
  }
  std::sort(evaluations.begin(), evaluations.end());
  if (evaluations.empty()) return;
  fmt::print("seed {}, {} scenes: {} evaluations in the median, {} at most\n", seed, evaluations.size(),
             evaluations[evaluations.size() / 2], evaluations.back());
}

/// In the first two an element is inverted at a load level where the residual is small enough to go on; the
/// last buckles, and its forces do not fall for 100 steps of descent.
TEST(RandomScenes, that_failed_once_come_to_rest) {
  for (const auto& [seed, number] : {std::pair{1L, 290L}, {2L, 34L}, {2L, 433L}}) {
    EXPECT_NO_THROW(evaluations_to_rest(seed, number)) << "scene " << number << " of seed " << seed;
  }
}

}  // namespace
}  // namespace sandglass::verification
