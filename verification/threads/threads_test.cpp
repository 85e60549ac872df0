/// Every loop that threads share, for the thread sanitizer: elements of every method, the steppers' passes
/// over rows, the preconditioner, superposition, and simultaneous runs on one scene. The results must also
/// have the same bits as one thread, which shows that every loop runs.

#include <gtest/gtest.h>

#include <thread>

#include "solve/central_difference.hpp"
#include "solve/relaxation.hpp"
#include "support/plates.hpp"
#include "support/typed_lists.hpp"

namespace sandglass::verification {
namespace {

/// A block long enough to be divided.
Scene block(const AnyLaw& law, bool quasi_static) {
  Case description = plain_case(law);
  description.relaxation.max_steps = 8;
  return make_scene(block_between_plates(std::move(description), quasi_static, {4, 4, 18}));
}

template <class Method>
class ThreadsTest : public ::testing::Test {
 protected:
  static NodalField answer(const Scene& scene, int threads) {
    Observer silent;
    const Model model(scene, {.method = std::string(Method::name), .threads = threads});
    return scene.settings.quasi_static ? relax(model, silent).u : integrate(model, silent).u;
  }

  template <class Law>
  static void expect_same(bool quasi_static) {
    const Scene scene = block(sample_law<Law>(0.45), quasi_static);
    const Model model(scene, {.method = std::string(Method::name)});
    ASSERT_GE(std::get<0>(model.internal_force())->layout().chunks.size(), 4U) << "too few to share out";
    EXPECT_EQ(answer(scene, 3), answer(scene, 1));
  }
};

TYPED_TEST_SUITE(ThreadsTest, MethodTypes, EntryName);

TYPED_TEST(ThreadsTest, relaxation) {
  this->template expect_same<NeoHookean>(true);
}

TYPED_TEST(ThreadsTest, motion) {
  if constexpr (!is_condensed<TypeParam>) this->template expect_same<NeoHookean>(false);
}

TYPED_TEST(ThreadsTest, motion_with_a_law_that_remembers) {
  if constexpr (!is_condensed<TypeParam> && knows_law<TypeParam, Viscoelastic<NeoHookean>>) {
    this->template expect_same<Viscoelastic<NeoHookean>>(false);
  }
}

/// As in `sandglass verify`: each runs alone, on the common scene and model.
TEST(Threads, share_a_model) {
  const Scene scene = block(sample_law<NeoHookean>(0.45), true);
  const Model model(scene, {.method = "tl-perturbation"});
  std::vector<NodalField> answers(3);
  {
    std::vector<std::jthread> threads;
    for (auto& answer : answers) {
      threads.emplace_back([&] {
        Observer silent;
        answer = relax(model, silent).u;
      });
    }
  }
  EXPECT_EQ(answers[0], answers[1]);
  EXPECT_EQ(answers[0], answers[2]);
}

}  // namespace
}  // namespace sandglass::verification
