#include "benchmark/condensed_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "solve/condensed_response.hpp"

namespace sandglass {

namespace {

template <class Real>
class CondensedModelOf final : public SteppedModel {
 public:
  CondensedModelOf(const Scene& scene, const MethodChoice& choice)
      : model_(scene, choice),
        response_(model_, handles_of_sets(scene), all_nodes(scene)),
        d_(final_displacements(scene, handles_of_sets(scene))),
        f_(d_.size()),
        u_(scene.mesh.points.size()) {}

  NodalField forces() override {
    const auto& elements = *std::get<std::unique_ptr<InternalForce<Real>>>(model_.internal_force());
    return forces_on_the_way(elements, wavy_field(model_.scene()));
  }

  void restart(std::size_t /*state*/) override {}

  void step() override {
    response_.displacements(d_, u_, model_.choice().threads);
    response_.forces(d_, f_);
  }

  void check() override {}

  void require_healthy() override {
    const auto finite = [](const auto& u) {
      return std::all_of(u.begin(), u.end(), [](auto component) { return std::isfinite(component); });
    };
    if (std::all_of(u_.begin(), u_.end(), finite)) return;
    throw ComputationError(fmt::format("bench of {} with {}: displacements are not finite",
                                       model_.scene().settings.name, model_.choice().method));
  }

  Work work() const override {
    const auto elements = static_cast<double>(model_.scene().mesh.cells.size());
    return {response_.operations() / elements, response_.bytes() / elements};
  }

 private:
  Model model_;
  CondensedResponse<Real> response_;
  std::vector<Vector> d_;
  std::vector<Vector> f_;
  std::vector<typename CondensedResponse<Real>::Displacement> u_;
};

}  // namespace

std::unique_ptr<SteppedModel> make_condensed_model(const Scene& scene, const MethodChoice& choice) {
  if (choice.precision == Precision::double_precision) {
    return std::make_unique<CondensedModelOf<double>>(scene, choice);
  }
  return std::make_unique<CondensedModelOf<float>>(scene, choice);
}

}  // namespace sandglass
