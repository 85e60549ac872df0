/// Two deformable bodies that touch in static equilibrium.

#include <gtest/gtest.h>

#include <numbers>

#include "base/error.hpp"
#include "solve/central_difference.hpp"
#include "support/pressed.hpp"
#include "support/static_answer.hpp"
#include "support/two_bodies.hpp"

namespace sandglass::verification {
namespace {

struct Answer {
  Relaxation found;
  HistoryRow last;
};

Answer answer_of(const Model& model) {
  Recorder recorder;
  Relaxation found = relax(model, recorder);
  std::printf("converged %d evaluations %ld residual %g stability %d + %d, depth %g\n", found.converged,
              (long)found.steps, found.residual, (int)found.stability, (int)found.stability_evaluations,
              recorder.rows.back().depth);
  return {found, recorder.rows.back()};
}

/// The pair between two equal blocks is their plane of symmetry.
TEST(RestingPair, answers_as_one_block) {
  for (const double penalty : {1.0, 10.0, 100.0}) {
    for (const double fall : {0.02, 0.2}) {
      const int n = 6;
      TwoBodies blocks(box({1.0, 1.0, 0.5}, {n, n, n / 2}),
                       moved(box({1.0, 1.0, 0.5}, {n, n, n / 2}), {0.0, 0.0, 0.5}),
                       NeoHookean{.young_modulus = 1e4, .poisson_ratio = 0.45});
      Case& d = blocks.description;
      d.quasi_static = true;
      d.displacements = {{"foot", {}}, {"top", {0.0, 0.0, -fall}}};
      Contact pair = pair_of("under", "over", Contact::Method::penalty);
      pair.penalty = penalty;
      d.forces.of<Contact>() = {pair};
      const Scene scene = blocks.scene();
      const Answer two = answer_of(Model(scene, {"tl-perturbation"}));
      TwoBodies whole(box({1.0, 1.0, 1.0}, {n, n, n}), moved(box({1.0, 1.0, 0.5}, {1, 1, 1}), {0, 0, 5.0}),
                      NeoHookean{.young_modulus = 1e4, .poisson_ratio = 0.45});
      whole.description.quasi_static = true;
      whole.description.displacements = {{"foot", {}}, {"under", {0.0, 0.0, -fall}}, {"upper", {}}};
      const Scene scene_of_one = whole.scene();
      const Answer one = answer_of(Model(scene_of_one, {"tl-perturbation"}));
      const double F = one.last.reactions.at("foot")[2], G = two.last.reactions.at("foot")[2];
      std::printf("penalty %g fall %g: F %g against %g: %g, pair %g\n", penalty, fall, G, F, G / F - 1.0,
                  two.last.reactions.at("pair")[2]);
    }
  }
}

TEST(RestingPair, passes_the_patch_test) {
  for (const double penalty : {1.0, 10.0}) {
    struct Meshes {
      int below, above;
    };
    for (const auto& [below, above] : {Meshes{4, 4}, {6, 2}, {4, 3}, {3, 4}, {16, 12}}) {
      const double E = 2e6, p = 1e5;
      TwoBodies plates(box({2.0, 1.0, 1.0}, {below, 1, 4}),
                       moved(box({2.0, 1.0, 1.0}, {above, 2, 4}), {0.0, 0.0, 1.0}),
                       NeoHookean{.young_modulus = E, .poisson_ratio = 0.0});
      Case& d = plates.description;
      d.quasi_static = true;
      Contact pair = pair_of("under", "over", Contact::Method::penalty);
      pair.penalty = penalty;
      d.forces.of<Contact>() = {pair};
      d.forces.of<Pressure>() = {{.set = "top", .value = p}};
      d.displacements = {{"foot", {}}, {"top", {}, {true, true, false}}};
      const Scene scene = plates.scene();
      const Answer answer = answer_of(Model(scene, {"linear"}));
      const auto& interface = plates.sets.at("under");
      double mean = 0.0, error = 0.0;
      for (const int n : interface) mean += answer.found.u[at(n)][2] / static_cast<double>(interface.size());
      for (const Hexahedron& cell : scene.mesh.cells) {
        double shortened = 0.0;
        for (int I = 0; I < 8; ++I)
          shortened += (I < 4 ? 0.25 : -0.25) * answer.found.u[at(cell[at(I)])][2];
        error = std::max(error, std::abs(E * shortened / 0.25 / p - 1.0));
      }
      std::printf("%d and %d, penalty %g: error of stress %g, mean %g, pair %g\n", below, above, penalty, error,
                  mean, answer.last.reactions.at("pair")[2]);
    }
  }
}

Mesh ball(int n, double side, double size, double R) {
  const auto graded = [&](double s) { return size * std::sinh(4.5 * s) / std::sinh(4.5); };
  return lattice({n, n, n}, [&](const Vector& s) {
    const double x = graded(s[0]), y = graded(s[1]), depth = graded(side > 0.0 ? s[2] : 1.0 - s[2]),
                 r = std::min(std::hypot(x, y), size);
    return Vector{x, y, side * (depth + 0.5 * r * r / R * (1.0 - depth / size))};
  });
}

TEST(RestingPair, meets_the_closed_form_of_two_spheres) {
  const double R = 2.0, E = 1.40625e7, modulus = 7.5e6, size = 2.5, d = 0.01;
  for (const double penalty : {1.0, 10.0, 30.0}) {
    for (const auto& [below, above] : {std::pair{12, 12}, {12, 10}}) {
      Mesh lower = ball(below, -1.0, size, R), upper = ball(above, 1.0, size, R);
      const auto first = static_cast<int>(lower.points.size());
      TwoBodies balls(std::move(lower), std::move(upper), NeoHookean{.young_modulus = E, .poisson_ratio = 0.25});
      const auto& points = balls.mesh.points;
      const auto surface = [&](int n, double s) {  // of a lattice whose third coordinate is s
        std::vector<int> nodes;
        for (int k = 0; k < (n + 1) * (n + 1); ++k)
          nodes.push_back(s > 0.0 ? first + k : n * (n + 1) * (n + 1) + k);
        return nodes;
      };
      balls.sets["below"] = surface(below, -1.0);
      balls.sets["above"] = surface(above, 1.0);
      balls.sets["left"] = plane(points, 0, 0.0);
      balls.sets["front"] = plane(points, 1, 0.0);
      Case& c = balls.description;
      c.quasi_static = true;
      c.displacements = {{"foot", {}},
                         {"top", {0.0, 0.0, -d}},
                         {"left", {}, {true, false, false}},
                         {"front", {}, {false, true, false}}};
      Contact pair = pair_of("below", "above", Contact::Method::penalty);
      pair.penalty = penalty;
      c.forces.of<Contact>() = {pair};
      const Scene scene = balls.scene();
      const Model model(scene, {"tl-mean-dilatation"});
      const Answer answer = answer_of(model);
      const Pressed pressed(
          model, answer.found.u, scene.sets.at("below"), [](const Vector& X) { return std::hypot(X[0], X[1]); },
          0.2);
      const double F = 4.0 * pressed.force, a = std::cbrt(3.0 * F * R / (8.0 * modulus)),
                   p0 = 1.5 * F / (std::numbers::pi * a * a);
      const double h = size * std::sinh(4.5 / below) / std::sinh(4.5);
      std::printf("penalty %g: F %g a %g (%g) p0 %g (%g)\n", penalty, F, std::sqrt(2.5 * pressed.square_arm), a,
                  pressed.middle / (0.25 * h * h), p0);
    }
  }
  // The lower ball on a rigid plane.
  TwoBodies half(ball(12, -1.0, size, R), moved(box({1.0, 1.0, 0.5}, {1, 1, 1}), {0, 0, 5.0}),
                 NeoHookean{.young_modulus = E, .poisson_ratio = 0.25});
  half.sets["below"] = {};
  for (int k = 0; k < 13 * 13; ++k) half.sets["below"].push_back(12 * 13 * 13 + k);
  half.sets["left"] = plane(half.mesh.points, 0, 0.0);
  half.sets["front"] = plane(half.mesh.points, 1, 0.0);
  Case& c = half.description;
  c.quasi_static = true;
  c.displacements = {{"foot", {}},
                     {"upper", {}},
                     {"left", {}, {true, false, false}},
                     {"front", {}, {false, true, false}}};
  c.forces.of<Obstacle>() = {{.label = "plate",
                              .set = "below",
                              .shape = Obstacle::Shape::plane,
                              .point = {0.0, 0.0, 0.0},
                              .normal = {0.0, 0.0, -1.0},
                              .displacement = {0.0, 0.0, -0.5 * d}}};
  const Scene scene = half.scene();
  const Model model(scene, {"tl-mean-dilatation"});
  const Answer answer = answer_of(model);
  std::printf("plate: F %g\n", 4.0 * answer.last.reactions.at("plate")[2]);
}

}  // namespace
}  // namespace sandglass::verification
