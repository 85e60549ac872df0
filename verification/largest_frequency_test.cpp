/// The largest frequency of a whole body: its change with deformation, and the longer steps that it allows.

#include "solve/largest_frequency.hpp"

#include <gtest/gtest.h>

#include "problem/scene_refinement.hpp"
#include "solve/central_difference.hpp"
#include "solve/leapfrog.hpp"
#include "support/dense_matrix.hpp"
#include "support/mesh_tangent.hpp"
#include "support/random_scene.hpp"
#include "support/typed_lists.hpp"

namespace sandglass::verification::largest_frequency_test {
namespace {

using Kernel = FormulationOf<TlMeanDilatation, NeoHookean>;

const NeoHookean law{.young_modulus = 3000.0, .poisson_ratio = 0.49};

/// A distorted block on a fixed foot.
Scene block(std::vector<int> split = {}) {
  RandomGeometry random(4);
  Mesh mesh = box({0.03, 0.02, 0.04}, {3, 2, 4});
  for (Vector& X : mesh.points)
    if (X[2] > 0.0)
      for (double& x : X) x += random.uniform(-0.002, 0.002);
  Case description = plain_case(law);
  description.displacements = {{"foot", {}}};
  description.quasi_static = false;
  description.dynamics.body_frequency = 1;
  if (!split.empty()) description = refined(std::move(description), std::move(split));
  return make_scene(description, mesh,
                    {{"foot", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.0; })}});
}

/// The longest stable step at displacements u, 2 over the largest frequency, from a dense matrix of the free
/// components that includes the forces of tied nodes.
double longest_step(const Scene& scene, const Model& model, const NodalField& u) {
  const MeshTangent<Kernel, NeoHookean> tangent(scene.mesh, law, {}, u);
  std::vector<std::pair<std::size_t, std::size_t>> free;
  for (std::size_t n = 0; n < u.size(); ++n) {
    if (is_tied(scene.ties, static_cast<int>(n))) continue;
    for (std::size_t i = 0; i < 3; ++i) free.emplace_back(n, i);
  }
  std::erase_if(free, [&](const auto& component) {
    return std::ranges::any_of(scene.constraints, [&](const auto& constraint) {
      return index(constraint.node) == component.first && index(constraint.component) == component.second;
    });
  });
  std::vector<double> K(free.size() * free.size());
  for (std::size_t k = 0; k < free.size(); ++k) {
    NodalField v(u.size());
    v[free[k].first][free[k].second] = 1.0;
    follow(scene.ties, v);
    const NodalField forces = tangent.along(v);
    std::array<std::vector<double>, 3> handed;
    for (std::size_t i = 0; i < 3; ++i) {
      for (const Vector& force : forces) handed[i].push_back(force[i]);
      handed[i] = handed_on(scene.ties, handed[i]);
    }
    for (std::size_t m = 0; m < free.size(); ++m) {
      const auto& [node, i] = free[m];
      K[m * free.size() + k] =
          handed[i][node] / std::sqrt(model.masses()[node] * model.masses()[free[k].first]);
    }
  }
  return 2.0 / std::sqrt(symmetric_eigenvalues(K).back());
}

/// A block pressed to half its height and sheared, times `share`.
NodalField pressed(const Mesh& mesh, double share) {
  NodalField u;
  for (const Vector& X : mesh.points)
    u.push_back(linear(share * Tensor<double>{{0.3, 0, 0.3, 0, 0.4, 0, 0, 0, -0.5}}, X));
  return u;
}

template <class Real>
class LargestFrequencyTest : public ::testing::Test {
 protected:
  LargestFrequencyTest(Scene of = block())
      : scene(std::move(of)),
        model(scene,
              {.method = "tl-mean-dilatation",
               .precision = sizeof(Real) == 8 ? Precision::double_precision : Precision::single_precision}),
        elements(*std::get<std::unique_ptr<InternalForce<Real>>>(model.internal_force())),
        leapfrog(model, elements, 0.0) {}

  double step_at(const NodalField& u) {
    leapfrog.body().state() = state_at(elements, u);
    return leapfrog.stable_step(model).step;
  }

  Scene scene;
  Model model;
  const InternalForce<Real>& elements;
  Leapfrog<Real> leapfrog;
};

using Reals = ::testing::Types<double, float>;
TYPED_TEST_SUITE(LargestFrequencyTest, Reals);

/// The search stops at a residual of a thousandth of the square of the frequency, which is rounded up by at
/// most 2^(1/32): half of each in the step, plus some roundoff of single precision. An element bound would
/// fail: its step is a quarter shorter here.
TYPED_TEST(LargestFrequencyTest, is_that_of_the_whole_body) {
  const NodalField rest(this->scene.mesh.points.size());
  const double exact = longest_step(this->scene, this->model, rest);
  EXPECT_LT(this->step_at(rest), 1.001 * exact);
  EXPECT_GT(this->step_at(rest), 0.987 * exact);
  EXPECT_LT(stable_step(this->model, rest).step, 0.75 * exact);
}

