/// Static equilibria against SUNDIALS: the same elements, assembled plainly and solved by KINSOL.

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "solve/equilibrium.hpp"
#include "solve/load_levels.hpp"
#include "solve/relaxation.hpp"
#include "support/balance.hpp"
#include "support/random_hexahedra.hpp"
#include "support/scenes.hpp"
#include "support/typed_lists.hpp"

namespace sandglass::verification::equilibrium_oracle_test {
namespace {

double norm(const std::vector<double>& a) {
  double square = 0.0;
  for (const double x : a) square += x * x;
  return std::sqrt(square);
}

/// A short column, pulled and sheared like the paper's.
Scene short_column(const AnyLaw& law) {
  Case description = plain_case(law);
  const Mesh mesh = box({0.1, 0.1, 0.4}, {2, 2, 8});
  const NodeSets sets{{"foot", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.0; })},
                      {"head", nodes_where(mesh.points, [](const Vector& X) { return X[2] > 0.399; })}};
  description.displacements = {{"foot", {}}, {"head", {0.2, 0.0, 0.12}}};
  description.relaxation.tolerance = 1e-11;
  return make_scene(description, mesh, sets);
}

/// A block of distorted elements, pressed on half of its top.
Scene pressed_block(const AnyLaw& law) {
  Case description = plain_case(law);
  Mesh mesh = box({0.1, 0.1, 0.1}, {3, 3, 3});
  const NodeSets sets{
      {"foot", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.0; })},
      {"pressed", nodes_where(mesh.points, [](const Vector& X) { return X[2] > 0.099 && X[0] < 0.05; })}};
  RandomGeometry random(23);
  for (auto& X : mesh.points) {
    for (auto& x : X) x += random.uniform(-0.004, 0.004);
  }
  description.displacements = {{"foot", {}}, {"pressed", {0.005, 0.0, -0.02}}};
  description.relaxation.tolerance = 1e-11;
  return make_scene(description, mesh, sets);
}

/// Residuals of both solutions, and their distance.
struct Agreement {
  double residual;         ///< of the relaxed displacements, by the plain assembly, over the forces carried
  double oracle_residual;  ///< of KINSOL's displacements, likewise
  double distance;         ///< largest, over the imposed displacement
  double bound;            ///< of the distance
};

/// Displacements `exact` and `relaxed` (m) with residuals r are slightly out of balance: to first order the
/// true equilibrium is K^-1 r away, so the two lie within |K^-1| (|r_exact| + |r_relaxed|) of each other,
/// where K is the tangent of the free components. The Frobenius norm is no smaller than the spectral norm.
template <class Kernel, class Law>
Agreement agreement(const Balance<Kernel, Law>& balance, const Scene& scene, const std::vector<double>& exact,
                    const std::vector<double>& relaxed) {
  const std::vector<double> forces = balance.forces(exact);
  const double carried = norm(forces);
  const double r_exact = norm(balance.free_of(forces));
  const double r_relaxed = norm(balance.free_of(balance.forces(relaxed)));
  const std::vector<double> K = balance.tangent(exact);
  const auto solved = factored(K.data(), static_cast<int>(balance.size()));
  std::vector<double> unit_force(balance.size()), columns;
  for (double& f : unit_force) {
    f = 1.0;
    columns.push_back(norm(solved(unit_force)));
    f = 0.0;
  }
  const double compliance = norm(columns);
  const double unit = largest_imposed(scene);
  return {r_relaxed / carried, r_exact / carried, largest_distance(nodal(exact), nodal(relaxed)) / unit,
          compliance * (r_exact + r_relaxed) / unit};
}

