/// Viscoelastic laws at one point, without a mesh: the Prony series against its closed forms.

#include <gtest/gtest.h>

#include "material/laws.hpp"
#include "support/dense_matrix.hpp"
#include "support/derivatives.hpp"
#include "support/random_hexahedra.hpp"
#include "support/sample_law.hpp"
#include "support/softening.hpp"
#include "support/typed_lists.hpp"

namespace sandglass::verification::viscoelastic_test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// (1 - exp(-x)) / x.
double mean_of_exponential(double x) {
  return -std::expm1(-x) / x;
}

template <class Elastic>
class ViscoelasticTest : public ::testing::Test {
 protected:
  using Law = Viscoelastic<Elastic>;

  /// A point of the law, moved along a path.
  struct Point {
    Law law;
    ViscousMemory<double> memory{};

    /// The first Piola-Kirchhoff stress (Pa) at H, reached in the given time (s).
    Tensor<double> to(const Tensor<double>& H, double seconds) {
      return law.at_step(seconds).recalling(memory).piola(H);
    }
    double energy(const Tensor<double>& H) const { return law.at_step(1.0).recalling(memory).energy(H); }
  };

  static Law law() { return sample_law<Law>(0.45); }
  static const Elastic& elastic(const Law& law) { return law; }
  static std::array<double, 2> shares(const Law& law) { return {law.relaxation_1, law.relaxation_2}; }
  static std::array<double, 2> times(const Law& law) { return {law.time_1, law.time_2}; }

  Tensor<double> large_gradient() { return random.deformation(0.5, 1.8) - identity<double>(); }

  /// P when only `share` of the isochoric stress remains.
  static Tensor<double> stress(const Law& law, const Tensor<double>& H, double share) {
    const Elastic& instantaneous = law;
    const double p = instantaneous.pressure(jacobian_minus_one(H));
    return share * instantaneous.isochoric_piola(H) + p * cofactor(identity<double>() + H);
  }

  /// Roundoff of a stress, as for elastic laws.
  static double tolerance(const Law& law, const Tensor<double>& H) {
    const Elastic& instantaneous = law;
    const auto bound = tangent_bound(instantaneous, H);
    return 1024 * eps * (std::abs(bound.volumetric) + bound.gradient);
  }

  RandomGeometry random{31};
};

TYPED_TEST_SUITE(ViscoelasticTest, LawTypes, EntryName);

TYPED_TEST(ViscoelasticTest, name_and_parameters_are_the_laws_and_its_own) {
  using ViscoelasticLaw = Viscoelastic<TypeParam>;
  EXPECT_EQ(ViscoelasticLaw::name, "viscoelastic-" + std::string(TypeParam::name));
  EXPECT_EQ(std::tuple_size_v<decltype(ViscoelasticLaw::parameters())>,
            std::tuple_size_v<decltype(TypeParam::parameters())> + 4);
  static_assert(law_remembers<ViscoelasticLaw> && !law_remembers<TypeParam>);
}

/// At a held strain the stress relaxes exponentially, with any steps; the first step is a ramp, of which (1 -
/// exp(-x)) / x remains.
TYPED_TEST(ViscoelasticTest, held_strain_relaxes_as_the_exponentials) {
  const auto law = this->law();
  for (int n = 0; n < 50; ++n) {
    typename TestFixture::Point point{law};
    const auto H = this->large_gradient();
    const double first = std::pow(10.0, this->random.uniform(-4, 1));
    point.to(H, first);
    double held = 0.0;
    for (int step = 0; step < 30; ++step) {
      const double dt = std::pow(10.0, this->random.uniform(-4, 1));
      held += dt;
      double share = law.remaining_share();
      for (std::size_t i = 0; i < 2; ++i) {
        const double tau = this->times(law)[i];
        share += this->shares(law)[i] * mean_of_exponential(first / tau) * std::exp(-held / tau);
      }
      const auto error = point.to(H, dt) - this->stress(law, H, share);
      EXPECT_LT(largest_entry(error), this->tolerance(law, H));
    }
  }
}

/// Under a stress that grows linearly, h_i = g_i tau_i (1 - exp(-t/tau_i)) dS/dt, again for any steps. At
/// strains of 1e-9 the stress is linear in time to 1e-9.
TYPED_TEST(ViscoelasticTest, ramp_is_exact) {
  const auto law = this->law();
  const double size = 1e-9, duration = 20.0;
  for (int n = 0; n < 50; ++n) {
    typename TestFixture::Point point{law};
    const auto H = deviator(this->random.tensor(size));
    double t = 0.0;
    while (t < duration) {
      const double dt = std::pow(10.0, this->random.uniform(-4, 1));
      t += dt;
      double share = law.remaining_share();
      for (std::size_t i = 0; i < 2; ++i) {
        const double tau = this->times(law)[i];
        share += this->shares(law)[i] * mean_of_exponential(t / tau);
      }
      const auto error = point.to((t / duration) * H, dt) - this->stress(law, (t / duration) * H, share);
      EXPECT_LT(largest_entry(error), 100 * size * size * law.shear_modulus() * std::max(1.0, t / duration));
    }
  }
}

