#include "solve/motion_gradient.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "mesh/edges.hpp"
#include "mesh/vectors.hpp"
#include "problem/checkpoint.hpp"
#include "solve/leapfrog.hpp"
#include "solve/loading_curve.hpp"

namespace sandglass {

namespace {

/// Memory (bytes) for the displacements of a segment that does not matter: short motions are one segment,
/// which saves computing them twice.
constexpr std::size_t free_memory = std::size_t{64} << 20U;

/// The change of displacement gradients in differences of forces: its square is their error, and the
/// precision of the forces over it their rounding. Where fibres begin to bear, forces have a kink, and the
/// error is of first order.
constexpr double change_of_gradients = 4e-7;

/// The steps after which the ratio of an adjoint's gradient to its size is measured again.
constexpr std::size_t steps_per_measure = 32;

/// y += factor * x.
void add(double factor, const Rows<double>& x, Rows<double>& y, const Blocks& blocks) {
  const double* from = numbers_of(x);
  double* to = numbers_of(y);
  blocks.for_each([=](std::size_t first, std::size_t last) {
#pragma omp simd
    for (std::size_t k = first; k < last; ++k) to[k] += factor * from[k];
  });
}

/// The forward and the reverse recurrence of a motion. Displacements u_n and the increments d_n of free
/// components follow from
///   d_(n+1) = keep_n d_n - gain_n M^-1 F(u_n, u_n - u_(n-1)),   u_(n+1) = u_n + d_(n+1),
/// where tied nodes follow others and constrained components their paths. With a_n = dJ/du_n, in which later
/// displacements count, and b_n = dJ/dd_n:
///   b_(n+1) = a_(n+1) + keep_(n+1) b_(n+2),   w_n = -gain_n M^-1 b_(n+1),
///   a_n = dJ/du_n + a_(n+1) + (dF/du)^T w_n,   dJ/dp = sum_n w_n . dF/dp.
class MotionAdjoint {
 public:
  MotionAdjoint(const Model& model, std::span<const TakenStep> steps, const Wanted& wanted)
      : model_(model),
        steps_(steps),
        leapfrog_(model, double_elements(model), settings().damping),
        loads_(model.scene(), layout()),
        powers_(model, {}, wanted.parameters),
        state_(double_elements(model).undeformed()),
        by_u_(layout().rows()),
        by_increment_(by_u_),
        by_earlier_u_(by_u_),
        w_(by_u_),
        forces_(by_u_),
        by_forces_(by_u_) {
    leapfrog_.body().evaluate_forces();
    leapfrog_.set_initial_velocities(model.scene().initial_velocities);
    found_.imposed.resize(model.scene().mesh.points.size());
  }

