#include "solve/newton_step.hpp"

#include <cmath>
#include <limits>

#include "math/row_loops.hpp"
#include "solve/health.hpp"

namespace sandglass {

namespace {

/// A step is good enough when the linear residual has fallen to this share.
constexpr double forcing = 0.1;

/// Steps are limited to this change of displacement gradients.
constexpr double longest = 1.0;

/// The search for one step.
template <class Real>
class NewtonStep {
  using Multipliers = typename MixedBody<Real>::Multipliers;

 public:
  NewtonStep(MixedBody<Real>& mixed, const Multipliers* multipliers)
      : mixed_(mixed), multipliers_(multipliers), start_(mixed.body().state()) {
    mixed_.evaluate(multipliers_, start_force_);
    size_ = std::sqrt(dot(start_force_, start_force_, blocks().u));
  }

  /// Whether all directions so far had positive curvature.
  bool convex() const { return convex_; }

  bool take(int most_products) {
    if (!(size_ > 0.0) || !std::isfinite(size_)) return false;
    const double start_potential = mixed_.potential(multipliers_);
    const MixedVector downhill = against_forces();
    const MixedVector step = direction(downhill, most_products);
    const double slope = -size_ * dot(downhill, step, blocks());
    double share = std::min(1.0, longest / mixed_.multigrid().elements().largest_gradient(step.u));
    constexpr int most_trials = 30;
    Rows<Real> f;
    for (int trial = 0; trial < most_trials; ++trial, share *= 0.5) {
      mixed_.move(step, share);
      mixed_.evaluate(multipliers_, f);
      if (is_healthy(mixed_.body())) {
        const double allowed = start_potential + 1e-4 * share * slope;
        if (std::sqrt(dot(f, f, blocks().u)) < (1.0 - 1e-4 * share) * size_) return true;
        if (mixed_.potential(multipliers_) <= allowed) return true;
      }
      mixed_.body().state() = start_;
    }
    return false;
  }

 private:
  const MixedBlocks& blocks() const { return mixed_.multigrid().elements().blocks(); }

  static Rows<float> scaled(const Rows<Real>& rows, double factor) {
    Rows<float> to(rows.size());
    for (std::size_t row = 0; row < rows.size(); ++row) {
      for (std::size_t i = 0; i < 3; ++i) {
        to[row][i] = static_cast<float>(factor * static_cast<double>(rows[row][i]));
      }
    }
    return to;
  }

  /// The product of the tangent with a direction, over the norm of the forces.
  Rows<float> product(const MixedVector& direction) {
    // The length of forward differences, whose rounding nearly incompressible laws amplify.
    static const double change = std::cbrt(static_cast<double>(std::numeric_limits<Real>::epsilon()));
    const double length = change / mixed_.multigrid().elements().largest_gradient(direction.u);
    mixed_.move(direction, length);
    Rows<Real> f;
    mixed_.evaluate(multipliers_, f);
    mixed_.body().state() = start_;
    for (std::size_t row = 0; row < f.size(); ++row) {
      for (std::size_t i = 0; i < 3; ++i) f[row][i] -= start_force_[row][i];
    }
    return scaled(f, 1.0 / (length * size_));
  }

  /// Minus the forces, over their norm.
  MixedVector against_forces() const {
    MixedVector r = mixed_.multigrid().elements().zero();
    r.u = scaled(start_force_, -1.0 / size_);
    return r;
  }

  /// Conjugate gradients for the tangent and minus the forces.
  MixedVector direction(MixedVector r, int most_products) {
    MixedVector x = mixed_.multigrid().elements().zero(), z = x, d = x, q = x;
    double rz = 0.0;
    for (int k = 0; k < most_products; ++k) {
      mixed_.precondition(r, z);
      const double rz_before = rz;
      rz = dot(r, z, blocks());
      if (!(rz > 0.0)) {
        return k > 0 ? x : longest_along(steepest(r));
      }
      if (k > 0) {
        multiply(static_cast<float>(rz / rz_before), d, blocks());
        add(1.0f, z, d, blocks());
      } else {
        d = z;
      }
      q.u = product(d);
      const double curvature = dot(d, q, blocks());
      if (!(curvature > 0.0)) {
        convex_ = false;
        return k > 0 ? x : longest_along(std::move(d));
      }
      const auto length = static_cast<float>(rz / curvature);
      add(length, d, x, blocks());
      add(-length, q, r, blocks());
      if (dot(r, r, blocks()) < forcing * forcing) break;  // converged
    }
    return x;
  }

  MixedVector longest_along(MixedVector d) const {
    multiply(static_cast<float>(longest / mixed_.multigrid().elements().largest_gradient(d.u)), d, blocks());
    return d;
  }

  MixedVector steepest(const MixedVector& r) const {
    MixedVector d = mixed_.multigrid().elements().zero();
    mixed_.multigrid().elements().relax(1.0f, r.u, d.u);
    return d;
  }

  MixedBody<Real>& mixed_;
  const Multipliers* multipliers_;
  const State<Real> start_;
  Rows<Real> start_force_;
  double size_ = 0.0;
  bool convex_ = true;
};

}  // namespace

template <class Real>
bool newton_step(MixedBody<Real>& mixed, const typename MixedBody<Real>::Multipliers* multipliers,
                 int most_products, bool* convex) {
  NewtonStep<Real> step(mixed, multipliers);
  const bool taken = step.take(most_products);
  if (convex != nullptr) *convex = step.convex();
  return taken;
}

template bool newton_step(MixedBody<double>&, const MixedBody<double>::Multipliers*, int, bool*);
template bool newton_step(MixedBody<float>&, const MixedBody<float>::Multipliers*, int, bool*);

}  // namespace sandglass
