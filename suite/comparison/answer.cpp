#include "comparison/answer.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "comparison/reference_file.hpp"
#include "forces/contact_force.hpp"
#include "solve/central_difference.hpp"
#include "solve/relaxation.hpp"

namespace sandglass {

namespace {

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

/// Keeps the displacements at some times and the last energies, and of a scene with contact the reactions at
/// all checks; asks another observer whether to continue.
class Sampler final : public Observer {
 public:
  Sampler(std::vector<double> times, const Scene& scene, Observer& other)
      : times_(std::move(times)), has_contact_(!contacts_of(scene.forces).empty()), other_(other) {}

  double next_sample() const override {
    return u.size() < times_.size() ? times_[u.size()] : Observer::next_sample();
  }
  void sample(const NodalField& now) override { u.push_back(now); }
  void history(const HistoryRow& row) override {
    energies = {row.strain, row.hourglass};
    if (has_contact_) checks.push_back({row.time, row.reactions});
  }
  void at_load(double factor) override { other_.at_load(factor); }
  bool proceed(long step, double share, double residual) override {
    return other_.proceed(step, share, residual);
  }

  Displacements u;
  StrainEnergies energies;
  std::vector<ReactionsAt> checks;

 private:
  std::vector<double> times_;
  bool has_contact_;
  Observer& other_;
};

Answer moving_answer(const Model& model, Observer& observer) {
  Sampler sampler(answer_times(model.scene().settings), model.scene(), observer);
  const Motion motion = integrate(model, sampler);
  return {.u = std::move(sampler.u),
          .energies = sampler.energies,
          .checks = std::move(sampler.checks),
          .steps = motion.steps,
          .seconds = motion.seconds};
}

Answer resting_answer(const Model& model, Observer& observer) {
  Sampler sampler({}, model.scene(), observer);
  Relaxation relaxation = relax(model, sampler);
  Answer answer{.energies = relaxation.energies,
                .checks = std::move(sampler.checks),
                .steps = relaxation.steps,
                .residual = relaxation.residual,
                .seconds = relaxation.seconds};
  if (!relaxation.u.empty()) answer.u = {std::move(relaxation.u)};  // empty: none at the first load level
  if (in_equilibrium(relaxation)) return answer;
  answer.failure = Finding::no_equilibrium;
  answer.status = outcome(relaxation, model.choice().precision);
  return answer;
}

}  // namespace

Answer compute_answer(const Model& model, Observer& observer) {
  return model.scene().settings.quasi_static ? resting_answer(model, observer)
                                             : moving_answer(model, observer);
}

Answer compute_answer(const Scene& scene, const MethodChoice& choice, Observer& observer) {
  return answer_of([&] { return compute_answer(Model(scene, choice), observer); });
}

double displacement_unit(const Scene& scene, const Displacements& reference) {
  double unit = 0.0;
  for (const NodalField& u : reference) unit = std::max(unit, displacement_unit(scene, u));
  return unit;
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