/// On the way to a deformed state and back, steps stay close below the longest stable one, or exceed it at
/// most by the difference in growth between the frequency and the bounds within a tenth: runs use .9 of it.
/// Both ways are long enough for the frequency to be computed anew.
TYPED_TEST(LargestFrequencyTest, is_followed_as_the_body_deforms) {
  this->step_at(NodalField(this->scene.mesh.points.size()));
  constexpr int parts = 60;
  double least = INFINITY, most = 0.0;
  for (int n = 1; n < 2 * parts; ++n) {
    const NodalField u = pressed(this->scene.mesh, static_cast<double>(std::min(n, 2 * parts - n)) / parts);
    const double exact = longest_step(this->scene, this->model, u);
    const double step = this->step_at(u);
    EXPECT_LT(step, 1.04 * exact) << n;
    EXPECT_GT(step, 0.85 * exact) << n;
    least = std::min(least, exact);
    most = std::max(most, exact);
  }
  EXPECT_LT(least, 0.8 * most);
}

/// Hanging nodes move with others and pass their masses on.
TEST(LargestFrequency, of_a_refined_mesh) {
  const Scene scene = block({0, 1, 5});
  const Model model(scene, {"tl-mean-dilatation"});
  Leapfrog<double> leapfrog(model, *std::get<std::unique_ptr<InternalForce<double>>>(model.internal_force()),
                            0.0);
  const double exact = longest_step(scene, model, NodalField(scene.mesh.points.size()));
  EXPECT_LT(leapfrog.stable_step(model).step, 1.001 * exact);
  EXPECT_GT(leapfrog.stable_step(model).step, 0.987 * exact);
}

/// Subcycles have steps of their own.
TEST(LargestFrequency, is_not_for_subcycles) {
  EXPECT_EQ((DynamicsSettings{.subcycles = 2, .body_frequency = 1}.broken_rule()->parameter),
            "body_frequency");
  EXPECT_FALSE((DynamicsSettings{.subcycles = 2}.broken_rule()));
  EXPECT_FALSE(DynamicsSettings{.body_frequency = 1}.broken_rule());
}

/// Elements determine the step if forces depend on more than displacements.
TEST(LargestFrequency, is_not_known_of_bodies_with_a_memory) {
  for (const auto* method : {"ul-perturbation", "ul-viscous"}) {
    const Scene scene = block();
    const Model model(scene, {method});
    Leapfrog<double> leapfrog(model,
                              *std::get<std::unique_ptr<InternalForce<double>>>(model.internal_force()), 0.0);
    EXPECT_EQ(leapfrog.stable_step(model).step,
              stable_step(model, NodalField(scene.mesh.points.size())).step);
  }
}

/// Random bodies, driven or loaded for half of the time, undamped and then left alone. An unstable motion
/// gains energy without limit within a few hundred steps; a stable one loses or gains little of the energy
/// put in. SANDGLASS_SCENES=1000 SANDGLASS_STEPS=10000 largest_frequency_test runs more and longer scenes, of
/// which some are unstable: solve/README.md.
TEST(LargestFrequency, allows_stable_motions) {
  const long first = from_environment("SANDGLASS_FIRST", 0), count = from_environment("SANDGLASS_SCENES", 12);
  const long seed = from_environment("SANDGLASS_SEED", 20), steps = from_environment("SANDGLASS_STEPS", 1000);
  const auto methods = std::array{"tl-perturbation", "tl-mean-dilatation", "tl-adaptive"};
  for (long number = first; number < first + count; ++number) {
    const auto* method = methods[static_cast<std::size_t>(number) % methods.size()];
    RandomScene random(seed, number);
    Scene scene = random.scene();
    DynamicsSettings& settings = scene.settings.dynamics;
    settings.body_frequency = static_cast<int>(from_environment("SANDGLASS_BODY_FREQUENCY", 1));
    scene.settings.quasi_static = false;
    const NodalField rest(scene.mesh.points.size());
    settings.duration = 1.3 * static_cast<double>(steps) * stable_step(Model(scene, {method}), rest).step;
    settings.ramp_time = 0.5 * settings.duration;
    const auto grows = [&](double fraction) {
      settings.step_fraction = fraction;
      Recorder recorder;
      integrate(Model(scene, {method}), recorder);
      double energy = 0.0, from_nowhere = 0.0;
      for (const HistoryRow& row : recorder.rows) {
        energy = std::max(energy, row.external_work);
        from_nowhere = std::max(from_nowhere, total_energy(row) - row.external_work);
      }
      return !(from_nowhere < 0.5 * energy);
    };
    const std::string which = fmt::format("scene {} of seed {}, {}", number, seed, method);
    try {
      EXPECT_FALSE(grows(0.01 * static_cast<double>(from_environment("SANDGLASS_PERCENT", 90)))) << which;
    } catch (const ComputationError& error) {
      ADD_FAILURE() << which << ": " << error.what();
    }
  }
}

/// In this body elements lose stability between two checks, unforeseen by the step of the first check. The
/// steps since then are repeated with shorter ones, and the motion is like one with short steps throughout:
/// it neither gains nor loses more energy than a change of steps may cause.
TEST(LargestFrequency, steps_that_prove_too_long_are_taken_again) {
  const Scene scene = scene_with_too_long_steps();
  Recorder recorder;
  const Motion motion = integrate(Model(scene, {"tl-mean-dilatation"}), recorder);
  EXPECT_GT(motion.repeated, 0);
  double largest = 0.0;
  for (const HistoryRow& row : recorder.rows) {
    largest = std::max(largest, row.external_work);
    EXPECT_LT(total_energy(row) - row.external_work, 0.01 * largest + 1e-12);
  }
}

}  // namespace
}  // namespace sandglass::verification::largest_frequency_test
