/// Viscoelastic bodies: every method with a viscoelastic law, from one element to a case file.

#include <gtest/gtest.h>

#include <complex>

#include "io/case_file.hpp"
#include "mesh/lattice.hpp"
#include "solve/central_difference.hpp"
#include "solve/relaxation.hpp"
#include "solve/stable_step.hpp"
#include "support/method_test.hpp"
#include "support/patch_mesh.hpp"
#include "support/path.hpp"
#include "support/random_hexahedra.hpp"
#include "support/sample_law.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::viscoelastic_body_test {
namespace {

using Law = Viscoelastic<NeoHookean>;
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double density = 1000.0;

class ViscoelasticBodyTest : public MethodTest {
 protected:
  static Model model(const Scene& scene, Precision precision = Precision::double_precision) {
    return Model(scene, choice(precision));
  }
};

INSTANTIATE_TEST_SUITE_P(, ViscoelasticBodyTest, each_of(ViscoelasticMethods{}), method_label);

/// A distorted element held at a uniform strain: every method has the forces V h P^T of the relaxing stress.
/// An element whose points share a memory, or whose memory is a step ahead, fails here.
TEST_P(ViscoelasticBodyTest, uniform_strain_relaxes_as_the_law) {
  RandomGeometry random(41);
  for (int n = 0; n < 10; ++n) {
    const Law law = sample_law<Law>(0.45);
    const NodalVectors<double> X = fitting_hexahedron(random, method.name);
    const Tensor<double> H = random.deformation(0.7, 1.5) - identity<double>();
    const auto [mesh, u] = one_strained_element(X, H);
    const Scene scene = make_scene(plain_case(law), mesh);
    const auto bounds = std::get<0>(make_internal_force(mesh, law, choice()));
    std::array<double, 1> bound{};
    bounds->stiffness_bounds(state_at(*bounds, u), bound);
    Path path(mesh, law, choice());
    const double first = 0.2;
    path.to(u, first);
    double held = 0.0;
    for (const double dt : {0.01, 0.5, 3.0, 0.1, 70.0}) {
      held += dt;
      double share = law.remaining_share();
      for (const auto& [g, tau] :
           {std::pair{law.relaxation_1, law.time_1}, std::pair{law.relaxation_2, law.time_2}}) {
        share += g * -std::expm1(-first / tau) * tau / first * std::exp(-held / tau);
      }
      const NeoHookean& elastic = law;
      const double p = elastic.pressure(jacobian_minus_one(H));
      const auto P = share * elastic.isochoric_piola(H) + p * cofactor(identity<double>() + H);
      const auto mean = mean_gradient(X);
      const auto exact = mean.h * (mean.volume * transpose(P));
      const NodalField force = path.to(u, dt);
      // As in the tests of single elements: displacements rounded to eps of the coordinates, times stiffness.
      const double tolerance = 512 * eps * bound[0] * 3.0 * largest_entry(X);
      for (std::size_t I = 0; I < 8; ++I) {
        for (std::size_t i = 0; i < 3; ++i) {
          EXPECT_NEAR(force[I][i], exact(static_cast<int>(I), static_cast<int>(i)), tolerance);
        }
      }
    }
  }
}

/// In static solutions a law is fully relaxed, whatever was before: a trial that failed leaves no trace.
TEST_P(ViscoelasticBodyTest, trials_without_numbers_are_forgotten_where_time_plays_no_part) {
  if (is_updated_lagrangian(method)) return;  // its control depends on the path
  const Mesh mesh = box({1, 1, 1}, {2, 1, 1});
  const AnyLaw law = sample_law<Law>(0.45);
  NodalField u;
  for (const auto& X : mesh.points) u.push_back({0.1 * X[0] * X[1], 0.02 * X[2], 0.05 * X[0]});
  Path fresh(mesh, law, choice()), spoilt(mesh, law, choice());
  spoilt.to(NodalField(mesh.points.size(), Vector{NAN, NAN, NAN}));
  EXPECT_EQ(spoilt.to(u), fresh.to(u));
}

/// A cube between rigid planes with an initial velocity along z: uniaxial strain, one degree of freedom with
/// the mass rho h^3/2 and the complex modulus M(s) = K + 4/3 mu (g_inf + sum_i g_i s tau_i / (1 + s tau_i)).
/// With N = (1 + s tau_1)(1 + s tau_2) its motion is u = v0 sum_j m N(s_j) / D'(s_j) exp(s_j t) over the four
/// roots of the polynomial D = (m s^2 + h M) N.
class DampedCube {
 public:
  DampedCube(const Law& law, double h) : law_(law), h_(h) {
    const double m = 0.5 * density * h * h * h, K = law.bulk_modulus(), mu = law.shear_modulus();
    const double t1 = law.time_1, t2 = law.time_2;
    const double M = K + 4.0 / 3.0 * mu * law.remaining_share();
    const double a = 4.0 / 3.0 * mu * law.relaxation_1, b = 4.0 / 3.0 * mu * law.relaxation_2;
    // Powers of s from 0: h M N + h a s t1 (1 + s t2) + h b s t2 (1 + s t1) + m s^2 N.
    D_ = {h * M, h * (M * (t1 + t2) + a * t1 + b * t2), h * (M + a + b) * t1 * t2 + m, m * (t1 + t2),
          m * t1 * t2};
    m_ = m;
    find_roots();
  }

