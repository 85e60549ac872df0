#include "sandglass/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/names.hpp"
#include "io/case_file.hpp"
#include "sandglass/mesh_arrays.hpp"
#include "solve/adaption.hpp"
#include "solve/leapfrog.hpp"
#include "solve/relaxation.hpp"

namespace sandglass {

namespace {

/// A driven component of a set.
struct Driven {
  std::size_t constraint;  ///< into those of the scene
  std::size_t node;        ///< into those of the set
  std::size_t component;
};

using DrivenSets = std::map<std::string, std::vector<Driven>>;

DrivenSets driven_sets(const Scene& scene) {
  DrivenSets driven;
  const auto& constraints = scene.constraints;
  for (const auto& [name, nodes] : scene.sets) {
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      const auto first = std::lower_bound(constraints.begin(), constraints.end(), nodes[n],
                                          [](const Constraint& c, int node) { return c.node < node; });
      for (auto c = first; c != constraints.end() && c->node == nodes[n]; ++c) {
        driven[name].push_back({static_cast<std::size_t>(std::distance(constraints.begin(), c)), n,
                                static_cast<std::size_t>(c->component)});
      }
    }
  }
  return driven;
}

template <class Sets>
const typename Sets::mapped_type& find(const Sets& sets, const std::string& name, const char* rule) {
  const auto found = sets.find(name);
  if (found != sets.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [set, entry] : sets) known.push_back(set);
  throw InputError(fmt::format("set '{}' {}; {}", name, rule, suggestion(name, known)));
}

void require_in_range(const char* name, double value, const Range& range) {
  if (!range.contains(value))
    throw InputError(fmt::format("{} = {} must be in {}", name, value, range.text()));
}

MethodChoice choice_of(const Case& description, const SimulationSettings& settings, Precision precision) {
  require_in_range("step_fraction", settings.step_fraction, {.low = 0.0, .high = 1.0, .high_open = false});
  require_in_range("damping", settings.damping.value_or(0.0), Range::at_least(0.0));
  MethodChoice choice = method_of(description, settings.method);
  if (settings.kappa) choice.kappa = settings.kappa;
  choice.precision = precision;
  choice.threads = settings.threads;
  return choice;
}

/// What does not change: a simulation shares it with its copies.
struct Problem {
  Problem(Scene the_scene, const SimulationSettings& settings, Precision precision)
      : scene(std::move(the_scene)),
        model(scene, choice_of(scene.description, settings, precision)),
        driven(driven_sets(scene)) {
    require_steps(model);
  }

  const Scene scene;
  const Model model;
  const DrivenSets driven;
};

}  // namespace

template <class Real>
class Simulation<Real>::Parts {
 public:
  Parts(Scene the_scene, const SimulationSettings& settings)
      : problem_(std::make_shared<const Problem>(
            std::move(the_scene), settings,
            std::is_same_v<Real, double> ? Precision::double_precision : Precision::single_precision)),
        leapfrog_(problem_->model, elements(),
                  settings.damping.value_or(scene().description.dynamics.damping)),
        adaption_(problem_->model, body()),
        step_fraction_(settings.step_fraction),
        from_(scene().constraints.size(), 0.0),
        to_(from_),
        imposed_(from_),
        terms_(scene().angles.size()) {
    choose_step();
    leapfrog_.body().evaluate_forces();
    leapfrog_.set_initial_velocities(scene().initial_velocities);
  }

  const Scene& scene() const { return problem_->scene; }
  const Body<Real>& body() const { return leapfrog_.body(); }
  double time() const { return leapfrog_.time(); }
  double step_size() const { return step_size_; }

  const std::vector<Driven>& driven(const std::string& set) const {
    return find(problem_->driven, set, "has no driven node: the case imposes no displacement to it");
  }

  /// `displacement(n)` is that of the n-th node of the set.
  template <class Displacement>
  void move(const std::string& set, const Displacement& displacement) {
    const std::vector<Driven>& components = driven(set);
    for (const auto& [constraint, node, component] : components) {
      require_in_range("displacement", displacement(node)[component], Range::any());
    }
    for (const auto& [constraint, node, component] : components) {
      to_[constraint] = displacement(node)[component];
    }
  }