/// The limit is 1e-7 of the imposed displacement, and the bound gives the residual this needs: on these
/// scenes |K^-1| times the forces carried is 15 to 110 imposed displacements, so that a residual of 1e-9
/// would suffice. The scenes request 1e-11, and the distance is compared with the bound, not with the limit.
void expect_agreement(const Agreement& found) {
  EXPECT_LT(found.residual, 1.01e-11);  // the tolerance that relaxation reached
  EXPECT_LT(found.oracle_residual, 1e-12);
  EXPECT_LT(found.bound, 1e-7);
  EXPECT_LT(found.distance, found.bound);
  const auto record = [](const std::string& name, double value) {
    ::testing::Test::RecordProperty(name, fmt::format("{:.1e}", value));
  };
  record("residual", found.residual);
  record("residual of KINSOL", found.oracle_residual);
  record("distance over imposed", found.distance);
  record("bound over imposed", found.bound);
}

/// A method whose forces depend only on displacements: KINSOL starts from the undeformed shape and takes ten
/// load levels, independently of relaxation. The first levels are short because Newton's method starts there
/// with only the imposed nodes moved; later ones start on the line through the last two solutions.
template <class Method, class Law>
void expect_the_oracles_balance(const Scene& scene, const Law& law) {
  Observer silent;
  const Relaxation relaxed = relax(Model(scene, {std::string(Method::name)}), silent);
  ASSERT_TRUE(relaxed.converged);
  const Balance<FormulationOf<Method, Law>, Law> balance(scene, law);
  const std::vector<double> u = flat(relaxed.u);
  const double tolerance = 1e-13 * norm(balance.forces(u));
  constexpr int levels = 10;
  const auto share = [](int level) { return static_cast<double>(level * level) / (levels * levels); };
  std::vector<double> x(balance.size(), 0.0);
  std::vector<double> before = x;
  for (int level = 1; level <= levels; ++level) {
    const double ahead =
        level > 1 ? (share(level) - share(level - 1)) / (share(level - 1) - share(level - 2)) : 0.0;
    std::vector<double> start = x;
    for (std::size_t k = 0; k < x.size(); ++k) start[k] += ahead * (x[k] - before[k]);
    before = x;
    x = balance.solved(start, share(level), largest_imposed(scene), tolerance);
  }
  expect_agreement(agreement(balance, scene, balance.displacements(x, 1.0), u));
}

/// The state in which `relax` leaves a body, with its elements' memory: the same search on the same objects,
/// without the handling of failures.
State<double> relaxed_state(const Model& model, const InternalForce<double>& elements) {
  Equilibrium<double> search(model, elements);
  LoadLevels<double> levels(model, search.body(), elements.needs_increment());
  const double tolerance = model.scene().settings.relaxation.tolerance;
  for (;;) {
    levels.predict(search);
    search.start(levels.effort());
    while (levels.full() ? !(search.residual() < tolerance) : !levels.far_enough(search)) {
      if (!search.step()) throw std::runtime_error("the search found no way on");
    }
    if (levels.full()) return search.body().state();
    levels.solved(search);
  }
}