  double displacement(double v0, double t) const {
    Complex u = 0.0;
    for (const Complex s : roots_) {
      const Complex N = (1.0 + s * law_.time_1) * (1.0 + s * law_.time_2);
      const Complex slope = D_[1] + s * (2.0 * D_[2] + s * (3.0 * D_[3] + s * 4.0 * D_[4]));
      u += v0 * m_ * N / slope * std::exp(s * t);
    }
    return u.real();
  }

 private:
  using Complex = std::complex<double>;

  /// Finds all roots together, by the method of Durand and Kerner.
  void find_roots() {
    const double size = std::pow(D_[0] / D_[4], 0.25);
    for (std::size_t j = 0; j < 4; ++j)
      roots_[j] = size * std::pow(Complex(0.4, 0.9), static_cast<double>(j));
    for (int n = 0; n < 200; ++n) {
      for (Complex& s : roots_) {
        Complex value = (D_[0] + s * (D_[1] + s * (D_[2] + s * (D_[3] + s * D_[4])))) / D_[4];
        for (const Complex& other : roots_) {
          if (&other != &s) value /= s - other;
        }
        s -= value;
      }
    }
  }

  Law law_;
  double h_;
  double m_ = 0.0;
  std::array<double, 5> D_{};
  std::array<Complex, 4> roots_{};
};

/// Nodes move only along z; those at z = 0 are held.
Scene sliding_bar(const Law& law, const Mesh& mesh, double speed) {
  Case description = plain_case(law, density);
  description.quasi_static = false;
  description.velocities = {{.value = {0.0, 0.0, speed}}};
  const NodeSets sets{{"foot", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.0; })},
                      {"rest", nodes_where(mesh.points, [](const Vector& X) { return X[2] > 0.0; })}};
  description.displacements = {{"foot", {}}, {"rest", {}, {true, true, false}}};
  description.dynamics.check_interval = 1;
  return make_scene(description, mesh, sets);
}

TEST_P(ViscoelasticBodyTest, oscillation_is_damped_as_in_closed_form) {
  const double h = 0.02;
  Law law = sample_law<Law>(0.25);
  const double omega = std::sqrt(2.0 * p_wave_modulus(law) / (density * h * h));
  law.time_1 = 0.3 / omega;
  law.time_2 = 3.0 / omega;
  const double speed = 1e-6 * h * omega;  // small: nonlinearity changes less than 1e-5 of the answer
  const double duration = 8.0 / omega;
  const double exact = DampedCube(law, h).displacement(speed, duration);
  std::array<double, 3> error{};
  for (std::size_t level = 0; level < error.size(); ++level) {
    Scene scene = sliding_bar(law, box({h, h, h}, {1, 1, 1}), speed);
    const int steps = 32 << level;
    scene.settings.dynamics.duration = duration;
    scene.settings.dynamics.time_step = duration / steps;
    Observer silent;
    const Motion motion = integrate(model(scene), silent);
    ASSERT_EQ(motion.steps, steps);
    error[level] = std::abs(motion.u.back()[2] - exact) / (speed / omega);
  }
  EXPECT_LT(error[2], 2e-3);
  for (std::size_t level = 0; level < 2; ++level) EXPECT_NEAR(error[level] / error[level + 1], 4.0, 0.6);
}