/// In general the stress is assumed linear in each step: second order, at large strains too. The integral by
/// parts is h_i = g_i (S - int exp(-(t-s)/tau_i) S ds / tau_i), here with Simpson's rule.
TYPED_TEST(ViscoelasticTest, converges_with_second_order) {
  const auto law = this->law();
  const TypeParam& elastic = law;
  const Tensor<double> amplitude = this->random.tensor(0.3);
  const double duration = 1.3;
  const auto gradient_at = [&](double t) { return std::sin(5.0 * t) * amplitude; };
  const auto second_piola = [&](double t) {
    const auto H = gradient_at(t);
    return inverse(identity<double>() + H) * elastic.isochoric_piola(H);
  };
  const auto H = gradient_at(duration);
  Tensor<double> S = second_piola(duration);
  constexpr int fine = 4000;
  for (std::size_t i = 0; i < 2; ++i) {
    const double tau = this->times(law)[i];
    Tensor<double> integral{};
    for (int n = 0; n <= fine; ++n) {
      const double t = duration * n / fine;
      const double weight = n == 0 || n == fine ? 1.0 : n % 2 == 1 ? 4.0 : 2.0;
      integral += (weight * duration / (3.0 * fine) * std::exp(-(duration - t) / tau)) * second_piola(t);
    }
    S = S - (this->shares(law)[i] / tau) * integral;
  }
  const auto exact = (identity<double>() + H) * S;
  std::array<double, 3> error{};
  for (std::size_t level = 0; level < error.size(); ++level) {
    const int steps = 50 << level;
    typename TestFixture::Point point{law};
    Tensor<double> P{};
    for (int n = 1; n <= steps; ++n) P = point.to(gradient_at(duration * n / steps), duration / steps);
    const double p = elastic.pressure(jacobian_minus_one(H));
    error[level] = largest_entry(P - p * cofactor(identity<double>() + H) - exact);
  }
  EXPECT_LT(error[0], 1e-2 * law.shear_modulus());
  // On the path fibres slacken: the error of that step is dt^2 times a factor that depends on where in the
  // step the stress has its kink.
  constexpr double width = slackens<TypeParam> ? 1.0 : 0.3;
  for (std::size_t level = 0; level < 2; ++level) EXPECT_NEAR(error[level] / error[level + 1], 4.0, width);
}

/// A body turns differently in each step while it deforms and relaxes: its stress turns with it.
TYPED_TEST(ViscoelasticTest, stress_does_not_depend_on_the_observer) {
  const auto law = this->law();
  typename TestFixture::Point still{law}, turning{law};
  for (int n = 0; n < 100; ++n) {
    const auto H = this->large_gradient();
    const auto Q = this->random.rotation();
    const double dt = this->random.uniform(0.0, 1.0);
    const auto P = still.to(H, dt);
    const auto turned = turning.to(Q * (identity<double>() + H) - identity<double>(), dt);
    EXPECT_LT(largest_entry(turned - Q * P), this->tolerance(law, H));
    EXPECT_NEAR(turning.energy(Q * (identity<double>() + H) - identity<double>()), still.energy(H),
                this->tolerance(law, H));
  }
}

/// In no time the law is the elastic one; in infinite time the relaxing part is gone, in stress and energy.
TYPED_TEST(ViscoelasticTest, limits_are_elastic) {
  const auto law = this->law();
  const TypeParam& elastic = law;
  for (int n = 0; n < 50; ++n) {
    const auto H = this->large_gradient();
    typename TestFixture::Point fast{law}, slow{law};
    const auto instantaneous = fast.to(H, 1e-18);
    EXPECT_LT(largest_entry(instantaneous - elastic.piola(H)), this->tolerance(law, H));
    EXPECT_NEAR(fast.energy(H), elastic.energy(H), this->tolerance(law, H));
    const auto relaxed = slow.to(H, infinity);
    EXPECT_LT(largest_entry(relaxed - this->stress(law, H, law.remaining_share())), this->tolerance(law, H));
    EXPECT_NEAR(slow.energy(H),
                elastic.volumetric_energy(jacobian_minus_one(H)) +
                    law.remaining_share() * elastic.isochoric_energy(H),
                this->tolerance(law, H));
    EXPECT_NEAR(law.remaining_share(), 0.185, 1e-15);
  }
}