  Gradient gradient(const std::map<std::size_t, NodalField>& of_displacements, const NodalField& last) {
    const std::size_t end = of_displacements.empty() ? 0 : of_displacements.rbegin()->first;
    const auto root = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(end))));
    const std::size_t length =
        std::max({std::size_t{1}, root, free_memory / (sizeof(Row<double>) * w_.size())});
    std::vector<std::vector<std::byte>> starts;  // the states at which segments begin
    for (std::size_t n = 0; n < end; ++n) {
      if (n % length == 0) {
        starts.emplace_back();
        StateCopy copy(starts.back());
        leapfrog_.keep(copy);
        if (n + length >= end) break;
      }
      take(n);
    }
    for (std::size_t s = starts.size(); s-- > 0;) {
      StateCopy start(std::as_const(starts[s]));
      leapfrog_.keep(start);
      const std::size_t first = s * length, behind = std::min(first + length, end);
      follow(first, behind);
      if (behind == end) require_repeated(last);
      for (std::size_t n = behind; n-- > first;) {
        const auto weights = of_displacements.find(n + 1);
        if (weights != of_displacements.end()) {
          add(1.0, to_rows<double>(weights->second, layout()), by_u_, blocks());
          measured_ = 0;
        }
        reverse(n, segment_[n - first], segment_[n - first + 1], segment_[n - first + 2]);
      }
      starts.pop_back();
    }
    found_.velocities = to_field(by_increment_, layout());  // the first increment is over 1 s
    found_.forces = to_field(by_forces_, layout());
    found_.by_elements = powers_.sum();
    return std::move(found_);
  }

 private:
  const DynamicsSettings& settings() const { return model_.scene().settings.dynamics; }
  const Layout& layout() const { return double_elements(model_).layout(); }
  const Blocks& blocks() const { return layout().row_blocks; }
  double time(std::size_t n) const { return n == 0 ? 0.0 : steps_[n - 1].time; }
  double load_factor(std::size_t n) const { return loading_curve(settings(), time(n)).value(); }

  /// The clock before the n-th step.
  LeapfrogClock clock(std::size_t n) const {
    LeapfrogClock clock{.damping = settings().damping};
    if (n > 0) clock.step_size = clock.increment_time = steps_[n - 1].size;
    return clock;
  }

  /// Takes the n-th step, as a motion does.
  void take(std::size_t n) {
    leapfrog_.advance(steps_[n].size, [&](Body<double>& body) {
      body.impose(loading_curve(settings(), leapfrog_.time()).value(), leapfrog_.time());
    });
  }

  /// Takes the steps `first` to `behind` - 1 and keeps the displacements before the first, here, and after
  /// each.
  void follow(std::size_t first, std::size_t behind) {
    const State<double>& now = leapfrog_.body().state();
    segment_.resize(behind - first + 2);
    segment_[0] = segment_[1] = now.u;
    add(-1.0, now.increment, segment_[0], blocks());
    for (std::size_t n = first; n < behind; ++n) {
      take(n);
      segment_[n - first + 2] = now.u;
    }
  }

  /// From the derivatives by the state after the n-th step to those by the state before it.
  void reverse(std::size_t n, const Rows<double>& before, const Rows<double>& now,
               const Rows<double>& after) {
    const Body<double>& body = leapfrog_.body();
    const LeapfrogClock::Coefficients step = clock(n).advance(steps_[n].size);
    body.ties().hand_on(by_u_);
    take_imposed(load_factor(n + 1));
    body.constraints().clear(by_u_);
    add(1.0, by_u_, by_increment_, blocks());
    add_damping(n, step, before, now, after);
    const double* inverse_mass = numbers_of(leapfrog_.inverse_masses());
    double *b = numbers_of(by_increment_), *w = numbers_of(w_);
    blocks().for_each([=](std::size_t first, std::size_t last) {
#pragma omp simd
      for (std::size_t k = first; k < last; ++k) {
        w[k] = -step.gain * inverse_mass[k] * b[k];
        b[k] *= step.keep;
      }
    });
    body.ties().follow(w_);
    add_stiffness(now);
    add_loads(n, now);
    powers_.add(now, w_);
  }

  void take_imposed(double load_factor) {
    for (const Constraint& c : model_.scene().constraints) {
      found_.imposed[at(c.node)][at(c.component)] +=
          load_factor * by_u_[at(layout().row_of_node[at(c.node)])][at(c.component)];
    }
  }

  /// The derivative by the damping c: with a mean step h and k = 1 + c h / 2, keep has -h / k^2 times the
  /// ratio of the steps, and gain -gain h / (2 k).
  void add_damping(std::size_t n, const LeapfrogClock::Coefficients& step, const Rows<double>& before,
                   const Rows<double>& now, const Rows<double>& after) {
    const LeapfrogClock clock = this->clock(n);
    const double h = 0.5 * (clock.step_size + steps_[n].size), k = 1.0 + 0.5 * clock.damping * h;
    const double of_keep = -h / (k * k) * steps_[n].size / clock.increment_time, of_gain = -0.5 * h / k;
    const double *b = numbers_of(by_increment_), *u = numbers_of(now), *u_before = numbers_of(before),
                 *u_after = numbers_of(after);
    double of_increment = 0.0, of_force = 0.0;
#pragma omp simd reduction(+ : of_increment, of_force)
    for (std::size_t j = 0; j < 4 * now.size(); ++j) {
      const double d = u[j] - u_before[j];
      of_increment += b[j] * d;
      of_force += b[j] * (u_after[j] - u[j] - step.keep * d);  // -gain M^-1 F
    }
    found_.damping += of_keep * of_increment + of_gain * of_force;
  }

  /// Adds the stiffness at displacements u times w, a difference of forces.
  void add_stiffness(const Rows<double>& u) {
    const double size = largest(w_);
    if (!(size > 0.0)) return;
    if (measured_++ % steps_per_measure == 0) gradient_over_size_ = largest_gradient() / size;
    const double length = change_of_gradients / (gradient_over_size_ * size);
    for (const double side : {1.0, -1.0}) {
      state_.u = u;
      add(side * length, w_, state_.u, blocks());
      double_elements(model_).evaluate(state_, forces_);
      add(side / (2.0 * length), forces_, by_u_, blocks());
    }
  }

  /// The largest change of w along an edge, over its length; not zero even if w is constant.
  double largest_gradient() const {
    const Mesh& mesh = model_.scene().mesh;
    double most = 0.0;
    for (const Hexahedron& cell : mesh.cells) {
      for (const auto& [a, b] : hexahedron_edges) {
        const Row<double>&from = w_[at(layout().row_of_node[at(cell[a])])],
              &to = w_[at(layout().row_of_node[at(cell[b])])];
        const double moved = std::hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]);
        most = std::max(most, moved / distance(mesh.points[at(cell[a])], mesh.points[at(cell[b])]));
      }
    }
    return std::max(most, largest(w_) / diagonal(mesh.points));
  }

  /// Adds the derivatives by forces that grow with the case's load, and by displacements on which other loads
  /// depend; dashpots also depend on those of a step before.
  void add_loads(std::size_t n, const Rows<double>& now) {
    const Scene& scene = model_.scene();
    add(-scene.curves.front().at(time(n), load_factor(n)), w_, by_forces_, blocks());
    if (first_not_dead(scene.forces) == nullptr) return;
    loads_.set(time(n), load_factor(n));
    state_.u = now;
    state_.step = n > 0 ? steps_[n - 1].size : INFINITY;
    Rows<double> by_change(now.size());
    loads_.subtract_derivatives_of_power(state_, w_, by_u_, by_change);
    add(1.0, by_change, by_u_, blocks());
    add(1.0, by_earlier_u_, by_u_, blocks());
    std::fill(by_earlier_u_.begin(), by_earlier_u_.end(), Row<double>{});
    add(-1.0, by_change, by_earlier_u_, blocks());
  }

  /// Throws ComputationError unless the last displacements are those of the motion.
  void require_repeated(const NodalField& last) const {
    constexpr double rounding = 1e-9;  // of the displacements
    const Rows<double> expected = to_rows<double>(last, layout());
    Rows<double> difference = segment_.back();
    add(-1.0, expected, difference, blocks());
    if (largest(difference) <= rounding * largest(expected)) return;
    throw ComputationError("derivatives: the motion was not the same when it was computed again");
  }

  const Model& model_;
  std::span<const TakenStep> steps_;
  Leapfrog<double> leapfrog_;
  Loads<double> loads_;
  PowerDerivativeSum powers_;
  State<double> state_;
  std::vector<Rows<double>> segment_;  // displacements, m
  Rows<double> by_u_, by_increment_;   // a and b; of the state after the present step
  Rows<double> by_earlier_u_;          // what is due to dashpots
  Rows<double> w_, forces_;
  Rows<double> by_forces_;
  double gradient_over_size_ = 0.0;  // of w, 1/m
  std::size_t measured_ = 0;         // steps since its jump
  Gradient found_{};
};

}  // namespace

std::size_t TakenSteps::until(double time) const {
  const auto behind = std::ranges::upper_bound(steps_, time, {}, &TakenStep::time);
  return static_cast<std::size_t>(behind - steps_.begin());
}

void require_differentiable_motion(const Model& model) {
  require_differentiable_forces(model);
  const MethodEntry& method = method_named(model.choice().method);
  if (method.adapts()) {
    refuse_derivatives(fmt::format(
        "method '{}' changes its elements during a motion; allowed: one of its levels, such as '{}'",
        method.name, method.levels.back()));
  }
  for (const Material& material : model.scene().materials.list) {
    if (is_viscoelastic(material.law)) {
      refuse_derivatives(
          fmt::format("law '{}' remembers the motion; allowed: elastic laws", name_of(material.law)));
    }
  }
  if (model.scene().settings.dynamics.subcycles > 1)
    refuse_derivatives("dynamics.subcycles > 1 is not supported; it must be 1");
}

Gradient gradient_of_motion(const Model& model, std::span<const TakenStep> steps,
                            const std::map<std::size_t, NodalField>& of_displacements, const NodalField& last,
                            const Wanted& wanted) {
  return MotionAdjoint(model, steps, wanted).gradient(of_displacements, last);
}

}  // namespace sandglass
