#include "benchmark/stepped_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "benchmark/condensed_model.hpp"
#include "benchmark/work.hpp"
#include "forces/contact_force.hpp"
#include "problem/make_scene.hpp"
#include "solve/adaption.hpp"
#include "solve/health.hpp"
#include "solve/leapfrog.hpp"
#include "solve/resident.hpp"

namespace sandglass {

namespace {

constexpr double relative_height = 0.03;  ///< of the waves, in element sizes

template <class Real>
class SteppedModelOf final : public SteppedModel {
 public:
  SteppedModelOf(const Scene& scene, const MethodChoice& choice, const OwnMotion* motion)
      : moving_(moving(scene)),
        model_(moving_ ? *moving_ : scene, choice),
        elements_(*std::get<std::unique_ptr<InternalForce<Real>>>(model_.internal_force())),
        leapfrog_(model_, elements_, 0.0),
        resident_(resident_motion(model_, elements_, leapfrog_)) {
    const double imposed = largest_imposed(scene);
    if (imposed > 0.0) loading_ = relative_height * element_size(scene) / imposed;
    const bool arrived = motion != nullptr && !motion->end.empty();
    if (arrived) loading_ = 1.0;
    Body<Real>& body = leapfrog_.body();
    body.state() = state_at(elements_, arrived ? motion->end : wavy_field(scene));
    body.impose(loading_);
    Adaption<Real>(model_, body).apply(body, Demotion::never);
    body.evaluate_forces();
    Rows<Real>& increment = body.state().increment;
    std::fill(increment.begin(), increment.end(), Row<Real>{});  // zero velocity
    starts_.assign(1, body.state());
    if (arrived && !motion->levels.empty()) set_levels(motion->levels);
    constexpr double step_fraction = 0.9, damping = 0.02;  // over the stable step; c dt / 2
    step_size_ = step_fraction * leapfrog_.stable_step(model_).step;
    coefficients_ = {(1.0 - damping) / (1.0 + damping), step_size_ * step_size_ / (1.0 + damping)};
    numbers_ = {
        coefficients_.keep, coefficients_.gain, step_size_, body.factors_of_loads(loading_, loading_), {}};
    for (const double angle : scene.angles) numbers_.angles.push_back({path_terms(angle, loading_), {}, {}});
  }

  NodalField forces() override { return forces_on_the_way(elements_, wavy_field(model_.scene())); }

  std::size_t states() const override { return starts_.size(); }

  void restart(std::size_t state) override {
    leapfrog_.body().state() = starts_[state];
    leapfrog_.body().evaluate_forces();
    if (resident_ != nullptr) resident_->begin(leapfrog_.body(), {});
  }

  void step() override {
    if (resident_ != nullptr) return resident_->add(numbers_);
    leapfrog_.take(step_size_, coefficients_, [this](Body<Real>& body) { body.impose(loading_, loading_); });
  }

  void finish() override {
    if (resident_ != nullptr) resident_->finish();
  }

  void check() override {
    require_healthy();
    stable_step_ = leapfrog_.stable_step(model_).step;
  }

  void require_healthy() override {
    if (resident_ != nullptr) {
      std::vector<double> none;
      resident_->bring(leapfrog_.body(), loading_, loading_, none, none);
    }
    try {
      sandglass::require_healthy(leapfrog_.body(), 0);
    } catch (const ComputationError& error) {
      throw ComputationError(fmt::format("bench of {} with {}: the initial waves were too large: {}",
                                         model_.scene().settings.name, model_.choice().method, error.what()));
    }
  }

  Work work() const override {
    const Mesh& mesh = model_.scene().mesh;
    Work work = work_of(model_.choice(), model_.scene().materials.list.front().law, elements_.layout(), mesh);
    if (resident_ != nullptr) {
      const auto bytes = static_cast<double>(resident_->step_traffic().bytes);
      work.bytes = bytes / static_cast<double>(mesh.cells.size());
    }
    return work;
  }

 private:
  /// A static scene whose contacts have other forces in motions, with those.
  static std::optional<Scene> moving(const Scene& scene) {
    const auto changes = [](const ContactForce* contact) { return contact->in_motion() != nullptr; };
    if (std::ranges::none_of(contacts_of(scene.forces), changes)) return std::nullopt;
    return in_motion(scene);
  }

  /// Starts with other levels of the elements instead of the current ones.
  void set_levels(const std::vector<std::vector<double>>& levels) {
    starts_.assign(levels.size(), starts_.front());
    for (std::size_t n = 0; n < levels.size(); ++n) elements_.set_levels(starts_[n], levels[n]);
  }