/// At small strains stored energy is that of springs: at a held strain it decays with the squares of the
/// exponentials. It is 0 in the undeformed state and never negative.
TYPED_TEST(ViscoelasticTest, stored_energy_is_that_of_the_springs) {
  const auto law = this->law();
  const TypeParam& elastic = law;
  EXPECT_EQ((typename TestFixture::Point{law}.energy(Tensor<double>{})), 0.0);
  const auto H = deviator(this->random.tensor(1e-7));
  typename TestFixture::Point point{law};
  point.to(H, 1e-18);
  for (const double dt : {0.1, 0.7, 9.0, 1e4}) {
    point = {law};
    point.to(H, 1e-18);
    point.to(H, dt);
    double share = law.remaining_share();
    for (std::size_t i = 0; i < 2; ++i) {
      share += this->shares(law)[i] * std::exp(-2.0 * dt / this->times(law)[i]);
    }
    const double W = elastic.isochoric_energy(H);
    EXPECT_NEAR((point.energy(H) - elastic.volumetric_energy(jacobian_minus_one(H))) / W, share, 1e-6);
  }
  if (!TypeParam::traits.splits_volume) return;  // its isochoric part alone may be negative
  point = {law};
  for (int n = 0; n < 200; ++n) {
    const auto large = this->large_gradient();
    point.to(large, this->random.uniform(0.0, 2.0));
    EXPECT_GE(point.energy(large), 0.0);
  }
}

/// The stress for Updated Lagrangian elements: tau = P F^T; the elastic law's if no time passes.
TYPED_TEST(ViscoelasticTest, kirchhoff_stress_is_that_of_the_piola_stress) {
  const auto law = this->law();
  const TypeParam& elastic = law;
  const double V = 0.3;
  const auto kirchhoff = [&](const auto& any_law, const Tensor<double>& H) {
    return any_law.weighted_kirchhoff(V, H, volume_change(H), elastic.pressure(jacobian_minus_one(H)));
  };
  typename TestFixture::Point point{law};
  for (int n = 0; n < 50; ++n) {
    const auto H = this->large_gradient();
    const double dt = this->random.uniform(0.0, 1.0);
    auto memory = point.memory;
    const auto tau = kirchhoff(law.at_step(dt).recalling(memory), H);
    const auto P = point.to(H, dt);
    EXPECT_LT(largest_entry(tau - V * (P * transpose(identity<double>() + H))), 4 * this->tolerance(law, H));
    EXPECT_LT(largest_entry(full(memory.S) - full(point.memory.S)), this->tolerance(law, H));
    ViscousMemory<double> fresh{};
    const auto instantaneous = kirchhoff(law.at_step(1e-18).recalling(fresh), H);
    EXPECT_LT(largest_entry(instantaneous - kirchhoff(elastic, H)), 4 * this->tolerance(law, H));
  }
}

/// The largest stiffness of a further step of any length, from any state: below the bound for all L together.
TYPED_TEST(ViscoelasticTest, tangent_bound_holds) {
  const auto law = this->law();
  for (int n = 0; n < 300; ++n) {
    typename TestFixture::Point point{law};
    Tensor<double> H{};
    for (int step = 0; step < 4; ++step) {
      H = this->large_gradient();
      point.to(H, std::pow(10.0, this->random.uniform(-3, 3)));
    }
    const auto bound = tangent_bound(law.at_step(1.0).recalling(point.memory), H);
    for (const double dt : {1e-6, 0.3, 30.0, infinity}) {
      Matrix<double, 9, 9> slack{};
      for (int k = 0; k < 9; ++k) {
        ViscousMemory<D> memory{constant(point.memory.S), {}};
        for (std::size_t i = 0; i < 2; ++i) memory.decayed[i] = constant(point.memory.decayed[i]);
        const Tensor<double> F = identity<double>() + H;
        const auto dH = along(H, unit<3, 3>(static_cast<std::size_t>(k)) * F);
        const auto current = slope(law.at_step(dt).recalling(memory).piola(dH)) * transpose(F);
        for (int m = 0; m < 9; ++m) slack(m, k) = -current.entries[static_cast<std::size_t>(m)];
        slack(k, k) += bound.gradient;
        if (k % 4 == 0) {
          for (int m = 0; m < 9; m += 4) slack(m, k) += bound.volumetric;
        }
      }
      const auto symmetric = 0.5 * (slack + transpose(slack));
      ASSERT_GT(eigenvalues(symmetric).front(), -1e-12 * largest_entry(symmetric)) << "dt " << dt;
    }
  }
}

