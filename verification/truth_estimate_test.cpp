/// The estimated distance from the truth: its indicators, the meshes that follow from them, and its agreement
/// with stored truths.

#include "comparison/truth_estimate.hpp"

#include <gtest/gtest.h>

#include "comparison/comparison.hpp"
#include "comparison/reference_file.hpp"
#include "io/case_file.hpp"
#include "problem/scene_refinement.hpp"
#include "solve/mixed_body.hpp"
#include "solve/relaxation.hpp"
#include "support/case_text.hpp"
#include "support/scenes.hpp"
#include "support/static_answer.hpp"

namespace sandglass::verification::truth_estimate_test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

/// A box of 2 x 2 x 2 elements in two layers of different stiffness, held below and pushed above, with
/// further tables.
CaseOnMesh two_layers(const std::string& more = "") {
  std::string text = box_case("layers", "[1.0, 1.0, 1.0]", "[2, 2, 2]");
  text = text.substr(text.find("[case]"), text.find("[mesh]")) + R"(
[[materials]]
law = "neo-hookean"
young_modulus = 3000.0
poisson_ratio = 0.4
density = 1000.0

[[materials]]
elements = "upper"
law = "neo-hookean"
young_modulus = 9000.0
poisson_ratio = 0.3
density = 1000.0

[element_sets]
upper = { z = [0.5, inf] }

[sets]
bottom = { z = [0.0, 0.0] }
top = { z = [1.0, 1.0] }

[[displacement]]
set = "bottom"
value = [0.0, 0.0, 0.0]

[[displacement]]
set = "top"
value = [0.1, 0.0, -0.1]
)" + more;
  return with_mesh(text, {.mesh = box({1, 1, 1}, {2, 2, 2})});
}

CaseOnMesh case_named(const std::string& name) {
  return with_mesh(read_case_file(std::filesystem::path(SANDGLASS_SOURCE) / "cases" / (name + ".toml")));
}

/// The same case with some of its elements split once more.
CaseOnMesh split(CaseOnMesh problem, std::vector<int> elements) {
  problem.description = refined(std::move(problem.description), std::move(elements));
  return problem;
}

/// A displacement that is linear in each material has no error, although its gradient jumps between them and
/// the interface has hanging nodes.
TEST(ErrorIndicators, vanish_where_each_material_has_one_gradient) {
  const Scene scene = make_scene(split(two_layers(), {0, 5}));
  ASSERT_FALSE(scene.ties.empty());
  const Tensor<double> lower{{.1, .2, -.3, .4, .5, .6, -.7, .8, .9}};
  NodalField u;
  for (const Vector& X : scene.mesh.points) {
    u.push_back(linear(lower, X));
    u.back()[0] += 2.0 * std::max(0.0, X[2] - 0.5);
  }
  // Rounding: gradients of about one from differences of coordinates of about one over sizes of a quarter.
  for (const double indicator : error_indicators(scene, u)) EXPECT_LT(indicator, 1e4 * eps * eps);
}

/// u_x = x^2 / 2 on two elements of length one half in a row: mean gradients are .25 and .75, recovered ones
/// .25, .5 and .75; each element has half its corners in the middle, where the distance is .25.
TEST(ErrorIndicators, are_the_squared_distance_from_recovered_gradients) {
  const Scene scene = make_scene(plain_case(NeoHookean{}), box({1, 1, 1}, {2, 1, 1}));
  NodalField u;
  for (const Vector& X : scene.mesh.points) u.push_back({0.5 * X[0] * X[0], 0, 0});
  for (const double indicator : error_indicators(scene, u))
    EXPECT_NEAR(indicator, 0.5 * 0.5 * 0.25 * 0.25, 16 * eps);
}

TEST(LargestShare, takes_the_fewest_elements) {
  const std::vector<double> indicators{1, 5, 0, 2, 2};
  EXPECT_EQ(largest_share(indicators, 0.5), std::vector<int>({1}));
  EXPECT_EQ(largest_share(indicators, 0.6), std::vector<int>({1, 3}));
  EXPECT_EQ(largest_share(indicators, 0.9), std::vector<int>({1, 3, 4}));
  EXPECT_EQ(largest_share(indicators, 0.95), std::vector<int>({0, 1, 3, 4}));
  EXPECT_TRUE(largest_share({0, 0}, 0.5).empty());
}

