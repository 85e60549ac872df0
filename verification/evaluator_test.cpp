/// The evaluation of a candidate: the reserve of load, the reasons of rejection, the errors of references.

#include <gtest/gtest.h>

#include "choice/choose.hpp"
#include "comparison/answer.hpp"
#include "io/case_file.hpp"
#include "support/cantilever.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::evaluator_test {
namespace {

namespace fs = std::filesystem;

/// A cube whose middle is pushed in from above.
Case pushed_cube(double depth) {
  Case description = plain_case(NeoHookean{.young_modulus = 3000.0, .poisson_ratio = 0.3});
  description.mesh = BoxMesh{{1.0, 1.0, 1.0}, {4, 4, 4}};
  NodeSetRule middle = plane("middle", 2, 1.0);
  middle.within[0] = middle.within[1] = Interval{0.25, 0.75};
  description.sets = {plane("foot", 2, 0.0), middle};
  description.displacements = {{"foot", {}}, {"middle", {0.0, 0.0, -depth}}};
  return description;
}

bool go_on(double /*share*/) {
  return true;
}

/// The evaluator with one method on the user's mesh.
class EvaluatorTest : public ::testing::Test {
 protected:
  Evaluation evaluated(const Case& description, const MethodChoice& choice, double tolerance) {
    const Scene scene = scene_of_case(description);
    const Proceed proceed = go_on;
    const Reference reference = make_reference(scene, "", proceed);
    const CandidateMesh own = own_mesh(description, reference.u);
    return Evaluator(scene, reference, tolerance, proceed).evaluate({choice, &own});
  }

  static bool inverts(const Case& description) {
    Observer silent;
    return compute_answer(scene_of_case(description), {"linear-condensed"}, silent).failure ==
           Finding::inverted;
  }
};

/// With small strains, elements under a pressed node turn inside out at some depth, which the golden's
/// element survives: beyond 1/1.1 of that depth there is no reserve, before it there is.
TEST_F(EvaluatorTest, asks_for_a_reserve_of_load) {
  double low = 0.0, high = 1.0;
  ASSERT_TRUE(inverts(pushed_cube(high)));
  for (int n = 0; n < 12; ++n) {
    const double middle = 0.5 * (low + high);
    (inverts(pushed_cube(middle)) ? high : low) = middle;
  }
  const Evaluation near = evaluated(pushed_cube(low / 1.09), {"linear-condensed"}, 10.0);
  EXPECT_TRUE(contains(near.reason, "no reserve: with a tenth more load an element turns inside out"));
  ASSERT_TRUE(near.smallest_jacobian);
  EXPECT_GT(*near.smallest_jacobian, 0.0);
  EXPECT_EQ(evaluated(pushed_cube(low / 1.11), {"linear-condensed"}, 10.0).reason, "");
}

/// A body pressed to a twentieth of its length along x, and held otherwise, cannot be pressed by another
/// tenth with any method: no candidate needs a reserve that the golden's element does not have.
TEST_F(EvaluatorTest, asks_nobody_for_what_the_golden_has_not) {
  Case description = cantilever(0.0);
  description.displacements[1].value = {-0.95, 0.0, 0.0};
  description.sets.push_back({.name = "all"});
  description.displacements.push_back({.set = "all", .components = {false, true, true}});
  description.relaxation.max_steps = 2000;
  const Scene scene = scene_of_case(description);
  const Proceed proceed = go_on;
  const Reference reference{"none", {NodalField(scene.mesh.points.size())}, 1.0, {}};
  const CandidateMesh own = own_mesh(description, reference.u);
  Evaluator evaluator(scene, reference, 10.0, proceed);
  const Evaluation found = evaluator.evaluate({{.method = "linear-condensed"}, &own});
  EXPECT_EQ(found.reason, "");
  EXPECT_NEAR(found.smallest_jacobian.value_or(0.0), 0.05, 1e-9);
}

/// Full integration locks as Poisson's ratio nears one half; a tiny kappa lets nodes zigzag.
TEST_F(EvaluatorTest, names_locking_and_hourglassing) {
  Case description = cantilever(0.2);
  std::get<NeoHookean>(description.materials.front().law).poisson_ratio = 0.4999;
  EXPECT_TRUE(contains(evaluated(description, {"tl-full"}, 0.01).reason, "locks"));
  EXPECT_TRUE(contains(evaluated(cantilever(0.2), {"tl-perturbation", 1e-5}, 0.01).reason, "nodes zigzag"));
}

/// A truth with an error of a percent cannot show that another error is within a tenth of that.
TEST(Reference, that_is_stored_has_its_own_error) {
  const CaseOnMesh problem = with_mesh(read_case_file(fs::path(SANDGLASS_SOURCE) / "cases" / "column.toml"));
  const Scene scene = make_scene(problem);
  const Reference truth = make_reference(scene, "truth", go_on);
  ASSERT_TRUE(truth.own.largest);
  EXPECT_GT(*truth.own.largest, 1e-5);
  EXPECT_LT(*truth.own.largest, 0.01);
  EXPECT_EQ(truth.unit, largest_imposed(scene));
  const Reference computed = make_reference(scene, "", go_on),
                  golden = make_reference(scene, "golden", go_on);
  // The error of the others is their distance from this truth.
  EXPECT_EQ(*golden.own.largest, accuracy(golden.u, truth.u, nullptr, golden.unit).max_relative_error);
  EXPECT_LT(largest_distance(computed.u.front(), golden.u.front()), 1e-6 * golden.unit);
  EXPECT_NEAR(*computed.own.largest, *golden.own.largest, 1e-6);  // by the triangle inequality
  Demand demand{.tolerance = 0.5 * *truth.own.largest, .against = "truth", .methods = {"tl-mean-dilatation"}};
  const Choice choice = choose(problem, demand, [](double, const std::string&) { return true; });
  EXPECT_FALSE(choice.chosen);
  EXPECT_TRUE(contains(remarks(choice).front(), "smaller errors cannot be shown"));
  EXPECT_TRUE(contains(remarks(choice).back(), "no method can be more accurate"));
}

}  // namespace
}  // namespace sandglass::verification::evaluator_test
