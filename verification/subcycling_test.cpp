/// Subcycling of small elements: averaged forces form a symmetric operator within the stable range, so that
/// energy is conserved; momentum, frequencies, bits.

#include "solve/subcycling.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "base/error.hpp"
#include "io/case_file.hpp"
#include "material/viscoelastic.hpp"
#include "mesh/refinement.hpp"
#include "sandglass/driven_problem.hpp"
#include "solve/central_difference.hpp"
#include "solve/leapfrog.hpp"
#include "support/dense_matrix.hpp"
#include "support/random_hexahedra.hpp"
#include "support/scenes.hpp"

namespace sandglass::verification::subcycling_test {
namespace {

const NeoHookean soft{.young_modulus = 3000.0, .poisson_ratio = 0.3};

/// Cubes of 5 cm, the one at the origin split into eight and its parts split again.
RefinedMesh refined_at_the_origin(const std::array<int, 3>& cubes) {
  RefinedMesh refined(box({0.05 * cubes[0], 0.05 * cubes[1], 0.05 * cubes[2]}, cubes));
  for (int depth = 0; depth < 2; ++depth) {
    std::vector<bool> marked;
    for (const auto& cell : refined.mesh().cells) {
      const Vector centre = mean_at(cell, refined.mesh().points);
      marked.push_back(*std::max_element(centre.begin(), centre.end()) < 0.05);
    }
    refined.split(std::move(marked));
  }
  return refined;
}

/// A bar of such cubes along z: 64 small elements at its end, 8 of the next size, and large ones.
RefinedMesh bar(int length) {
  return refined_at_the_origin({1, 1, length});
}

/// A moving scene on the refined mesh, in which some nodes are held.
Scene scene_on(const RefinedMesh& refined, Case description, const std::vector<int>& held = {}) {
  description.quasi_static = false;
  if (description.dynamics.duration == 0.0) description.dynamics.duration = 1.0;
  if (!held.empty()) description.displacements.push_back({"held", {}});
  Scene scene = make_scene(description, refined.mesh(), {{"held", held}});
  scene.ties = to_free_nodes(refined.ties());
  scene.coarser = refined.coarser();
  scene.boundary = refined.boundary();
  std::erase_if(scene.constraints, [&](const Constraint& c) { return is_tied(scene.ties, c.node); });
  return scene;
}

Case moving_case(int subcycles) {
  Case description = plain_case(soft);
  description.dynamics.subcycles = subcycles;
  return description;
}

/// The derivative of a linear body's averaged forces by displacements of its free components, over the square
/// roots of their masses: M^(-1/2) K M^(-1/2), 1/s^2; and the longest stable step, s.
struct Operator {
  std::vector<double> matrix;  ///< by rows
  int size;
  double step;
  int substeps;

