/// Random scenes come to rest, with load levels that nobody chose.

#include <gtest/gtest.h>

#include <cstdlib>

#include "mesh/cylinder.hpp"
#include "solve/relaxation.hpp"
#include "support/balance.hpp"
#include "support/random_hexahedra.hpp"
#include "support/scenes.hpp"

namespace sandglass::verification {
namespace {

long from_environment(const char* name, long usual) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::atol(text) : usual;
}

/// A scene of its own for each number: boxes of up to 1500 elements, some of them distorted, and cylinders;
/// Poisson's ratio up to .4999; one end is held, the other displaced by up to half the length, turned by up
/// to half a turn, or loaded by forces that bend it as far.
class RandomScene {
 public:
  RandomScene(long seed, long number) : random_(static_cast<std::uint64_t>(1000003 * seed + number)) {
    constexpr std::array ratios{0.3, 0.45, 0.49, 0.499, 0.4999};
    law_ = {.young_modulus = 3000.0, .poisson_ratio = ratios[index(whole(0, 4))]};
    mesh_ = mesh();
    const auto [low, high] = bounding_box(mesh_.points);
    const double bottom = low[2], top = high[2], margin = 1e-6 * (top - bottom);
    sets_["held"] = nodes_where(mesh_.points, [&](const Vector& X) { return X[2] < bottom + margin; });
    sets_["moved"] = nodes_where(mesh_.points, [&](const Vector& X) { return X[2] > top - margin; });
    size_ = {high[0] - low[0], high[1] - low[1], top - bottom};
  }

  Scene scene() {
    Case description = plain_case(law_);
    description.displacements = {{"held", {}}};
    const double length = size_[2], kind = random_.uniform(0.0, 1.0);
    if (kind < 0.4) {
      description.displacements.push_back(
          {"moved",
           {random_.uniform(-0.5, 0.5) * length, random_.uniform(-0.5, 0.5) * length,
            random_.uniform(-0.35, 0.5) * length}});
    } else if (kind < 0.5) {
      description.rotations.push_back(
          {.set = "moved", .axis = {0.0, 0.0, 1.0}, .angle = random_.uniform(-3.0, 3.0)});
    } else {
      const double bending = law_.young_modulus * size_[0] * std::pow(size_[1], 3) / 12.0 / (length * length);
      const double stretch = 0.1 * law_.young_modulus * size_[0] * size_[1];
      description.forces.push_back(
          {"moved",
           {random_.uniform(-3.0, 3.0) * bending, random_.uniform(-3.0, 3.0) * bending,
            random_.uniform(-1.0, 1.0) * stretch},
           {}});
    }
    return make_scene(description, mesh_, sets_);
  }

  const NeoHookean& law() const { return law_; }

 private:
  int whole(int low, int high) { return low + static_cast<int>(random_.uniform(0.0, high - low + 1.0)); }

  Mesh mesh() {
    const double kind = random_.uniform(0.0, 1.0);
    if (kind < 0.15)
      return CylinderMesh{0.03, random_.uniform(0.03, 0.12), whole(2, 4), whole(1, 3), whole(4, 12)}.build();
    std::array<int, 3> elements{whole(2, 8), whole(2, 8), whole(4, 24)};
    std::array<double, 3> size{};
    for (std::size_t i = 0; i < 3; ++i) size[i] = 0.01 * random_.uniform(0.6, 1.6) * elements[i];
    Mesh mesh = box(size, elements);
    if (kind < 0.3) {
      for (Vector& X : mesh.points) {
        const bool end = X[2] < 1e-9 || X[2] > size[2] - 1e-9;
        for (std::size_t i = 0; i < (end ? 2U : 3U); ++i) X[i] += random_.uniform(-0.001, 0.001);
      }
    }
    return mesh;
  }

  RandomGeometry random_;
  NeoHookean law_{};
  Mesh mesh_;
  NodeSets sets_;
  std::array<double, 3> size_{};
};

/// More scenes, or others: SANDGLASS_SCENES=500 SANDGLASS_SEED=7 random_scenes_test. What is found is held
/// against a plain assembly of the elements.
TEST(RandomScenes, come_to_rest) {
  const long first = from_environment("SANDGLASS_FIRST", 0), count = from_environment("SANDGLASS_SCENES", 25);
  const long seed = from_environment("SANDGLASS_SEED", 20);
  std::vector<long> evaluations;
  for (long number = first; number < first + count; ++number) {
    const std::string which = fmt::format("scene {} of seed {}", number, seed);
    RandomScene random(seed, number);
    const Scene scene = random.scene();
    Observer silent;
    try {
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
      evaluations.push_back(found.steps);
    } catch (const ComputationError& error) {
      ADD_FAILURE() << which << ": " << error.what();
    }
  }
  std::sort(evaluations.begin(), evaluations.end());
  if (evaluations.empty()) return;
  fmt::print("seed {}, {} scenes: {} evaluations in the median, {} at most\n", seed, evaluations.size(),
             evaluations[evaluations.size() / 2], evaluations.back());
}

}  // namespace
}  // namespace sandglass::verification