  const std::optional<Scene> moving_;
  const Model model_;
  const InternalForce<Real>& elements_;
  Leapfrog<Real> leapfrog_;
  std::vector<State<Real>> starts_;
  double loading_ = 0.0;
  double step_size_ = 0.0, stable_step_ = 0.0;
  LeapfrogClock::Coefficients coefficients_{};
  std::unique_ptr<ResidentMotion<Real>> resident_;  // null: steps are taken here
  ResidentStep numbers_{};
};

}  // namespace

template <class Real>
NodalField forces_on_the_way(const InternalForce<Real>& elements, const NodalField& field) {
  State<Real> state = elements.undeformed();
  Rows<Real> force(state.u.size());
  for (const double share : {0.3, 0.7, 1.0}) {
    NodalField part = field;
    for (auto& u : part) {
      for (double& component : u) component *= share;
    }
    Rows<Real> u = to_rows<Real>(part, elements.layout());
    for (std::size_t r = 0; r < u.size(); ++r) {
      for (std::size_t i = 0; i < 3; ++i) state.increment[r][i] = u[r][i] - state.u[r][i];
    }
    state.u = std::move(u);
    elements.evaluate(state, force);
  }
  return to_field(force, elements.layout());
}

template NodalField forces_on_the_way(const InternalForce<double>&, const NodalField&);
template NodalField forces_on_the_way(const InternalForce<float>&, const NodalField&);

Scene box_scene(int elements, Shapes shapes) {
  const int edge = std::max(1, static_cast<int>(std::lround(std::cbrt(elements))));
  const int height =
      std::max(1, static_cast<int>(std::lround(static_cast<double>(elements) / (edge * edge))));
  constexpr double width = 0.1;
  const double z = width * height / edge;
  Case description;
  description.name = shapes == Shapes::any ? "box" : "cubes";
  description.file = description.name;
  description.mesh = BoxMesh{{width, width, z}, {edge, edge, height}};
  description.materials.front().law = NeoHookean{.young_modulus = 3000.0, .poisson_ratio = 0.49};
  description.materials.front().density = 1000.0;
  description.sets = {{.name = "foot", .within = {{{}, {}, Interval{0.0, 0.0}}}},
                      {.name = "head", .within = {{{}, {}, Interval{z, z}}}}};
  description.displacements = {{.set = "foot"}, {.set = "head", .value = {0.0, 0.0, -0.1 * z}}};
  Mesh mesh = generate_mesh(std::get<AnyGenerator>(description.mesh));
  if (shapes == Shapes::any) {
    const double size = width / edge;
    const Vector far{width, width, z};
    for (std::size_t n = 0; n < mesh.points.size(); ++n) {
      Vector& X = mesh.points[n];
      for (std::size_t i = 0; i < 3; ++i) {
        const bool inside = X[i] > 0.5 * size && X[i] < far[i] - 0.5 * size;
        if (inside) X[i] += 0.1 * size * std::sin(static_cast<double>(7 * n + 3 * i));
      }
    }
  }
  return make_scene(description, std::move(mesh));
}

double element_size(const Scene& scene) {
  double smallest = std::numeric_limits<double>::infinity();  // squared
  for (const auto& cell : scene.mesh.cells) {
    const NodalVectors<double> X = gather(scene.mesh.points, cell);
    for (int I = 0; I < X.rows; ++I) {
      for (int J = 0; J < I; ++J) {
        const double x = X(I, 0) - X(J, 0), y = X(I, 1) - X(J, 1), z = X(I, 2) - X(J, 2);
        smallest = std::min(smallest, x * x + y * y + z * z);
      }
    }
  }
  return std::sqrt(smallest);
}

NodalField wavy_field(const Scene& scene) {
  const double h = element_size(scene);
  // Lengths without a common multiple with each other or the mesh: every element is strained.
  const double k = 2.0 * std::numbers::pi / h;
  const std::array<Vector, 3> waves{Vector{k / 3.7, k / 5.3, k / 4.1}, Vector{k / 4.7, k / 3.3, k / 6.1},
                                    Vector{k / 5.9, k / 4.3, k / 3.1}};
  NodalField u;
  u.reserve(scene.mesh.points.size());
  for (const Vector& X : scene.mesh.points) {
    Vector& value = u.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector& wave = waves[i];
      value[i] = relative_height * h *
                 std::sin(wave[0] * X[0] + wave[1] * X[1] + wave[2] * X[2] + static_cast<double>(i));
    }
  }
  return u;
}

std::unique_ptr<SteppedModel> make_stepped_model(const Scene& scene, const MethodChoice& choice,
                                                 const OwnMotion* motion) {
  if (method_named(choice.method).is_condensed) return make_condensed_model(scene, choice);
  if (choice.precision == Precision::double_precision) {
    return std::make_unique<SteppedModelOf<double>>(scene, choice, motion);
  }
  return std::make_unique<SteppedModelOf<float>>(scene, choice, motion);
}

}  // namespace sandglass