Law quick_law() {
  Law law = sample_law<Law>(0.45);
  law.time_1 = 0.005;
  law.time_2 = 0.05;
  return law;
}

/// A bar of four elements with uniform strains in each, for which all methods are equal.
Scene plane_waves() {
  Scene scene = sliding_bar(quick_law(), box({0.05, 0.05, 0.2}, {1, 1, 4}), 0.5);
  const Model probe(scene, {"tl-full"});
  scene.settings.dynamics.time_step = 0.1 * stable_step(probe, NodalField(scene.mesh.points.size())).step;
  scene.settings.dynamics.duration = 2000 * scene.settings.dynamics.time_step;
  return scene;
}

TEST_P(ViscoelasticBodyTest, plane_waves_are_those_of_every_method) {
  if (GetParam() == T4Anp::name) return;  // pressures depend on those of neighbours
  const Scene scene = plane_waves();
  Observer silent;
  const Motion motion = integrate(model(scene), silent);
  const Motion golden = integrate(Model(scene, {"tl-mean-dilatation"}), silent);
  const double size = largest_distance(golden.u, NodalField(golden.u.size()));
  EXPECT_GT(size, 1e-4);
  // Roundings of 2000 steps, each eps of the displacement, over a swing of a few hundred radians.
  EXPECT_LT(largest_distance(motion.u, golden.u), 1e-10 * size);
}

/// A free body loses energy, and never stores a negative one. With central differences the sum oscillates by
/// about (omega dt)^2 / 4 of itself, 1 % at a tenth of the stable step.
TEST_P(ViscoelasticBodyTest, free_oscillation_loses_energy) {
  const Scene scene = plane_waves();
  Recorder recorder;
  integrate(model(scene), recorder);
  const double start = total_energy(recorder.rows.front());
  double least = start;
  for (const auto& row : recorder.rows) {
    EXPECT_GE(row.strain, 0.0);
    EXPECT_LT(total_energy(row), least + 0.01 * start);
    least = std::min(least, total_energy(row));
  }
  EXPECT_LT(total_energy(recorder.rows.back()), 0.5 * start);
}

/// Single precision: as for elastic bodies, eps per step and radian, plus the memory's u |Q| per step, which
/// is below the stress.
TEST_P(ViscoelasticBodyTest, single_precision_stays_within_its_budget) {
  const Scene scene = plane_waves();
  Observer silent;
  const Motion exact = integrate(model(scene), silent);
  const Motion rounded = integrate(model(scene, Precision::single_precision), silent);
  ASSERT_EQ(exact.steps, rounded.steps);
  const double u = 0.5 * static_cast<double>(std::numeric_limits<float>::epsilon());
  const double budget = 4.0 * u * static_cast<double>(exact.steps) * 0.05;  // m, amplitude .05
  EXPECT_LT(largest_distance(exact.u, rounded.u), budget);
  EXPECT_GT(largest_distance(exact.u, rounded.u), 0.0);
}

/// The neo-Hookean law to which the viscoelastic one relaxes.
NeoHookean long_term_law(const Law& law) {
  const double mu = law.remaining_share() * law.shear_modulus(), K = law.bulk_modulus();
  return {.young_modulus = 9 * K * mu / (3 * K + mu), .poisson_ratio = (3 * K - 2 * mu) / (2 * (3 * K + mu))};
}