/// A method with memory reaches an equilibrium that depends on its path, which is the search's own: every
/// trial turns and loads the hourglass resistances. An outside solver cannot find this equilibrium, but it
/// can confirm it: with the elements' memory at the end, forces balance there and nowhere nearby. So the
/// search is repeated to obtain the memory, which must give the same bits, and KINSOL starts with that memory
/// a hundredth of the imposed displacement away.
template <class Method, class Law>
void expect_the_balance_that_is_remembered(const Scene& scene, const Law& law) {
  using Kernel = FormulationOf<Method, Law>;
  using Assembly = PlainAssembly<Kernel, Law>;
  MethodChoice choice{std::string(Method::name)};
  choice.kernel = KernelWidth::scalar;  // one element at a time: its history is a sequence of numbers
  const Model model(scene, choice);
  const auto& elements = *std::get<0>(model.internal_force());
  Observer silent;
  const Relaxation relaxed = relax(model, silent);
  ASSERT_TRUE(relaxed.converged);
  const State<double> state = relaxed_state(model, elements);
  ASSERT_EQ(to_field(state.u, elements.layout()), relaxed.u);

  const auto& order = elements.layout().elements;
  ASSERT_EQ(state.history.size(), order.size() * Assembly::history_numbers);
  std::vector<double> memory(scene.mesh.cells.size() * Assembly::history_numbers);
  for (std::size_t level = 0; level < order.size(); ++level) {
    if (order[level] < 0) continue;
    for (std::size_t n = 0; n < Assembly::history_numbers; ++n) {
      memory[index(order[level]) * Assembly::history_numbers + n] =
          state.history[level * Assembly::history_numbers + n];
    }
  }
  const std::vector<double> u = flat(relaxed.u);
  Balance<Kernel, Law> balance(scene, law);
  balance.start_from(u, balance.assembly().histories(memory.data()));
  RandomGeometry random(7);
  std::vector<double> start = balance.free_of(u);
  for (double& x : start) x += 0.01 * largest_imposed(scene) * random.uniform(-1.0, 1.0);
  const auto x = balance.solved(start, 1.0, largest_imposed(scene), 1e-13 * norm(balance.forces(u)));
  expect_agreement(agreement(balance, scene, balance.displacements(x, 1.0), u));
}

/// A method without resistance to hourglass modes has no unique equilibrium, and may find none before
/// elements invert. The test can only show that the forces of the plain assembly balance where relaxation
/// reports it, to the same residual.
template <class Method, class Law>
void expect_a_balance(const Scene& scene, const Law& law) {
  Relaxation relaxed;
  try {
    Observer silent;
    relaxed = relax(Model(scene, {std::string(Method::name)}), silent);
  } catch (const ComputationError& error) {
    GTEST_SKIP() << error.what();
  }
  const Balance<FormulationOf<Method, Law>, Law> balance(scene, law);
  const std::vector<double> forces = balance.forces(flat(relaxed.u));
  const double free = norm(balance.free_of(forces)), all = norm(forces);
  const double residual = free / std::sqrt(all * all - free * free);
  EXPECT_NEAR(residual / relaxed.residual, 1.0, 0.1);
  ::testing::Test::RecordProperty("residual", fmt::format("{:.1e}", residual));
}

template <class Method, class Law>
void expect_rest(const Scene& scene, const Law& law) {
  if constexpr (is_adaptive<Method>) {
    GTEST_SKIP() << "its levels are balanced one by one, and their mixture in adaptive_test.cpp";
  } else if constexpr (zero_energy_modes<Method>() > 6) {
    expect_a_balance<Method>(scene, law);
  } else if constexpr (detail::path_independent<Method>) {
    expect_the_oracles_balance<Method>(scene, law);
  } else {
    expect_the_balance_that_is_remembered<Method>(scene, law);
  }
}

template <class Method>
class EquilibriumOracleTest : public ::testing::Test {};

TYPED_TEST_SUITE(EquilibriumOracleTest, MethodTypes, EntryName);

TYPED_TEST(EquilibriumOracleTest, relaxation_finds_the_balance_of_a_column) {
  const NeoHookean law = sample_law<NeoHookean>(0.49);
  expect_rest<TypeParam>(short_column(law), law);
}

TYPED_TEST(EquilibriumOracleTest, relaxation_finds_the_balance_of_a_pressed_block) {
  const NeoHookean law = sample_law<NeoHookean>(0.49);
  expect_rest<TypeParam>(pressed_block(law), law);
}

/// Laws that relax, when fully relaxed: elements with one point and with eight.
TEST(EquilibriumOracle, relaxed_laws_find_their_balance) {
  const auto law = sample_law<Viscoelastic<NeoHookean>>(0.49);
  expect_rest<TlPerturbation>(pressed_block(law), law);
  expect_rest<TlMeanDilatation>(pressed_block(law), law);
}

}  // namespace
}  // namespace sandglass::verification::equilibrium_oracle_test