  void impose(double factor) {
    require_in_range("factor", factor, Range::any());
    factor_to_ = factor;
    for (std::size_t m = 0; m < terms_.size(); ++m) terms_[m] = path_terms(scene().angles[m], factor);
    const auto& constraints = scene().constraints;
    for (std::size_t k = 0; k < to_.size(); ++k) {
      const ImposedPath& path = constraints[k].path;
      to_[k] = path.along(terms_[path.angle]);
    }
  }

  void advance(double seconds) {
    require_in_range("seconds", seconds, Range::positive());
    double left = seconds;
    while (left > 0.0) {
      constexpr double rounding = 1e-9;  // of a step: n steps of a size that was asked for are n steps
      const double steps = std::max(1.0, std::ceil(left / step_size_ - rounding));
      const double step = left / steps;
      left = steps > 1.0 ? left - step : 0.0;
      take(step, 1.0 - left / seconds);
    }
    arrive();
  }

  long settle() {
    const Scene present = scene_at_present();
    const Model model(present, problem_->model.choice());
    LevelsObserver observer;
    const Relaxation answer = relax(model, observer);
    if (!in_equilibrium(answer, model.choice().precision)) {
      throw ComputationError(fmt::format("no equilibrium: {} after {} evaluations, residual {:.1e}",
                                         outcome(answer, model.choice().precision), answer.steps,
                                         answer.residual));
    }
    Body<Real>& body = leapfrog_.body();
    State<Real> reached = state_at(elements(), answer.u);
    std::copy(reached.u.begin(), reached.u.end(), body.state().u.begin());  // views stay where they are
    reached.u.swap(body.state().u);
    body.state() = std::move(reached);
    elements().set_levels(body.state(), observer.levels);
    body.impose(to_, factor_to_, leapfrog_.time());
    body.evaluate_forces();
    std::fill(body.state().increment.begin(), body.state().increment.end(), Row<Real>{});
    arrive();
    choose_step();
    return answer.steps;
  }

 private:
  /// Keeps the levels of the elements of the last frame.
  struct LevelsObserver final : Observer {
    void frame(const Frame& frame) override { levels = frame.levels; }
    std::vector<double> levels;
  };

  const InternalForce<Real>& elements() const {
    return *std::get<std::unique_ptr<InternalForce<Real>>>(problem_->model.internal_force());
  }

  /// The scene whose full load is where driven nodes and forces are to be.
  Scene scene_at_present() const {
    Scene present = scene();
    present.angles = {0.0};
    std::map<int, Vector> displacements;  // of driven nodes
    for (std::size_t k = 0; k < to_.size(); ++k) {
      Constraint& constraint = present.constraints[k];
      constraint.path = {{to_[k]}};
      displacements[constraint.node][static_cast<std::size_t>(constraint.component)] = to_[k];
    }
    scale_load(present.description, factor_to_);
    present.description.rotations.clear();
    present.description.displacements.clear();
    for (const auto& [node, d] : displacements) present.description.displacements.push_back({"driven", d});
    const auto factor = [&](std::size_t curve) {
      return present.curves[curve].at(leapfrog_.time(), factor_to_);
    };
    for (auto& load : present.loads) {
      for (double& f : load.force) f *= factor(load.curve);
      load.curve = 0;
    }
    for (auto& pressure : present.pressures) {
      pressure.pressure *= factor(pressure.curve);
      pressure.curve = 0;
    }
    return present;
  }

  void arrive() {
    from_ = to_;
    factor_from_ = factor_to_;
  }

  /// A step that ends where a share of the way from `from_` to `to_` is gone.
  void take(double step, double share) {
    const double rest = 1.0 - share;
    if (rest > 0.0) {
      for (std::size_t k = 0; k < to_.size(); ++k) imposed_[k] = share * to_[k] + rest * from_[k];
    }
    const std::span<const double> imposed = rest > 0.0 ? imposed_ : to_;
    const double factor = share * factor_to_ + rest * factor_from_;
    leapfrog_.advance(step, [&](Body<Real>& body) { body.impose(imposed, factor, leapfrog_.time()); });
    if (leapfrog_.step() % scene().description.dynamics.check_interval == 0) check();
  }

