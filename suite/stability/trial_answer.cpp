#include "stability/trial_answer.hpp"

namespace sandglass {

Answer compute(const Trial& trial) {
  return answer_of([&] {
    const Scene scene = scene_of(trial);
    const Model model(scene, trial.choice);
    Observer silent;
    return compute_answer(model, silent);
  });
}

std::shared_ptr<const Answer> Answers::of(const Trial& trial) {
  std::promise<std::shared_ptr<const Answer>> promise;
  std::shared_future<std::shared_ptr<const Answer>> known;
  {
    const std::lock_guard lock(mutex_);
    const auto [place, first] = known_.try_emplace(key_of(trial), promise.get_future().share());
    if (!first) known = place->second;
  }
  if (known.valid()) return known.get();
  auto answer = std::make_shared<const Answer>(compute(trial));
  promise.set_value(answer);
  return answer;
}

}  // namespace sandglass
