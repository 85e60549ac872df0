#include "solve/central_difference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/error.hpp"
#include "mesh/vectors.hpp"
#include "solve/adaption.hpp"
#include "solve/cubic.hpp"
#include "solve/driving_forces.hpp"
#include "solve/energy_watch.hpp"
#include "solve/frame.hpp"
#include "solve/health.hpp"
#include "solve/leapfrog.hpp"
#include "solve/loading_curve.hpp"
#include "solve/resident.hpp"
#include "solve/stable_step.hpp"
#include "solve/steady_step.hpp"

namespace sandglass {

namespace {

/// The quantities of the scheme, one function each; the order of calls is in `integrate_body`.
template <class Real>
class CentralDifference {
 public:
  CentralDifference(const Model& model, const InternalForce<Real>& elements)
      : model_(model),
        settings_(model.scene().settings.dynamics),
        undeformed_step_(sandglass::stable_step(model, NodalField(model.masses().size())).step),
        leapfrog_(model, elements, settings_.damping),
        steady_step_(settings_.damping),
        body_(leapfrog_.body()),
        driving_(model, body_),
        resident_(resident_motion(model, elements, leapfrog_)) {
    leapfrog_.subcycle(model);
  }

  Body<Real>& body() { return body_; }
  double time() const { return leapfrog_.time(); }
  long step() const { return leapfrog_.step(); }
  double step_size() const { return leapfrog_.step_size(); }

  /// Work of imposed displacements and forces since the start, J.
  double external_work() const { return body_.work_of_loads() + driving_.work(); }

  double adaption_energy() const { return adaption_energy_; }

  struct Kinetic {
    double energy;   ///< J
    double damping;  ///< power that damping takes from free components, W
  };

  /// From the product of velocities half a step before and after: central differences conserve the sum of
  /// this energy with the strain energy, in small motions exactly. Contact that moves nodes adds its work
  /// with the next step, so that it has no part in the velocities after this one.
  Kinetic kinetic() const {
    const NodalField v = velocities(false);
    double sum = 0.0, driven = 0.0;
    for (std::size_t n = 0; n < v.size(); ++n) sum += model_.masses()[n] * dot(v[n], v[n]);
    for (const Constraint& constraint : model_.scene().constraints) {
      const double of_path = v[at(constraint.node)][at(constraint.component)];
      driven += model_.masses()[at(constraint.node)] * of_path * of_path;
    }
    const double energy = 0.5 * sum - leapfrog_.energy_of_step();
    return {energy, 2.0 * settings_.damping * std::max(energy - 0.5 * driven, 0.0)};
  }

  /// The data that the next step depends on; see checkpoint.hpp.
  template <class Archive>
  void keep(Archive& archive) {
    leapfrog_.keep(archive);
    steady_step_.keep(archive);
    driving_.keep(archive);
    archive("next step", next_step_);
    archive("adaption energy", adaption_energy_);
  }

  /// Starts from the initial velocities.
  void set_initial_velocities() { leapfrog_.set_initial_velocities(model_.scene().initial_velocities); }

  /// Sets the next step: the user's, rejected if unstable, or a share of the stable one.
  void choose_step() {
    const StableStep stable = leapfrog_.stable_step(model_, settings_.time_step);
    if (settings_.time_step > 0.0) {
      require_stable(stable);
      next_step_ = settings_.time_step;
    } else {
      require_worthwhile(stable, undeformed_step_, time(), step());
      const double before = steady_step_.step();
      if (steady_step_.next(settings_.step_fraction * stable.step, time()) != before) divide_what_is_left();
    }
    body_.set_step(next_step_);
  }

  /// Whether steps may be shorter than those that `choose_step` sets.
  bool may_shorten() const {
    const bool chosen_unstable = settings_.time_step > 0.0 || settings_.step_fraction > 1.0;  // on purpose
    return !chosen_unstable && steady_step_.may_shorten();
  }

  /// Shortens the steps from now on.
  void shorten() {
    steady_step_.shorten();
    divide_what_is_left();
    body_.set_step(next_step_);
  }

  /// Whether the end is reached, up to the roundoff of a sum of steps.
  bool finished() const { return time() >= settings_.duration * (1.0 - 1e-12); }

  /// Of a step on the processor that takes them; none if steps are taken here.
  StepTraffic traffic() const { return resident_ == nullptr ? StepTraffic{} : resident_->step_traffic(); }

  /// Leaves the body to the processor that takes its steps, if it is another one.
  void leave() {
    if (resident_ != nullptr) resident_->begin(body_, driving_.forces());
  }

  /// Brings the body here from that processor.
  void arrive() {
    if (resident_ == nullptr) return;
    resident_->bring(body_, curve(time()).value(), time(), driving_.forces(), driving_.works());
  }

  /// Whether the body, which is then here, is healthy.
  bool is_healthy() {
    const bool healthy = resident_ == nullptr ? sandglass::is_healthy(body_) : resident_->is_healthy();
    arrive();
    return healthy;
  }