  void check() {
    leapfrog_.body().require_healthy(leapfrog_.step());
    if (adaption_.active() && adaption_schedule_.due()) {
      const bool rose = adaption_.apply(leapfrog_.body(), Demotion::never).promoted > 0;
      if (rose) leapfrog_.body().evaluate_forces();
      adaption_schedule_.done(rose);
    }
    choose_step();
  }

  void choose_step() {
    step_size_ = step_fraction_ * leapfrog_.stable_step(problem_->model).step;
    leapfrog_.body().set_step(step_size_);
  }

  std::shared_ptr<const Problem> problem_;
  Leapfrog<Real> leapfrog_;
  Adaption<Real> adaption_;
  double step_fraction_;
  double step_size_ = 0.0;
  AdaptionSchedule adaption_schedule_;
  std::vector<double> from_, to_, imposed_;  // m, in the order of the scene's constraints
  std::vector<PathTerms> terms_;             // of paths of each angle
  double factor_from_ = 0.0, factor_to_ = 0.0;
};

template <class Real>
Simulation<Real>::Simulation(const std::filesystem::path& case_file, const SimulationSettings& settings)
    : parts_(std::make_unique<Parts>(read_scene(case_file), settings)) {}

template <class Real>
Simulation<Real>::Simulation(MeshArrays mesh, const std::string& case_text,
                             const SimulationSettings& settings)
    : parts_(std::make_unique<Parts>(read_scene(case_text, checked(std::move(mesh))), settings)) {}

template <class Real>
Simulation<Real>::Simulation(const Simulation& other) : parts_(std::make_unique<Parts>(*other.parts_)) {}

template <class Real>
Simulation<Real>::Simulation(Simulation&& other) noexcept = default;

template <class Real>
Simulation<Real>& Simulation<Real>::operator=(const Simulation& other) {
  parts_ = std::make_unique<Parts>(*other.parts_);
  return *this;
}

template <class Real>
Simulation<Real>& Simulation<Real>::operator=(Simulation&& other) noexcept = default;

template <class Real>
Simulation<Real>::~Simulation() = default;

template <class Real>
void Simulation<Real>::move(const std::string& set, const std::array<double, 3>& displacement) {
  parts_->move(set, [&](std::size_t /*node*/) { return displacement; });
}

template <class Real>
void Simulation<Real>::move(const std::string& set, std::span<const std::array<double, 3>> displacements) {
  if (displacements.size() != nodes(set).size()) {
    throw InputError(fmt::format("set '{}': {} displacements; it must be one for each of its {} nodes", set,
                                 displacements.size(), nodes(set).size()));
  }
  parts_->move(set, [&](std::size_t node) { return displacements[node]; });
}

template <class Real>
void Simulation<Real>::impose(double factor) {
  parts_->impose(factor);
}

template <class Real>
void Simulation<Real>::advance(double seconds) {
  parts_->advance(seconds);
}

template <class Real>
long Simulation<Real>::settle() {
  return parts_->settle();
}

template <class Real>
double Simulation<Real>::time() const {
  return parts_->time();
}

template <class Real>
double Simulation<Real>::step_size() const {
  return parts_->step_size();
}

template <class Real>
NodalView<Real> Simulation<Real>::displacements() const {
  static_assert(sizeof(Row<Real>) == NodalView<Real>::stride * sizeof(Real));
  return {numbers_of(parts_->body().state().u), parts_->body().layout().nodes};
}

template <class Real>
std::span<const int> Simulation<Real>::row_of_node() const {
  return parts_->body().layout().row_of_node;
}

template <class Real>
std::array<double, 3> Simulation<Real>::reaction(const std::string& set) const {
  std::array<double, 3> sum{};
  for (const auto& [constraint, node, component] : parts_->driven(set)) {
    sum[component] += parts_->body().reactions()[constraint];
  }
  return sum;
}

template <class Real>
std::span<const std::array<double, 3>> Simulation<Real>::points() const {
  return parts_->scene().mesh.points;
}

template <class Real>
std::span<const std::array<int, 8>> Simulation<Real>::cells() const {
  return parts_->scene().mesh.cells;
}

template <class Real>
std::span<const int> Simulation<Real>::nodes(const std::string& set) const {
  return find(parts_->scene().sets, set, "is not known");
}

template class Simulation<double>;
template class Simulation<float>;

}  // namespace sandglass
