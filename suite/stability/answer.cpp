#include "stability/answer.hpp"

#include "base/error.hpp"
#include "solve/central_difference.hpp"
#include "solve/relaxation.hpp"

namespace sandglass {

namespace {

/// Keeps the energy of the last row.
class EnergyObserver final : public Observer {
 public:
  void history(const HistoryRow& row) override { energy = row.strain + row.hourglass; }

  double energy = 0.0;
};

Answer resting_answer(const Model& model, Observer& observer) {
  Relaxation relaxation = relax(model, observer);
  Answer answer{.u = std::move(relaxation.u),
                .energy = relaxation.energies.strain + relaxation.energies.hourglass,
                .steps = relaxation.steps};
  if (in_equilibrium(relaxation, model.choice().precision)) return answer;
  answer.failure = Finding::not_at_rest;
  answer.status = outcome(relaxation, model.choice().precision);
  return answer;
}

Answer moving_answer(const Model& model) {
  EnergyObserver observer;
  Motion motion = integrate(model, observer);
  return {.u = std::move(motion.u), .energy = observer.energy, .steps = motion.steps};
}

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

/// What `find` finds, or what went wrong.
template <class Find>
Answer found_by(const Find& find) {
  try {
    return find();
  } catch (const ComputationError& error) {
    return {.failure = finding_of(error.breakdown()), .status = first_line(error.what())};
  } catch (const InputError& error) {
    return {.refused = true, .status = first_line(error.what())};
  }
}

}  // namespace

Answer answer_at_rest(const Scene& scene, const MethodChoice& choice, Observer& observer) {
  return found_by([&] { return resting_answer(Model(scene, choice), observer); });
}

Answer compute(const Trial& trial) {
  return found_by([&] {
    const Scene scene = scene_of(trial);
    const Model model(scene, trial.choice);
    Observer silent;
    return trial.is_dynamic() ? moving_answer(model) : resting_answer(model, silent);
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