  /// Takes the next step.
  void advance() {
    if (resident_ != nullptr) return resident_->add(numbers_of_step(leapfrog_.tick(due_step())));
    leapfrog_.advance(due_step(), [this](Body<Real>& body) { body.impose(curve(time()).value(), time()); });
  }

  /// Takes the next step and, if the body is healthy after it, passes on the displacements that an observer
  /// wants within it. Returns whether it wants any.
  bool advance(Observer& observer) {
    const bool asked = observer.next_sample() <= time() + due_step() * (1.0 + 1e-9);
    if (!asked) {
      advance();
      return false;
    }
    arrive();
    const NodalField u = body_.field(body_.state().u), v = velocities();
    advance();
    if (!is_healthy()) return true;
    const NodalField u_after = body_.field(body_.state().u), v_after = velocities();
    while (observer.next_sample() <= time() * (1.0 + 1e-12)) {
      const double left = (time() - observer.next_sample()) / step_size();
      observer.sample(cubic(1.0 - left, step_size(), u, v, u_after, v_after));
    }
    return true;
  }

  /// Adds the work of imposed displacements and forces over the last step, from the mean of the forces at its
  /// ends. Another processor that takes steps does this as well.
  void add_external_work() {
    if (resident_ != nullptr) return;
    driving_.follow_paths(time(), step_size());
    driving_.add_work();
    body_.add_work_of_loads();
  }

  /// Promotes elements and evaluates their new forces. The increase of stored energy at the same
  /// displacements, which no work balances, is added to the adaption energy; `before` are the energies before
  /// it. Returns whether any element was promoted.
  bool adapt(Adaption<Real>& adaption, const StrainEnergies& before) {
    if (adaption.apply(body_, Demotion::never).promoted == 0) return false;
    body_.evaluate_forces();
    const StrainEnergies now = body_.energies();
    adaption_energy_ += now.strain + now.hourglass - before.strain - before.hourglass;
    driving_.update();
    return true;
  }

  /// Velocities (m/s) at the time of the displacements; driven nodes have the velocities of their paths.
  NodalField velocities() const { return velocities(true); }

 private:
  NodalField velocities(bool with_pushes) const {
    NodalField v = leapfrog_.free_velocities(with_pushes);
    const LoadingCurve now = curve(time());
    for (const Constraint& constraint : model_.scene().constraints) {
      const ImposedPath& path = constraint.path;
      const double by_factor = path.along(path_rates(model_.scene().angles[path.angle], now.value()));
      v[at(constraint.node)][at(constraint.component)] = now.rate() / ramp_time(settings_) * by_factor;
    }
    follow(model_.scene().ties, v);
    return v;
  }

  /// The step that is due (s): the last one ends at the duration.
  double due_step() const {
    const double left = settings_.duration - time();
    return left < next_step_ * (1.0 + 1e-6) ? left : next_step_;
  }

  /// The next of equal steps to the end, at most the steady step.
  void divide_what_is_left() {
    const double left = settings_.duration - time();
    constexpr double rounding = 1e-9;  // of a step; it must not affect their number
    next_step_ = left / std::max(1.0, std::ceil(left / steady_step_.step() - rounding));
  }

  LoadingCurve curve(double time) const { return loading_curve(settings_, time); }

  /// The numbers of the last step for another processor.
  ResidentStep numbers_of_step(LeapfrogClock::Coefficients coefficients) {
    driving_.follow_paths(time(), step_size());
    const double now = curve(time()).value();
    ResidentStep numbers{
        coefficients.keep, coefficients.gain, step_size(), body_.factors_of_loads(time(), now), {}};
    for (std::size_t m = 0; m < driving_.moved().size(); ++m) {
      numbers.angles.push_back(
          {path_terms(model_.scene().angles[m], now), driving_.moved()[m], driving_.accelerations()[m]});
    }
    return numbers;
  }

  void require_stable(const StableStep& stable) const {
    if (settings_.time_step <= stable.step) return;
    const std::string text = fmt::format(
        "dynamics.time_step = {:.6g} s is above the stable step {:.6g} s, set by {} at step {}; "
        "allowed: at most the stable step, or 0 to let the program choose",
        settings_.time_step, stable.step,
        stable.element == StableStep::by_damping ? "damping" : fmt::format("element {}", stable.element),
        step());
    if (step() == 0) throw InputError(fmt::format("{}: {}", model_.scene().settings.file.string(), text));
    throw ComputationError(text);
  }

