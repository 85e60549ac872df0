/// All pairs of methods and laws in the solver: finds errors of combinations that no single kernel shows.

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "comparison/finding.hpp"
#include "solve/relaxation.hpp"
#include "support/pair_test.hpp"
#include "support/patch_mesh.hpp"
#include "support/random_hexahedra.hpp"
#include "support/scenes.hpp"
#include "support/softening.hpp"

namespace sandglass::verification::pairs_test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

bool knows(const MethodEntry& method, const AnyLaw& law) {
  return method.knows_viscoelasticity || !is_viscoelastic(law);
}

/// The law of a body without relaxation: viscoelastic parts are the subject of viscoelastic_test.cpp and are
/// kept from relaxing here.
AnyLaw without_relaxation(AnyLaw law) {
  std::visit(
      []<class Law>(Law& own) {
        if constexpr (law_remembers<Law>) own.relaxation_1 = own.relaxation_2 = 0.0;
      },
      law);
  return law;
}

/// A bound of the law's stiffness (Pa) at H.
double stiffness(const AnyLaw& any_law, const Tensor<double>& H) {
  return std::visit(
      [&](const auto& law) {
        const auto bound = tangent_bound(law, H);
        return std::abs(bound.volumetric) + bound.gradient;
      },
      any_law);
}

/// Tests skip methods by these properties, so a wrong one could hide a failure.
TEST(MethodEntries, have_the_properties_of_their_types) {
  for_each_type(Methods{}, []<class Method>() {
    SCOPED_TRACE(Method::name);
    const MethodEntry& entry = method_named(Method::name);
    EXPECT_EQ(leaves_hourglass_modes({std::string(Method::name)}), zero_energy_modes<Method>() > 6);
    EXPECT_EQ(entry.is_linear, is_linear<Method>);
    EXPECT_EQ(entry.is_condensed, is_condensed<Method>);
    EXPECT_EQ(entry.pressure_varies, pressure_varies<Method>);
    EXPECT_EQ(entry.takes_kappa, Method::Hourglass::traits.takes_kappa);
    EXPECT_EQ(entry.adapts(), is_adaptive<Method>);
    EXPECT_EQ(entry.knows_viscoelasticity, (knows_law<Method, Viscoelastic<NeoHookean>>));
    constexpr bool updated = std::is_same_v<typename Method::Kinematics, UpdatedOnePoint>;
    EXPECT_EQ(is_updated_lagrangian(entry), updated);
  });
}

/// Expects the forces V h P^T of an element with corners at X under the stress P, up to roundoff:
/// displacements and coordinates are rounded to eps times the size, times the stiffness (Pa).
void expect_forces(const NodalField& force, const NodalVectors<double>& X, const Tensor<double>& P,
                   double stiffness) {
  const MeanGradient mean = mean_gradient(X);
  const auto exact = mean.h * (mean.volume * transpose(P));
  const double tolerance = 4096 * eps * stiffness * mean.volume * largest_entry(mean.h) *
                           (1.0 + largest_entry(mean.h) * largest_entry(X));
  for (int I = 0; I < 8; ++I) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(force[index(I)][index(i)], exact(I, i), tolerance);
  }
}

/// One distorted element under a uniform strain, reached in one step: forces are V h P^T with the law's own
/// stress. Kinematics that pass a wrong strain, pressure or weight to a law fail here.
TEST(Pairs, uniform_strain_gives_the_stress_of_the_law) {
  for (const MethodEntry& method : methods()) {
    for (const std::string& name : names_of(Laws{})) {
      const AnyLaw law = without_relaxation(sample_law(name, 0.45));
      if (!knows(method, law)) continue;
      SCOPED_TRACE(std::string(method.name) + " " + name);
      RandomGeometry random(71);
      for (int n = 0; n < 5; ++n) {
        const NodalVectors<double> X = fitting_hexahedron(random, method.name);
        const Tensor<double> H = random.deformation(0.7, 1.4) - identity<double>();
        const auto [mesh, u] = one_strained_element(X, H);
        const Scene scene = make_scene(plain_case(law), mesh);
        expect_forces(internal_forces(Model(scene, {std::string(method.name)}), u), X,
                      exact_stress(method.is_linear, law, H), stiffness(law, H));
      }
    }
  }
}

