#pragma once

#include <cstdlib>

#include "mesh/cylinder.hpp"
#include "solve/stable_step.hpp"
#include "support/random_hexahedra.hpp"
#include "support/scenes.hpp"

namespace sandglass::verification {

/// A whole number from the environment, or the default `usual`.
inline long from_environment(const char* name, long usual) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::atol(text) : usual;
}

/// A different scene for each number: boxes of up to 1500 elements, some of them distorted, and cylinders;
/// Poisson's ratio up to .4999; one end is held, the other displaced by up to half the length, turned by up
/// to half a turn, or loaded by forces that bend the body as far.
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
      description.forces.of<DeadForce>().push_back(
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

/// A body of which elements lose stability between two checks, unforeseen by the step of the first check.
inline Scene scene_with_too_long_steps() {
  Scene scene = RandomScene(20, 37).scene();
  scene.settings.quasi_static = false;
  DynamicsSettings& settings = scene.settings.dynamics;
  settings.body_frequency = 1;
  const NodalField rest(scene.mesh.points.size());
  settings.duration = 1.3e4 * stable_step(Model(scene, {"tl-mean-dilatation"}), rest).step;
  settings.ramp_time = 0.5 * settings.duration;
  return scene;
}

}  // namespace sandglass::verification
