#include "comparison/answer.hpp"

#include "base/error.hpp"
#include "solve/relaxation.hpp"

namespace sandglass {

namespace {

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

}  // namespace

Answer equilibrium_answer(const Model& model, Observer& observer) {
  Relaxation relaxation = relax(model, observer);
  Answer answer{.u = std::move(relaxation.u),
                .energy = relaxation.energies.strain + relaxation.energies.hourglass,
                .steps = relaxation.steps};
  if (in_equilibrium(relaxation, model.choice().precision)) return answer;
  answer.failure = Finding::not_at_rest;
  answer.status = outcome(relaxation, model.choice().precision);
  return answer;
}

Answer equilibrium_answer(const Scene& scene, const MethodChoice& choice, Observer& observer) {
  return answer_of([&] { return equilibrium_answer(Model(scene, choice), observer); });
}

Answer answer_of(const std::function<Answer()>& find) {
  try {
    return find();
  } catch (const ComputationError& error) {
    return {.failure = finding_of(error.breakdown()), .status = first_line(error.what())};
  } catch (const InputError& error) {
    return {.refused = true, .status = first_line(error.what())};
  }
}

}  // namespace sandglass