/// Whether a method is known to fail on the column: it has no control, or none for static equilibrium; it
/// locks, if only in shear; or it is wrong for rotations. All others must be good.
bool known_failure(const MethodEntry& method) {
  return leaves_hourglass_modes({std::string(method.name)}) || method.is_linear ||
         method.name == TlFull::name || method.name == T4::name || method.name == T4Anp::name;
}

/// A short column, pulled and sheared like the paper's, against mean dilatation with the same law.
Scene short_column(const AnyLaw& law) {
  Case description = plain_case(law);
  const Mesh mesh = box({0.1, 0.1, 0.4}, {2, 2, 8});
  const NodeSets sets{{"foot", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.0; })},
                      {"head", nodes_where(mesh.points, [](const Vector& X) { return X[2] > 0.399; })}};
  description.displacements = {{"foot", {}}, {"head", {0.2, 0.0, 0.12}}};
  description.relaxation.max_steps = 20000;
  return make_scene(description, mesh, sets);
}

/// The finding for a method on a scene, with errors up to `limit` from the golden.
Finding found_on(const Scene& scene, std::string_view method, const NodalField& golden, double limit) {
  Observer silent;
  try {
    const Relaxation answer = relax(Model(scene, {std::string(method)}), silent);
    const double energy = answer.energies.strain + answer.energies.hourglass;
    if (!answer.converged) return Finding::no_equilibrium;
    return diagnose(symptoms(scene, answer.u, energy, golden, 0.233), limit);
  } catch (const ComputationError&) {
    return Finding::inverted;
  }
}

/// Every pair finds its static equilibrium, and is good or fails as expected for its method.
TEST(Pairs, every_control_runs_the_column_with_every_law) {
  for (const std::string& name : names_of(Laws{})) {
    const AnyLaw law = sample_law(name, 0.45);
    const Scene scene = short_column(law);
    Observer silent;
    // A law that does not split its volumetric part may lose stiffness where pressure is averaged.
    const std::string reference(splits_volume(law) ? TlMeanDilatation::name : TlPerturbation::name);
    const Relaxation golden = relax(Model(scene, {reference}), silent);
    ASSERT_TRUE(golden.converged) << name;
    // Controls keep the stiffness of the unrelaxed body: too stiff for the relaxed one, more so where fibres
    // are slack as well (errors are larger by a quarter with any control).
    const bool slack = std::visit([]<class Law>(const Law&) { return slackens<Law>; }, law);
    const double limit = !is_viscoelastic(law) ? 0.02 : slack ? 0.06 : 0.05;
    for (const MethodEntry& method : methods()) {
      if (!knows(method, law)) continue;
      const std::string pair = std::string(method.name) + " " + name;
      SCOPED_TRACE(pair);
      const Finding found = found_on(scene, method.name, golden.u, limit);
      RecordProperty("finding " + pair, std::string(name_of(found)));
      if (!known_failure(method) && !may_give_way(method, law)) {
        EXPECT_EQ(name_of(found), name_of(Finding::good));
      } else if (std::holds_alternative<NeoHookean>(law) && method.name != T4Anp::name) {
        EXPECT_NE(found, Finding::good);
      }
    }
  }
}

/// Small-strain methods reject laws with stress relaxation instead of ignoring it.
TEST(Pairs, linear_methods_refuse_laws_that_relax) {
  const Mesh mesh = box({1, 1, 1}, {1, 1, 1});
  const AnyLaw law = sample_law<Viscoelastic<NeoHookean>>(0.45);
  for (const MethodEntry& method : methods()) {
    if (!method.is_linear) continue;
    EXPECT_THROW(make_internal_force(mesh, law, {std::string(method.name)}), InputError) << method.name;
  }
}

}  // namespace
}  // namespace sandglass::verification::pairs_test