/// A control keeps its instantaneous stiffness; with these kappas it has the same stiffness for both laws.
/// Empty for methods without a kappa.
struct SameStiffness {
  std::optional<double> viscoelastic;
  std::optional<double> relaxed;
};
SameStiffness same_stiffness(const MethodEntry& method, const Law& law) {
  const NeoHookean relaxed = long_term_law(law);
  SameStiffness kappa;
  kappa.relaxed = method.auto_kappa(CalledLaw(relaxed), KappaModulus::p_wave);
  if (kappa.relaxed) kappa.viscoelastic = *kappa.relaxed * p_wave_modulus(relaxed) / p_wave_modulus(law);
  return kappa;
}

/// Whether two laws can be compared at strains that are not uniform: not if a control depends on the
/// instantaneous moduli without a kappa to compensate for it.
bool are_comparable(const MethodEntry& method) {
  bool controls = false;
  with_named_type(Methods{}, method.name,
                  [&]<class Method>() { controls = Method::Hourglass::traits.active; });
  return !controls || method.takes_kappa;
}

Scene bent_block(const AnyLaw& law) {
  Case description = plain_case(law);
  const Mesh mesh = box({0.1, 0.1, 0.2}, {2, 2, 4});
  const NodeSets sets{{"foot", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.0; })},
                      {"head", nodes_where(mesh.points, [](const Vector& X) { return X[2] > 0.19; })}};
  description.displacements = {{"foot", {}}, {"head", {0.03, 0.0, 0.02}}};
  description.relaxation.tolerance = 1e-11;
  return make_scene(description, mesh, sets);
}

/// In static solutions, forces and energies equal the elastic body's with the relaxed shear modulus.
TEST_P(ViscoelasticBodyTest, without_time_it_is_the_elastic_body_with_the_relaxed_shear_modulus) {
  if (are_comparable(method)) {
    const Law law = sample_law<Law>(0.45);
    const auto kappa = same_stiffness(method, law);
    const Scene viscoelastic = bent_block(law), elastic = bent_block(long_term_law(law));
    NodalField u;
    for (const auto& X : elastic.mesh.points) {
      u.push_back({0.2 * X[2] * std::sin(30 * X[1]), 0.1 * X[0], 0.3 * X[2] * std::cos(20 * X[0])});
    }
    const Model relaxed(viscoelastic, {GetParam(), kappa.viscoelastic});
    const Model plain(elastic, {GetParam(), kappa.relaxed});
    // Stresses of up to the bulk modulus on faces of 0.05 m x 0.05 m.
    EXPECT_LT(largest_distance(internal_forces(relaxed, u), internal_forces(plain, u)),
              512 * eps * law.bulk_modulus() * 0.0025);
    const StrainEnergies a = strain_energies(relaxed, u), b = strain_energies(plain, u);
    EXPECT_NEAR(a.strain, b.strain, 512 * eps * b.strain);
    EXPECT_NEAR(a.hourglass, b.hourglass, 512 * eps * b.hourglass);
  }
}

class LongTermBodyTest : public MethodTest {};
INSTANTIATE_TEST_SUITE_P(, LongTermBodyTest, each_of(PathIndependentMethods{}), method_label);

/// So do quasi-static answers, if unique: modes without energy may end anywhere.
TEST_P(LongTermBodyTest, has_the_equilibrium_of_the_elastic_body) {
  if (method.knows_viscoelasticity && are_comparable(method) && !leaves_hourglass_modes(choice())) {
    const Law law = sample_law<Law>(0.45);
    const auto kappa = same_stiffness(method, law);
    const Scene viscoelastic = bent_block(law), elastic = bent_block(long_term_law(law));
    Observer silent;
    const Relaxation relaxed = relax(Model(viscoelastic, {GetParam(), kappa.viscoelastic}), silent);
    const Relaxation plain = relax(Model(elastic, {GetParam(), kappa.relaxed}), silent);
    ASSERT_TRUE(relaxed.converged);
    ASSERT_TRUE(plain.converged);
    // Unbalanced forces of 1e-11 over the softest stiffness, thousandths of the typical one.
    EXPECT_LT(largest_distance(relaxed.u, plain.u), 1e-7 * 0.03);
    EXPECT_NEAR(relaxed.energies.strain / plain.energies.strain, 1.0, 1e-7);
  }
}