/// The factors of a step, from vanishing to infinite steps, against long double. The difference as written, 1
/// - (1 - e^-x)/x, would have an error of eps/x.
TEST(ViscousStepTest, factors_have_all_their_digits) {
  const double share = 0.45;
  for (double x = 1e-15; x < 1e3; x *= 1.3) {
    const auto step = ViscousStep::of(share, 2.0, 2.0 * x);
    const long double y = 2.0 * x / 2.0;
    const long double decay = -std::expm1(-y);
    const long double series = y / 2 * (1 - y / 3 * (1 - y / 4 * (1 - y / 5 * (1 - y / 6))));
    const long double lag = x < 1e-3 ? series : 1 - decay / y;
    EXPECT_NEAR(static_cast<double>(step.decay / decay), 1.0, 4 * eps) << x;
    EXPECT_NEAR(static_cast<double>(step.follow / (share * lag)), 1.0, 8 * eps) << x;
  }
  const auto never = ViscousStep::of(share, 2.0, 0.0);
  EXPECT_EQ(never.decay, 0.0);
  EXPECT_EQ(never.follow, 0.0);
  const auto forever = ViscousStep::of(share, 2.0, infinity);
  EXPECT_EQ(forever.decay, 1.0);
  EXPECT_EQ(forever.follow, share);
  const auto absent = ViscousStep::of(0.0, 0.0, infinity);
  EXPECT_EQ(absent.decay + absent.follow + absent.inverse_share, 0.0);
}

TEST(ViscoelasticParameters, have_to_fit_together) {
  auto law = sample_law<Viscoelastic<NeoHookean>>(0.45);
  EXPECT_FALSE(law.broken_rule());
  law.relaxation_2 = 0.55;
  EXPECT_EQ(law.broken_rule()->parameter, "relaxation_2");
  law.relaxation_2 = 0.1;
  law.time_2 = 0.0;
  EXPECT_EQ(law.broken_rule()->parameter, "time_2");
  law.relaxation_2 = 0.0;
  EXPECT_FALSE(law.broken_rule());
}

/// Relaxation after 100,000 steps in single precision, at a held strain with a small vibration. Each step
/// rounds Q a few times by u |Q|, and an error decays within tau/dt steps: the sum of |Q| over the last
/// min(n, tau/dt) steps bounds it. Terms are 5,000 to 5e8 steps long; for the last, exp(-dt/tau) is 1 in
/// single precision, and yet it relaxes: stored as h_i it would not.
TEST(ViscoelasticPrecision, does_not_drift_in_a_hundred_thousand_steps) {
  constexpr double u = 0.5 * static_cast<double>(std::numeric_limits<float>::epsilon());
  constexpr int steps = 100000;
  const double dt = 1e-4;
  auto law = sample_law<Viscoelastic<NeoHookean>>(0.49);
  for (const double slow : {50.0, 5e4}) {
    law.time_2 = slow;
    const auto at = law.at_step(dt);
    ViscousMemory<double> exact{};
    ViscousMemory<float> rounded{};
    std::array<double, 2> budget{};
    for (int n = 0; n < steps; ++n) {
      Tensor<float> H{};
      H(0, 1) = static_cast<float>(0.2 + 0.001 * std::sin(0.37 * n));
      Tensor<double> same{};
      same(0, 1) = static_cast<double>(H(0, 1));
      at.recalling(exact).piola(same);
      at.recalling(rounded).piola(H);
      const std::array<double, 2> tau{law.time_1, law.time_2};
      for (std::size_t i = 0; i < 2; ++i) {
        const double Q = std::sqrt(norm_square(exact.decayed[i]));
        budget[i] += 3.0 * u * Q - dt / tau[i] * budget[i];
      }
    }
    for (std::size_t i = 0; i < 2; ++i) {
      Symmetric<double> difference{};
      for (int k = 0; k < 6; ++k) {
        difference(k, 0) = static_cast<double>(rounded.decayed[i](k, 0)) - exact.decayed[i](k, 0);
      }
      const double size = std::sqrt(norm_square(exact.decayed[i]));
      const double error = std::sqrt(norm_square(difference));
      EXPECT_LT(error, budget[i] + 16.0 * u * size) << "term " << i << " slow " << slow;
      EXPECT_LT(error, 1e-2 * size) << "term " << i << " slow " << slow;
      ::testing::Test::RecordProperty(fmt::format("error_{}_{}", i, slow), std::to_string(error / size));
    }
  }
}

}  // namespace
}  // namespace sandglass::verification::viscoelastic_test
