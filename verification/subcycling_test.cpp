/// Motions with subcycling of small elements: energy, momentum, the same bits, simulations, refusals.

#include <gtest/gtest.h>

#include <numeric>

#include "base/error.hpp"
#include "io/case_file.hpp"
#include "material/viscoelastic.hpp"
#include "mesh/refinement.hpp"
#include "sandglass/driven_problem.hpp"
#include "solve/central_difference.hpp"
#include "solve/leapfrog.hpp"
#include "support/random_hexahedra.hpp"
#include "support/scenes.hpp"
#include "support/subcycled.hpp"

namespace sandglass::verification::subcycling_test {
namespace {

using subcycled::bar, subcycled::moving_case, subcycled::scene_on, subcycled::soft, subcycled::subcycled_case;

/// A linear body, all of whose modes vibrate at random, conserves m v^2 / 2 + u_n f_(n+1) / 2, as leapfrog
/// does for symmetric operators, to the rounding of 1e5 steps. Growth by resonance would be exponential.
TEST(Subcycling, keeps_energy_over_a_hundred_thousand_steps) {
  const RefinedMesh refined = bar(6);
  const auto held = nodes_where(refined.mesh().points, [](const Vector& X) { return X[2] > 0.299; });
  for (const double times : {2.0, 3.59}) {
    const Scene scene = scene_on(refined, subcycled_case(refined, times), held);
    const double step = scene.settings.dynamics.time_step;
    const Model model(scene, {"linear"});
    Leapfrog<double> motion(model, *std::get<std::unique_ptr<InternalForce<double>>>(model.internal_force()),
                            0.0);
    motion.subcycle(model);
    Body<double>& body = motion.body();
    EXPECT_LE(step, motion.stable_step(model, step).step);
    body.set_step(step);
    body.evaluate_forces();
    RandomGeometry random(3);
    NodalField v(model.masses().size());
    for (Vector& at : v)
      for (double& x : at) x = random.uniform(-1e-3, 1e-3);
    follow(scene.ties, v);
    motion.set_initial_velocities(v);
    const auto energy = [&] {
      double sum = 0.0;
      const Layout& layout = body.layout();
      for (std::size_t r = 0; r < layout.nodes; ++r) {
        const double mass = model.masses()[index(layout.node_of_row[r])];
        for (std::size_t i = 0; i < 3; ++i) {
          const double du = body.state().increment[r][i], u = body.state().u[r][i] - du;
          sum += 0.5 * mass * (du / step) * (du / step) + 0.5 * u * body.free_forces()[r][i];
        }
      }
      return sum;
    };
    double start = 0.0, largest = 0.0;
    for (int n = 1; n <= 100000; ++n) {
      motion.advance(step, [](Body<double>& b) { b.impose(0.0); });
      if (n == 1) start = energy();
      if (n % 100 == 0) largest = std::max(largest, std::abs(energy() - start));
    }
    EXPECT_LT(largest, 1e-12 * start) << times;
  }
}

/// A free bar that bends and stretches by 3 %.
Scene vibrating_bar(const RefinedMesh& refined, double times, long steps) {
  Case description = subcycled_case(refined, times);
  const double speed = 0.03 * std::sqrt(soft.young_modulus / 1000.0);
  description.velocities = {{.value = {speed, 0.0, speed}, .half_waves = {0, 0, 1}},
                            {.value = {0.1, 0.2, 0.3}}};
  description.dynamics.duration = static_cast<double>(steps) * description.dynamics.time_step;
  return scene_on(refined, description);
}

/// Over 1e5 steps energy stays within the oscillation of central differences, (w dt)^2 of the highest mode in
/// the motion. This is a measurement: under finite strain the averaged forces have no potential, and no
/// theory guarantees it.
TEST(Subcycling, a_bar_that_vibrates_keeps_its_energy) {
  const Scene scene = vibrating_bar(bar(32), 3.2, 100000);
  Recorder recorder;
  const Motion motion = integrate(Model(scene, {"tl-perturbation"}), recorder);
  EXPECT_GE(motion.steps, 100000);
  EXPECT_EQ(motion.most_substeps, 4);
  const double start = total_energy(recorder.rows.front());
  for (const HistoryRow& row : recorder.rows) EXPECT_NEAR(total_energy(row), start, 0.005 * start);
}

/// Element forces sum to zero in every small step: momentum is constant to the rounding of 1000 steps.
TEST(Subcycling, keeps_momentum) {
  const Scene scene = vibrating_bar(bar(6), 3.2, 1000);
  const Model model(scene, {"tl-perturbation"});
  Recorder recorder;
  integrate(model, recorder);
  const auto momentum = [&](const Frame& frame) {
    Vector sum{};
    for (std::size_t n = 0; n < frame.v.size(); ++n)
      for (std::size_t i = 0; i < 3; ++i) sum[i] += model.masses()[n] * frame.v[n][i];
    return sum;
  };
  const Vector start = momentum(recorder.frames.front());
  for (const Frame& frame : recorder.frames)
    EXPECT_LT(distance(momentum(frame), start), 1e-12 * length(start));
}

TEST(Subcycling, has_the_same_bits_for_any_number_of_threads) {
  const Scene scene = vibrating_bar(bar(6), 3.2, 200);
  Observer silent;
  const NodalField u = integrate(Model(scene, {"tl-perturbation"}), silent).u;
  for (const int threads : {2, 3}) {
    const Model model(scene, {.method = "tl-perturbation", .threads = threads});
    EXPECT_EQ(integrate(model, silent).u, u) << threads;
  }
}

/// A bar without driven nodes in a program's `Simulation`, against `integrate`, with a copy half way, in
/// steps too long for its small elements. Small steps divide the longest step in `Simulation`, and one that
/// is up to a percent shorter in `integrate`.
TEST(Subcycling, is_what_simulations_do_too) {
  const std::string text =
      "[case]\nname = \"bar\"\nrequirement = \"A bar vibrates.\"\nanswer = \"dynamic\"\n"
      "[material]\nlaw = \"neo-hookean\"\nyoung_modulus = 3000.0\npoisson_ratio = 0.3\ndensity = 1000.0\n"
      "[element_sets]\nend = { z = [0.0, 0.05] }\n[[refine]]\nelements = \"end\"\ndepth = 2\n"
      "[[velocity]]\nvalue = [0.05, 0.0, 0.05]\nhalf_waves = [0, 0, 1]\n"
      "[dynamics]\nduration = 1.0\nframes = 1\nsubcycles = ";
  const Mesh mesh = box({0.05, 0.05, 10.0}, {1, 1, 200});
  const MeshArrays arrays{mesh.points, mesh.cells, {}};
  const Scene scene = read_scene(text + "16\n", checked(MeshArrays(arrays)));
  Recorder recorder;
  recorder.last_step = 60;
  const Motion motion = integrate(Model(scene, {"tl-perturbation"}), recorder);
  Simulation<double> simulation(arrays, text + "16\n");
  EXPECT_GT(simulation.step_size(), 3.0 * Simulation<double>(arrays, text + "1\n").step_size());
  const double step = recorder.rows.back().step_size;  // the run ends after a whole number of them
  EXPECT_NEAR(step / simulation.step_size(), 1.0, 0.01);
  for (long n = 0; n < motion.steps / 2; ++n) simulation.advance(step);
  Simulation<double> copy = simulation;
  for (Simulation<double>* each : {&simulation, &copy}) {
    for (long n = motion.steps / 2; n < motion.steps; ++n) each->advance(step);
    for (std::size_t n = 0; n < motion.u.size(); ++n) {
      const double* u = each->displacements()[index(each->row_of_node()[n])];
      for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(u[i], motion.u[n][i], 1e-8) << n;
    }
  }
}

/// Nothing changes where subcycling does not pay: with equal elements, or if most elements are small.
TEST(Subcycling, of_one_small_step_has_the_bits_of_none) {
  for (const bool refine : {false, true}) {
    const RefinedMesh mesh = refine ? bar(6) : RefinedMesh(box({0.05, 0.05, 0.3}, {1, 1, 6}));
    Observer silent;
    std::vector<NodalField> u;
    for (const int subcycles : {1, 16}) {
      Case description = moving_case(subcycles);
      description.velocities = {{.value = {0.0, 0.0, 0.05}, .half_waves = {0, 0, 1}}};
      u.push_back(integrate(Model(scene_on(mesh, description), {"tl-perturbation"}), silent).u);
    }
    EXPECT_EQ(u[0], u[1]);
  }
}

/// A resumed run has the same bits for any number of small steps at the checkpoint.
TEST(Subcycling, resumes_from_a_checkpoint) {
  struct Keeper final : Observer {
    void resumable(const std::function<Checkpoint()>& checkpoint) override {
      if (++points == 4) kept = checkpoint();
    }
    int points = 0;
    Checkpoint kept;
  } keeper;
  const Scene scene = vibrating_bar(bar(6), 3.2, 200);
  const Model model(scene, {"tl-perturbation"});
  const NodalField u = integrate(model, keeper).u;
  Observer silent;
  EXPECT_EQ(integrate(model, silent, &keeper.kept).u, u);
}

/// Features whose forces cannot be averaged are rejected by name.
TEST(Subcycling, refuses_what_depends_on_more_than_displacements) {
  const RefinedMesh refined = bar(6);
  Observer silent;
  const auto refusal = [&](const Scene& scene, const std::string& method) {
    try {
      integrate(Model(scene, {method}), silent);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  Case description = subcycled_case(refined, 3.2);
  for (const char* method : {"ul-perturbation", "ul-viscous", "tl-adaptive", "t4-anp"})
    EXPECT_NE(refusal(scene_on(refined, description), method).find(method), std::string::npos) << method;
  Scene scene = scene_on(refined, description);
  std::vector<int> all(scene.mesh.points.size());
  std::iota(all.begin(), all.end(), 0);
  const NodeSets sets{{"all", all}};
  std::vector<double> masses(all.size(), 1.0);
  ForceResolver resolver{
      .file = "", .points = scene.mesh.points, .boundary = scene.boundary, .sets = sets, .masses = masses};
  Pressure{"all", 1.0}.resolve(resolver);
  scene.forces = resolver.all();
  EXPECT_NE(refusal(scene, "tl-perturbation").find("[[pressure]] acts on node"), std::string::npos);
  description.materials.front().law = Viscoelastic<NeoHookean>{soft};
  EXPECT_NE(refusal(scene_on(refined, description), "tl-perturbation").find("subcycles"), std::string::npos);
}

}  // namespace
}  // namespace sandglass::verification::subcycling_test