  const Model& model_;
  const DynamicsSettings& settings_;
  double undeformed_step_;  // s
  Leapfrog<Real> leapfrog_;
  SteadyStep steady_step_;
  Body<Real>& body_;
  DrivingForces<Real> driving_;
  double next_step_ = 0.0;
  double adaption_energy_ = 0.0;
  std::unique_ptr<ResidentMotion<Real>> resident_;  // null: steps are taken here
};

template <class Real>
Motion integrate_body(const Model& model, const InternalForce<Real>& elements, Observer& observer,
                      const Checkpoint* from) {
  const DynamicsSettings& settings = model.scene().settings.dynamics;
  CentralDifference<Real> scheme(model, elements);
  Body<Real>& body = scheme.body();
  Adaption<Real> adaption(model, body);
  AdaptionSchedule adaption_schedule = adaption.schedule();
  Motion motion;
  int frames = 0;
  EnergyWatch watch;
  StrainEnergies energies;  // at the last check
  typename CentralDifference<Real>::Kinetic kinetic{};
  double damped = 0.0, damping = 0.0, reported = 0.0;  // J; in the last report, W; its time, s
  Touch touch;

  const auto frame_due = [&] {  // up to the roundoff of a sum of steps
    return scheme.time() >= frames * settings.duration / settings.frames * (1.0 - 1e-12) || scheme.finished();
  };
  const auto gains_energy = [&] {
    energies = body.energies();
    kinetic = scheme.kinetic();
    touch = body.touch();
    return watch.rises(
        kinetic.energy + energies.strain + energies.hourglass + touch.stored + touch.dissipated,
        scheme.external_work() + scheme.adaption_energy(), scheme.step_size());
  };
  const auto report = [&] {
    damped += 0.5 * (damping + kinetic.damping) * (scheme.time() - reported);
    damping = kinetic.damping;
    reported = scheme.time();
    observer.history({scheme.time(), kinetic.energy, energies.strain, energies.hourglass,
                      scheme.external_work(), body.residual(), scheme.step_size(), scheme.adaption_energy(),
                      body.reactions_of_sets(), touch.stored, touch.dissipated, touch.depth,
                      body.moments_of_obstacles(), damped});
    if (frame_due()) {
      observer.frame(frame_of(body, scheme.time(), scheme.velocities()));
      ++frames;
    }
    const bool proceeds = observer.proceed(scheme.step(), scheme.time() / settings.duration, body.residual());
    motion.interrupted = model.choice().ranks->any(!proceeds);
  };

  const auto keep = [&](auto archive) {
    scheme.keep(archive);
    archive("frames", frames);
    adaption_schedule.keep(archive);
    watch.keep(archive);
    archive("smallest step", motion.smallest_step);
    archive("most substeps", motion.most_substeps);
    archive("repeated intervals", motion.repeated);
    archive("energy lost to damping", damped);
    archive("power of damping", damping);
    archive("time of report", reported);
  };
  const auto checkpoint = [&] {
    Checkpoint state;
    keep(CheckpointWriter(state));
    return state;
  };

  const auto start = std::chrono::steady_clock::now();
  if (from != nullptr) {
    keep(CheckpointReader(*from));
  } else {
    scheme.choose_step();
    motion.smallest_step = settings.duration;
    body.evaluate_forces();
    body.add_work_of_loads();  // from here on
    scheme.set_initial_velocities();
    gains_energy();
    report();
    observer.resumable(checkpoint);
  }
  std::vector<std::byte> sound;                           // the state at the last check
  const bool alone = model.choice().ranks->count() == 1;  // one rank keeps only a part of the state
  if (alone) keep(StateCopy(sound));
  scheme.leave();
  while (!scheme.finished() && !motion.interrupted) {
    const bool sampled = scheme.advance(observer);
    observer.stepped(scheme.time(), scheme.step_size());
    scheme.add_external_work();
    motion.smallest_step = std::min(motion.smallest_step, scheme.step_size());
    motion.most_substeps = std::max(motion.most_substeps, body.substeps());
    const bool check_due = scheme.step() % settings.check_interval == 0, due = check_due || frame_due();
    if (!due && !sampled) continue;
    const bool healthy = scheme.is_healthy();
    if ((!healthy || gains_energy()) && alone && scheme.may_shorten()) {
      keep(StateCopy(std::as_const(sound)));
      scheme.shorten();
      scheme.leave();
      ++motion.repeated;
    } else if (due) {
      if (!healthy) require_healthy(body, scheme.step());
      require_not_passed(touch, model.scene().mesh.points, "step", static_cast<double>(scheme.step()));
      report();
      if (check_due) {  // the number of frames does not change the motion
        if (adaption.active() && adaption_schedule.due())
          adaption_schedule.done(scheme.adapt(adaption, energies));
        scheme.choose_step();
      }
      observer.resumable(checkpoint);
    }
    if (alone) keep(StateCopy(sound));
  }
  motion.u = body.field(body.state().u);
  motion.v = scheme.velocities();
  motion.time = scheme.time();
  motion.steps = scheme.step();
  motion.never_adapted = adaption.active() && adaption_schedule.choices() == 0;
  motion.traffic = scheme.traffic();
  motion.adaption_seconds = adaption.seconds();
  motion.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return motion;
}

}  // namespace

Motion integrate(const Model& model, Observer& observer, const Checkpoint* from) {
  require_steps(model);
  return std::visit([&](const auto& elements) { return integrate_body(model, *elements, observer, from); },
                    model.internal_force());
}

}  // namespace sandglass
