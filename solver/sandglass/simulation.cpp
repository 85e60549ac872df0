#include "sandglass/simulation.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "base/names.hpp"
#include "io/case_file.hpp"
#include "io/checkpoint_file.hpp"
#include "mesh/hash.hpp"
#include "sandglass/device_steps.hpp"
#include "sandglass/driven_problem.hpp"
#include "solve/adaption.hpp"
#include "solve/health.hpp"
#include "solve/leapfrog.hpp"
#include "solve/relaxation.hpp"
#include "solve/stable_step.hpp"
#include "solve/steady_step.hpp"

namespace sandglass {

template <class Real>
class Simulation<Real>::Parts {
 public:
  Parts(Scene the_scene, const SimulationSettings& settings)
      : problem_(std::make_shared<const DrivenProblem>(std::move(the_scene), settings, precision_of<Real>)),
        leapfrog_(model(), elements(), problem_->damping()),
        device_steps_(model()),
        longest_step_(problem_->damping()),
        adaption_(model(), body()),
        from_(problem_->targets(), 0.0),
        to_(from_),
        imposed_(from_) {
    leapfrog_.subcycle(model());
    choose_step();
    leapfrog_.body().evaluate_forces();
    leapfrog_.set_initial_velocities(scene().initial_velocities);
    keep(StateCopy(whole_));
  }

  const DrivenProblem& problem() const { return *problem_; }
  const Scene& scene() const { return problem_->scene(); }
  const Body<Real>& body() const { return leapfrog_.body(); }
  double time() const { return leapfrog_.time(); }
  double step_size() const { return problem_->longest_step(longest_step_.step()); }

  template <class Displacement>
  void move(const std::string& set, const Displacement& displacement) {
    problem_->move(set, displacement, [&](std::size_t k, double u) { to_[k] = u; });
  }

  void impose(double factor) {
    problem_->impose(factor, [&](std::size_t k, double u) { to_[k] = u; });
    factor_to_ = factor;
  }

  void advance(double seconds) {
    require_in_range("seconds", seconds, Range::positive());
    const double end = time() + seconds;
    double whole = seconds, left = seconds;
    start_path();
    while (left > 0.0) {
      const double steps = steps_in(left, step_size());
      const double step = left / steps;
      left = steps > 1.0 ? left - step : 0.0;
      if (take(step, 1.0 - left / whole)) continue;
      from_ = imposed_;  // back at the last check, from which the path is straight
      factor_from_ = factor_;
      left = whole = end - time();
      start_path();
    }
    arrive();
  }

  long settle() {
    const Scene present = with_load(scene(), to_, time(), factor_to_);
    if (remember_path(present.forces)) {
      throw InputError(
          "settle: friction depends on the path so far, which is not searched again; allowed: "
          "contact without friction, or a damped motion");
    }
    const Model at_present(present, model().choice());
    LastFrame observer;
    const Relaxation answer = relax(at_present, observer);
    if (!in_equilibrium(answer)) {
      throw ComputationError(fmt::format("no equilibrium: {} after {} evaluations, residual {:.1e}",
                                         outcome(answer, model().choice().precision), answer.steps,
                                         answer.residual));
    }
    Body<Real>& body = leapfrog_.body();
    State<Real> reached = state_at(elements(), answer.u);
    std::copy(reached.u.begin(), reached.u.end(),
              body.state().u.begin());  // in place, so that views stay valid
    reached.u.swap(body.state().u);
    body.state() = std::move(reached);
    elements().set_levels(body.state(), observer.levels);
    body.impose(to_, factor_to_, leapfrog_.time());
    body.evaluate_forces();
    device_steps_.begin_anew();
    body.begin_again(observer.reactions, observer.moments);
    std::fill(body.state().increment.begin(), body.state().increment.end(), Row<Real>{});
    imposed_ = to_;
    factor_ = factor_to_;
    arrive();
    choose_step();
    keep(StateCopy(whole_));
    return answer.steps;
  }

  void save(const std::filesystem::path& file) {
    RunSoFar run;
    keep(CheckpointWriter(run.point));
    keep_targets(CheckpointWriter(run.point));
    write_checkpoint_file(file, identity(), run);
  }

  void resume(const std::filesystem::path& file) {
    const Mesh& mesh = scene().mesh;
    const RunSoFar run = read_checkpoint_file(file, identity(), mesh.points.size(), mesh.cells.size());
    keep(CheckpointReader(run.point));
    keep_targets(CheckpointReader(run.point));
    device_steps_.begin_anew();
    leapfrog_.body().set_step(step_size());
    keep(StateCopy(whole_));
  }

 private:
  /// Keeps the levels of the elements and the reactions of the last frame.
  struct LastFrame final : Observer {
    void frame(const Frame& frame) override {
      levels = frame.levels;
      reactions = frame.reactions;
      moments = frame.moments;
    }
    std::vector<double> levels;
    Reactions reactions, moments;
  };

  const Model& model() const { return problem_->model(); }

  const InternalForce<Real>& elements() const {
    return *std::get<std::unique_ptr<InternalForce<Real>>>(model().internal_force());
  }

  void arrive() {
    from_ = to_;
    factor_from_ = factor_to_;
  }

  /// Starts steps on the straight path from `from_` to `to_`.
  void start_path() {
    if (device_steps_.active()) device_steps_.start(leapfrog_, from_, to_);
  }