/// Stepwise refinement gives the same scene as the case file, including sets, materials and ties.
TEST(Refined, is_the_case_with_one_more_rule) {
  const CaseOnMesh first = split(two_layers(), {1, 6});
  const Scene once = make_scene(first), twice = make_scene(split(first, {4}));
  const Scene at_once =
      make_scene(two_layers("[[refine]]\nnumbers = [1, 6]\n[[refine]]\nnumbers = [4]\nafter = 1\n"));
  EXPECT_GT(twice.mesh.cells.size(), once.mesh.cells.size());
  EXPECT_EQ(twice.mesh_hash, at_once.mesh_hash);
  EXPECT_EQ(twice.case_hash, at_once.case_hash);
  EXPECT_NE(twice.case_hash, once.case_hash);
  EXPECT_EQ(twice.constraints.size(), at_once.constraints.size());
}

TEST(Refined, wrong_numbers_are_refused) {
  const auto message = [](const std::string& rule) {
    try {
      make_scene(two_layers("[[refine]]\n" + rule));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(message("numbers = [8]\n").find("refine.numbers = 8 must be below 8"), std::string::npos);
  EXPECT_NE(message("numbers = [-1]\n").find("refine.numbers = -1"), std::string::npos);
  EXPECT_NE(message("numbers = []\n").find("at least one entry"), std::string::npos);
  EXPECT_NE(message("numbers = [1]\nelements = \"upper\"\n").find("one of the three"), std::string::npos);
  EXPECT_NE(message("numbers = [1]\ndepth = 2\n").find("depth"), std::string::npos);
}

/// The field on the coarse mesh is unchanged.
TEST(Prolonged, keeps_linear_fields) {
  const Scene coarse = make_scene(two_layers()), fine = make_scene(split(two_layers(), {2, 7}));
  const Tensor<double> H{{.1, .2, -.3, .4, .5, .6, -.7, .8, .9}};
  const auto field = [&](const Mesh& mesh) {
    NodalField u;
    for (const Vector& X : mesh.points) u.push_back(linear(H, X));
    return u;
  };
  EXPECT_LT(largest_distance(prolonged(fine.coarser.front(), field(coarse.mesh)), field(fine.mesh)),
            16 * eps);
}

/// A search finds the answer from a close guess in fewer evaluations, and even from a useless one.
TEST(Relax, starts_near_a_guess) {
  const Scene scene = make_scene(split(two_layers(), {4, 5}));
  const Model model(scene, {"tl-mean-dilatation"});
  Observer quiet;
  const Relaxation from_rest = relax(model, quiet);
  NodalField guess = from_rest.u;
  for (std::size_t n = 0; n < guess.size(); ++n) guess[n][n % 3] += 1e-4 * static_cast<double>(n % 5);
  const Relaxation near = relax(model, quiet, nullptr, &guess);
  for (Vector& u : guess) u[2] *= -20.0;  // elements are inverted
  const Relaxation from_nonsense = relax(model, quiet, nullptr, &guess);
  // A residual of 1e-8 leaves an error of about that fraction of the imposed displacements; ten times for the
  // condition number.
  const double tolerance = 10.0 * scene.settings.relaxation.tolerance * largest_imposed(scene);
  EXPECT_TRUE(near.converged);
  EXPECT_LT(near.steps, from_rest.steps);
  EXPECT_LT(largest_distance(near.u, from_rest.u), tolerance);
  EXPECT_TRUE(from_nonsense.converged);
  EXPECT_LT(largest_distance(from_nonsense.u, from_rest.u), tolerance);
}

/// Interpolated displacements do not change the volume of a split element, so the mean of its parts'
/// pressures is its own, up to roundoff of volumes, which are in single precision.
TEST(MixedBody, averages_to_the_pressures_of_the_mesh_before) {
  const CaseOnMesh column = case_named("column");
  const Scene coarse = make_scene(column), fine = make_scene(split(column, {0, 5, 60}));
  const NodalField u = static_answer(coarse, {"tl-mean-dilatation"}).u;
  const auto own_pressures = [](const Scene& scene, const NodalField& at, const std::vector<int>& means_of) {
    const Model model(scene, {"tl-mean-dilatation"});
    const auto& elements = *std::get<std::unique_ptr<InternalForce<double>>>(model.internal_force());
    MixedBody<double> body(model, elements);
    body.body().state() = state_at(elements, at);
    body.linearize();
    body.take_own_pressures();
    if (!means_of.empty()) body.average_pressures(means_of);
    return body.pressures();
  };
  const std::vector<int>& element_of = fine.coarser.front().element_of;
  const auto before = own_pressures(coarse, u, {});
  const auto after = own_pressures(fine, prolonged(fine.coarser.front(), u), element_of);
  const double lambda = lame_lambdas(coarse.materials).front();
  for (std::size_t e = 0; e < after.size(); ++e)
    EXPECT_NEAR(after[e], before[index(element_of[e])], 1e-6 * lambda) << e;
}

/// The answer before a split is a good guess for the answer after it, though parts of elements change their
/// volumes: the search takes less than half the evaluations of one from the undeformed shape.
TEST(Relax, starts_from_the_answer_on_the_mesh_before) {
  const CaseOnMesh column = case_named("column");
  const Scene coarse = make_scene(column);
  const NodalField u = static_answer(coarse, {"tl-mean-dilatation"}).u;
  const Scene fine = make_scene(split(column, largest_share(error_indicators(coarse, u), 0.6)));
  const NodalField guess = prolonged(fine.coarser.front(), u);
  const Model model(fine, {"tl-mean-dilatation"});
  Observer quiet;
  const Relaxation from_rest = relax(model, quiet), near = relax(model, quiet, nullptr, &guess);
  EXPECT_TRUE(near.converged);
  EXPECT_LT(2 * near.steps, from_rest.steps);
  EXPECT_LT(largest_distance(near.u, from_rest.u),
            10.0 * fine.settings.relaxation.tolerance * largest_imposed(fine));
}

/// Between half and twice the error against the stored truth, largest and mean, for an accurate and a poor
/// method. The truths' own errors are within a third of these errors.
TEST(TruthEstimate, is_about_the_error) {
  for (const auto* name : {"column", "twist", "stiff-core", "pressed-beam", "ellipsoid-touch"}) {
    const CaseOnMesh problem = case_named(name);
    const Scene scene = make_scene(problem);
    const NodalField truth = read_reference(read_comparison(scene).truth, scene).front();
    for (const auto* method : {"tl-mean-dilatation", "tl-perturbation"}) {
      const NodalField u = static_answer(scene, {method}).u;
      const Accuracy measured = accuracy(u, truth, nullptr, 1.0);
      const TruthEstimate estimate = estimate_truth_error(problem, 1, u);
      EXPECT_EQ(estimate.remark, "") << name;
      EXPECT_GT(estimate.elements, scene.mesh.cells.size()) << name;
      for (const double ratio :
           {estimate.largest / measured.max_relative_error, estimate.rms / measured.rms_relative_error}) {
        EXPECT_GT(ratio, 0.5) << name << " " << method;
        EXPECT_LT(ratio, 2.0) << name << " " << method;
      }
    }
  }
}

/// As many refinements as the accuracy needs, or none. Against the stored truth, whose uncertainty is 1e-4 of
/// the unit, errors are within the requested accuracy; the estimate is the distance from the limit.
TEST(RefineUntilWithin, refines_no_more_than_is_asked) {
  const CaseOnMesh problem = case_named("column");
  const Scene scene = make_scene(problem);
  const NodalField truth = read_reference(read_comparison(scene).truth, scene).front();
  std::size_t before = 0;
  for (const double accuracy : {0.02, 0.006, 0.003}) {
    const AccurateMesh found = refine_until_within(accuracy, problem, 1);
    const double unit = displacement_unit(scene, truth);
    EXPECT_EQ(found.scene.mesh_hash == scene.mesh_hash, accuracy == 0.02);
    EXPECT_GT(found.scene.mesh.cells.size(), before);
    EXPECT_EQ(found.limit.size(), scene.mesh.points.size());
    EXPECT_LE(largest_distance(found.limit, found.u), accuracy * unit);
    EXPECT_LE(largest_distance(truth, found.u), accuracy * unit);
    EXPECT_GT(largest_distance(truth, found.u), 0.1 * accuracy * unit);
    before = found.scene.mesh.cells.size();
  }
}

/// With a lower accuracy the search ends earlier, but within a fifth of the accuracy from the equilibrium on
/// its mesh: the residual, a tenth, leaves about that much displacement.
TEST(RefineUntilWithin, searches_as_long_as_the_accuracy_needs) {
  const AccurateMesh found = refine_until_within(0.1, case_named("ellipsoid-touch"), 1);
  const NodalField exact = static_answer(found.scene, {"tl-mean-dilatation"}).u;
  const double left = largest_distance(exact, found.u) / displacement_unit(found.scene, exact);
  EXPECT_LT(left, 0.2 * 0.1);
  EXPECT_GT(left, 1e-4);
}

TEST(RefineUntilWithin, says_how_near_it_came) {
  const auto message = [](double accuracy, const std::string& name, std::size_t most) {
    try {
      refine_until_within(accuracy, case_named(name), 1, most);
    } catch (const ComputationError& error) {
      return std::string(error.what());
    }
    return std::string("found");
  };
  EXPECT_NE(
      message(1e-3, "column", 200).find("the mesh of 270 elements is not refined further, and the error"),
      std::string::npos);
  EXPECT_NE(message(1e-3, "column", 300).find("it has more than 300 elements"), std::string::npos);
  EXPECT_NE(message(1e-3, "column", 300).find("%, not 0.1 %"), std::string::npos);
}

}  // namespace
}  // namespace sandglass::verification::truth_estimate_test