  /// |A - A^T| / |A|.
  double asymmetry() const {
    double difference = 0.0, norm = 0.0;
    const auto n = static_cast<std::size_t>(size);
    for (std::size_t k = 0; k < n * n; ++k) {
      const double transposed = matrix[k % n * n + k / n];
      difference += (matrix[k] - transposed) * (matrix[k] - transposed);
      norm += matrix[k] * matrix[k];
    }
    return std::sqrt(difference / norm);
  }
};

Operator operator_of(const Scene& scene) {
  const Model model(scene, {"linear"});
  const auto& elements = *std::get<std::unique_ptr<InternalForce<double>>>(model.internal_force());
  Leapfrog<double> motion(model, elements, 0.0);
  motion.subcycle(model);
  Body<double>& body = motion.body();
  const double given = scene.settings.dynamics.time_step, stable = motion.stable_step(model, given).step;
  EXPECT_LE(given, stable);
  const double step = given > 0.0 ? given : stable;
  body.set_step(step);
  std::vector<std::size_t> free;
  for (std::size_t n = 0; n < model.masses().size(); ++n)
    if (model.masses()[n] > 0.0)
      for (std::size_t i = 0; i < 3; ++i) free.push_back(3 * n + i);
  for (const Constraint& c : scene.constraints) std::erase(free, 3 * index(c.node) + index(c.component));
  const std::size_t size = free.size();
  Operator found{std::vector<double>(size * size), static_cast<int>(size), step, body.substeps()};
  for (std::size_t a = 0; a < free.size(); ++a) {
    NodalField u(model.masses().size());
    u[free[a] / 3][free[a] % 3] = 1.0;
    follow(scene.ties, u);
    body.state() = state_at(elements, u);
    body.evaluate_forces();
    const NodalField force = body.field(body.free_forces());
    for (std::size_t b = 0; b < free.size(); ++b) {
      found.matrix[b * size + a] = force[free[b] / 3][free[b] % 3] /
                                   std::sqrt(model.masses()[free[a] / 3] * model.masses()[free[b] / 3]);
    }
  }
  return found;
}

std::vector<double> eigenvalues_of(const Operator& found) {
  return symmetric_eigenvalues(found.matrix.data(), found.size);
}

/// Frequencies of the motion in steps, 1/s: sin(w dt / 2) = dt sqrt(eigenvalue) / 2.
std::vector<double> frequencies(const Operator& found) {
  std::vector<double> frequencies = eigenvalues_of(found);
  for (double& w : frequencies) w = std::asin(found.step / 2 * std::sqrt(std::max(w, 0.0))) * 2 / found.step;
  return frequencies;
}

/// A case whose step is `times` the stable one without subcycling.
Case subcycled_case(const RefinedMesh& refined, double times) {
  Case description = moving_case(16);
  description.dynamics.time_step = times * operator_of(scene_on(refined, moving_case(1))).step;
  return description;
}

/// With two to four small steps, at any position of fine modes: symmetric up to the rounding of sums, not
/// negative up to that of the largest eigenvalue, and below the stability limit 4 / dt^2. Near a resonance,
/// modes of small elements have (1 + 1 / T_p(d)) / 2 < .92 of that limit with a stabilised polynomial, and
/// all of it without.
TEST(Subcycling, averaged_forces_are_of_a_symmetric_operator_in_the_stable_range) {
  const auto check = [](Scene scene, double times) {
    scene.settings.dynamics.subcycles = 1;
    scene.settings.dynamics.time_step = times * operator_of(scene).step;
    scene.settings.dynamics.subcycles = 16;
    const Operator found = operator_of(scene);
    EXPECT_LT(found.asymmetry(), 1e-14) << times;
    const std::vector<double> values = eigenvalues_of(found);
    EXPECT_GT(found.step * found.step * values.front(), -1e-12);
    EXPECT_LT(found.step * found.step * values.back(), 3.7) << found.substeps << " small steps, " << times;
    return found.substeps;
  };
  std::vector<int> counts;
  const RefinedMesh straight = bar(6), corner = refined_at_the_origin({3, 3, 2});
  for (int n = 21; n < 72; ++n) counts.push_back(check(scene_on(straight, moving_case(1)), 0.05 * n));
  EXPECT_EQ(counts.front(), 2);
  EXPECT_EQ(counts.back(), 4);
  EXPECT_TRUE(std::is_sorted(counts.begin(), counts.end()));
  for (const double times : {1.5, 2.5, 3.5}) check(scene_on(corner, moving_case(1)), times);
  // One middle-sized element is stiff and thus small; its neighbours' nodes hang on large elements.
  Scene scene = scene_on(corner, moving_case(1));
  scene.materials.list.push_back({NeoHookean{.young_modulus = 3e5, .poisson_ratio = 0.3}, 1000.0});
  for (const auto& cell : corner.mesh().cells) {
    const Vector centre = mean_at(cell, corner.mesh().points);
    scene.materials.of_element.push_back(distance(centre, {0.0875, 0.0625, 0.0125}) < 1e-6 ? 1 : 0);
  }
  EXPECT_EQ(std::count(scene.materials.of_element.begin(), scene.materials.of_element.end(), 1), 1);
  for (const double times : {1.5, 2.2}) check(scene, times);
}

/// The largest eigenvalue, times dt^2 / 4, of the averaged forces of a large and a small node. The element
/// between them has steps of dt / share; other elements at the small node may give it any frequency for which
/// its small steps are stable.
double largest_square(const Substeps& substeps, double share) {
  constexpr int pairs = 400, frequencies = 1000;
  const double reach = substeps.reach() * substeps.reach(), large = share * share;
  double largest = 0.0;
  for (int m = 1; m <= frequencies; ++m) {
    const double small = reach * m / frequencies;
    double mean = 0.0, u = 1.0, change = 0.0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(substeps.count()); ++k) {
      mean += substeps.weight(k) * u;
      change = substeps.keep(k) * change - substeps.gain(k) * 4.0 * small * u;
      u += change;
    }
    EXPECT_LE(std::abs(u), 1.0 + 1e-12) << substeps.count() << " " << m;
    for (int n = 1; n < pairs; ++n) {
      const double b = static_cast<double>(n) / pairs;
      if (small < (1.0 - b) * large) continue;
      const double coupling = large * std::sqrt(b * (1.0 - b)),
                   held = b * large - coupling * coupling / small;
      const double first = held + coupling * coupling * mean / small, last = small * mean;
      largest = std::max(largest, (first + last) / 2 + std::hypot((first - last) / 2, coupling * mean));
    }
  }
  return largest;
}

/// Nine tenths of the stable step of large elements are stable with any number of small steps; with two,
/// little more is.
TEST(Subcycling, takes_the_largest_share_of_the_large_step_that_is_stable) {
  for (int p = 2; p <= 64; ++p) EXPECT_LT(largest_square(Substeps(p), Substeps::share_of_large), 1.0) << p;
  EXPECT_GT(largest_square(Substeps(2), Substeps::share_of_large + 0.01), 1.0);
}

/// The bar's cubes allow nine tenths of their step; its smallest elements, which allow a quarter of that,
/// need four small steps: three would suffice for .71 of it.
TEST(Subcycling, chooses_the_step_of_large_elements) {
  const Operator large =
      operator_of(scene_on(RefinedMesh(box({0.05, 0.05, 0.05}, {1, 1, 1})), moving_case(1)));
  const Operator found = operator_of(scene_on(bar(200), moving_case(16)));
  EXPECT_EQ(found.substeps, 4);
  EXPECT_NEAR(found.step, 0.9 * large.step, 1e-12 * large.step);
}

/// The first fourteen frequencies other than rigid motions, to the required .1 %; a step that resolves the
/// last of them has an error of (w dt)^2 / 24 = 2e-4 itself.
TEST(Subcycling, keeps_the_first_frequencies) {
  const RefinedMesh refined = bar(32);
  const std::vector<double> exact = frequencies(operator_of(scene_on(refined, moving_case(1))));
  const std::vector<double> found =
      frequencies(operator_of(scene_on(refined, subcycled_case(refined, 3.59))));
  for (std::size_t k = 6; k < 20; ++k) EXPECT_NEAR(found[k], exact[k], 1e-3 * exact[k]) << k;
}

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