constexpr std::string_view case_text = R"(
[case]
name = "hold"
requirement = "a held block relaxes"
answer = "dynamic"
[mesh]
generator = "box"
size = [0.1, 0.1, 0.1]
elements = [1, 1, 1]
[material]
law = "viscoelastic-neo-hookean"
young_modulus = 2500.0
poisson_ratio = 0.49
density = 1000.0
[dynamics]
duration = 1.0
[sets]
foot = { z = [0.0, 0.0] }
[[displacement]]
set = "foot"
value = [0.0, 0.0, 0.0]
)";

std::string with_parameters(const std::string& lines) {
  std::string text(case_text);
  return text.insert(text.find("density"), lines + "\n");
}

TEST(ViscoelasticCase, is_read_with_one_term_or_two) {
  const TemporaryFolder folder;
  const auto law_of = [&](const std::string& lines) {
    return std::get<Law>(
        read_case_file(folder.write("hold.toml", with_parameters(lines))).materials.front().law);
  };
  const Law one = law_of("relaxation_1 = 0.45\ntime_1 = 0.5");
  EXPECT_EQ(one.young_modulus, 2500.0);
  EXPECT_EQ(one.relaxation_1, 0.45);
  EXPECT_EQ(one.time_1, 0.5);
  EXPECT_EQ(one.relaxation_2, 0.0);
  const Law two = law_of("relaxation_1 = 0.45\ntime_1 = 0.5\nrelaxation_2 = 0.365\ntime_2 = 50.0");
  EXPECT_EQ(two.relaxation_2, 0.365);
  EXPECT_EQ(two.time_2, 50.0);
}

TEST(ViscoelasticCase, wrong_parameters_are_refused_with_their_line) {
  const TemporaryFolder folder;
  const auto error_of = [&](const std::string& lines) {
    const auto file = folder.write("hold.toml", with_parameters(lines));
    return input_error([&] { read_case_file(file); });
  };
  EXPECT_TRUE(contains(error_of("relaxation_1 = 0.45"), "material.time_1 is missing"));
  EXPECT_TRUE(contains(error_of("relaxation_1 = 1.0\ntime_1 = 0.5"), "= 1 must be in [0, 1)"));
  const std::string sum = error_of("relaxation_1 = 0.6\ntime_1 = 0.5\nrelaxation_2 = 0.4\ntime_2 = 50.0");
  EXPECT_TRUE(
      contains(sum, "hold.toml:16: material.relaxation_2 = 0.4 must be below 1 - relaxation_1 = 0.4"));
  const std::string time = error_of("relaxation_1 = 0.6\ntime_1 = 0.5\nrelaxation_2 = 0.3");
  EXPECT_TRUE(contains(time, "material.time_2 = 0 must be positive, as relaxation_2 = 0.3 is"));
}

/// A block of brain tissue, held from t = 0.2 s on after a ramp centred at about 0.1 s. Being nearly
/// incompressible, it keeps its strains while it relaxes, so springs lose energy as the squares of the
/// exponentials. Strains are constant up to the ratio of the moduli, K / mu = 50, by which the volumetric
/// part follows.
TEST(ViscoelasticCase, held_brain_tissue_loses_the_energy_of_its_relaxation_times) {
  const Scene scene = read_scene(std::filesystem::path(SANDGLASS_SOURCE) / "cases" / "brain-hold.toml");
  const Law law = std::get<Law>(scene.materials.list.front().law);
  Recorder recorder;
  integrate(Model(scene, {"tl-perturbation"}), recorder);
  const auto springs = [&](double t) {
    return law.remaining_share() + law.relaxation_1 * std::exp(-2.0 * (t - 0.1) / law.time_1) +
           law.relaxation_2 * std::exp(-2.0 * (t - 0.1) / law.time_2);
  };
  const auto& last = recorder.rows.back();
  for (const auto& row : recorder.rows) {
    if (row.time < 0.4) continue;  // waves of the ramp are still running
    EXPECT_NEAR(row.strain / last.strain, springs(row.time) / springs(last.time), 0.02) << row.time;
  }
  EXPECT_GT(springs(0.4) / springs(2.0), 1.2);
}

}  // namespace
}  // namespace sandglass::verification::viscoelastic_body_test