  /// A step to a share of the path from `from_` to `to_`. False if steps proved too long: the state is back
  /// at the last check, and steps are shorter from there.
  bool take(double step, double share) {
    const double rest = 1.0 - share;
    for (std::size_t k = 0; k < to_.size(); ++k) imposed_[k] = share * to_[k] + rest * from_[k];
    factor_ = share * factor_to_ + rest * factor_from_;
    if (device_steps_.active()) {
      const auto coefficients = leapfrog_.tick(step);
      device_steps_.add(coefficients, step, share, body().factors_of_loads(time(), factor_));
    } else {
      leapfrog_.advance(step, [&](Body<Real>& body) { body.impose(imposed_, factor_, leapfrog_.time()); });
    }
    const bool last = !(share < 1.0), due = leapfrog_.step() % scene().settings.dynamics.check_interval == 0;
    if (device_steps_.active() && (last || due)) device_steps_.bring(leapfrog_.body(), factor_, time());
    const bool doubtful = last && (!is_finite(body()) || body().touch().passed >= 0);
    return !(due || doubtful) || check();
  }

  /// False as in `take`.
  bool check() {
    const bool healthy = device_steps_.active() ? device_steps_.is_healthy() : is_healthy(body());
    if (!healthy && longest_step_.may_shorten()) {
      go_back();
      longest_step_.shorten();
      leapfrog_.body().set_step(step_size());
      keep(StateCopy(whole_));
      return false;
    }
    try {
      if (!healthy) require_healthy(leapfrog_.body(), leapfrog_.step());
      require_not_passed(body().touch(), scene().mesh.points, "step", static_cast<double>(leapfrog_.step()));
      if (adaption_.active() && adaption_schedule_.due()) {
        const bool rose = adaption_.apply(leapfrog_.body(), Demotion::never).promoted > 0;
        if (rose) leapfrog_.body().evaluate_forces();
        adaption_schedule_.done(rose);
      }
      choose_step();
    } catch (const ComputationError& error) {
      fail(error);
    }
    keep(StateCopy(whole_));
    return true;
  }

  /// Returns to the last sound state.
  void go_back() {
    keep(StateCopy(std::as_const(whole_)));
    device_steps_.begin_anew();
  }

  /// Returns to the last sound state and throws the error of the present one.
  [[noreturn]] void fail(const ComputationError& error) {
    const double failed = time();
    go_back();
    leapfrog_.body().set_step(step_size());
    to_ = imposed_;
    factor_to_ = factor_;
    arrive();
    throw ComputationError(fmt::format("at {:.6g} s, {}\nthe simulation is back at {:.6g} s, when all "
                                       "elements were sound, with the driven nodes and forces of that time",
                                       failed, error.what(), time()),
                           error.breakdown());
  }

  /// The data that the next step depends on; see checkpoint.hpp.
  template <class Archive>
  void keep(Archive archive) {
    leapfrog_.keep(archive);
    adaption_schedule_.keep(archive);
    longest_step_.keep(archive);
    archive("imposed", imposed_);
    archive("factor", factor_);
  }

  /// Where the driven nodes and forces go in the next `advance`, and from where.
  template <class Archive>
  void keep_targets(Archive archive) {
    archive("from", from_);
    archive("to", to_);
    archive("factor_from", factor_from_);
    archive("factor_to", factor_to_);
  }

  /// What a saved state must agree with: the model, and what else decides about steps and the order of rows.
  Identity identity() const {
    Identity all = identity_of(model());
    const auto& dynamics = scene().settings.dynamics;
    all.emplace_back("damping", fmt::to_string(problem_->damping()));
    all.emplace_back("steps",
                     fmt::format("{} of the stable one, {} subcycles, checked every {}",
                                 problem_->step_fraction(), dynamics.subcycles, dynamics.check_interval));
    const std::vector<int>& rows = leapfrog_.body().layout().row_of_node;
    all.emplace_back("rows",
                     hash_of({reinterpret_cast<const char*>(rows.data()), rows.size() * sizeof(int)}));
    return all;
  }

  void choose_step() {
    const StableStep stable = leapfrog_.stable_step(model());
    if (undeformed_step_ == 0.0) undeformed_step_ = stable.step;
    require_worthwhile(stable, undeformed_step_, time(), leapfrog_.step());
    longest_step_.next(problem_->step_fraction() * stable.step, time());
    leapfrog_.body().set_step(step_size());
  }

  std::shared_ptr<const DrivenProblem> problem_;
  Leapfrog<Real> leapfrog_;
  DeviceSteps<Real> device_steps_;
  SteadyStep longest_step_;
  double undeformed_step_ = 0.0;  // s
  Adaption<Real> adaption_;
  AdaptionSchedule adaption_schedule_ = adaption_.schedule();
  std::vector<double> from_, to_,
      imposed_;  // m, as driven components are numbered; the last is the present one
  double factor_from_ = 0.0, factor_to_ = 0.0, factor_ = 0.0;
  std::vector<std::byte> whole_;  // the state at the last check
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
  parts_->problem().require_one_for_each_node(set, displacements.size());
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
void Simulation<Real>::save(const std::filesystem::path& file) const {
  parts_->save(file);
}

template <class Real>
void Simulation<Real>::resume(const std::filesystem::path& file) {
  parts_->resume(file);
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
  if (const auto touch = parts_->body().touch(set)) return touch->force;
  std::array<double, 3> sum{};
  for (const auto& [constraint, node, component] : parts_->problem().driven(set)) {
    sum[component] += parts_->body().reactions()[constraint];
  }
  return sum;
}

template <class Real>
std::array<double, 3> Simulation<Real>::moment(const std::string& obstacle) const {
  if (const auto touch = parts_->body().touch(obstacle); touch && touch->moment) return *touch->moment;
  const Reactions all = parts_->body().moments_of_obstacles();
  throw InputError(
      fmt::format("obstacle '{}' is not known; {}", obstacle, suggestion(obstacle, names_in(all))));
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
  return parts_->problem().nodes(set);
}

template class Simulation<double>;
template class Simulation<float>;

}  // namespace sandglass
