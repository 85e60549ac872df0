#include "solve/static_tangent.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "math/row_loops.hpp"
#include "solve/acceleration.hpp"

namespace sandglass {

namespace {

/// The exact residual, over its initial value, at which a problem is solved, and the one that is accepted if
/// rounding allows no less.
constexpr double solved = 1e-9, acceptable = 1e-7;

/// A correction reduces the residual to this share at least, more would be lost in the differences of forces;
/// the last one only as far as the problem needs.
constexpr double least_share = 1e-4;

/// A residual below this share that has not halved in so many cycles may have reached the rounding of answers
/// in single precision: the next correction starts from the exact residual.
constexpr double may_be_rounding = 1e-2;
constexpr int cycles_to_halve = 4;

constexpr int most_corrections = 30, most_cycles = 120, most_products = 2000;

/// The change of displacement gradients in differences of forces. In nearly incompressible bodies the forces
/// curve as lambda / mu times this, and lambda / mu times double precision, over this, is their rounding.
constexpr double change = 2e-7;

}  // namespace

StaticTangent::StaticTangent(const Model& model, const NodalField& u, std::vector<double> levels)
    : model_(model), u_(u), levels_(std::move(levels)), mixed_(model, double_elements(model)) {
  Body<double>& body = mixed_.body();
  body.state() = state_at(double_elements(model), u_);
  if (!levels_.empty()) double_elements(model).set_levels(body.state(), levels_);
  body.impose(1.0);
  mixed_.linearize();
  mixed_.weigh();
  mixed_.take_own_pressures();
  mixed_.evaluate();
  state_ = body.state();
  pressures_ = mixed_.pressures();
  residuals_ = mixed_.residuals();
  forces_ = body.free_forces();
}

void StaticTangent::add_stiffness_of_loads(const Rows<double>& a, Rows<double>& forces) const {
  const Scene& scene = model_.scene();
  if (first_not_dead(scene.forces) == nullptr) return;
  Loads<double> loads(scene, layout());
  loads.set(1.0, 1.0);
  Rows<double> by_increment(a.size());  // none without time
  loads.subtract_derivatives_of_power(state_, a, forces, by_increment);
}

NodalField StaticTangent::product(const NodalField& a) const {
  NodalField forces(a.size());
  if (std::ranges::all_of(a, [](const Vector& row) { return row == Vector{}; })) return forces;
  for_each_element_slope(model_, model_.scene().materials, levels_, u_, a,
                         [&](std::size_t e, const ElementSlopes& f) {
                           scatter_add(f, model_.scene().mesh.cells[e], forces,
                                       [](const Dual<double>& component) { return component.slope; });
                         });
  Rows<double> rows = to_rows<double>(forces, layout());
  add_stiffness_of_loads(to_rows<double>(a, layout()), rows);
  mixed_.body().ties().hand_on(rows);
  return to_field(rows, layout());
}

NodalField StaticTangent::followed(const NodalField& a) const {
  Rows<double> rows = to_rows<double>(a, layout());
  mixed_.body().ties().follow(rows);
  return to_field(rows, layout());
}

NodalField StaticTangent::handed_on(const NodalField& forces) const {
  Rows<double> rows = to_rows<double>(forces, layout());
  mixed_.body().ties().hand_on(rows);
  return to_field(rows, layout());
}

Rows<double> StaticTangent::residual(const Rows<double>& b, const Rows<double>& a) const {
  Rows<double> r = to_rows<double>(product(to_field(a, layout())), layout());
  for (std::size_t row = 0; row < r.size(); ++row) {
    for (std::size_t i = 0; i < 3; ++i) r[row][i] = b[row][i] - r[row][i];
  }
  mixed_.body().constraints().clear(r);
  return r;
}

double StaticTangent::norm(const Rows<double>& forces) const {
  double sum = 0.0;
  for (std::size_t row = 0; row < forces.size(); ++row) {
    const Tensor<float> D = mixed_.multigrid().elements().relaxation(row);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j)
        sum += static_cast<double>(D(i, j)) * forces[row][at(i)] * forces[row][at(j)];
    }
  }
  return std::sqrt(sum);
}

NodalField StaticTangent::solve(const NodalField& b_at_nodes) {
  Rows<double> b = to_rows<double>(handed_on(b_at_nodes), layout());
  mixed_.body().constraints().clear(b);
  Rows<double> a(b.size());
  const double unit_force = largest(b);  // with which no square overflows
  if (!(unit_force > 0.0)) return to_field(a, layout());
  const auto multiply = [](Rows<double>& rows, double factor) {
    for (auto& row : rows) row = {{factor * row[0], factor * row[1], factor * row[2]}};
  };
  multiply(b, 1.0 / unit_force);
  const double first = norm(b);
  Rows<double> r = b;
  double size = first;
  for (int k = 0; k < most_corrections && size > solved * first; ++k) {
    MixedVector unit = mixed_.multigrid().elements().zero();
    for (std::size_t row = 0; row < r.size(); ++row) {
      for (std::size_t i = 0; i < 3; ++i) unit.u[row][i] = static_cast<float>(r[row][i] / size);
    }
    const MixedVector x = correction(unit, std::max(least_share, 0.5 * solved * first / size));
    Rows<double> next = a;
    for (std::size_t row = 0; row < a.size(); ++row) {
      for (std::size_t i = 0; i < 3; ++i) next[row][i] += size * static_cast<double>(x.u[row][i]);
    }
    mixed_.body().ties().follow(next);
    const Rows<double> left = residual(b, next);
    const double size_left = norm(left);
    if (!(size_left < 0.9 * size)) break;
    a = std::move(next);
    r = left;
    size = size_left;
  }
  if (!(size <= acceptable * first)) {
    throw ComputationError(fmt::format(
        "the linear problem of the derivatives was not solved: its residual stopped falling at {:.1e}; the "
        "equilibrium may be at a limit of the load",
        size / first));
  }
  double work = 0.0;
  for (std::size_t row = 0; row < a.size(); ++row) {
    for (std::size_t i = 0; i < 3; ++i) work += b[row][i] * a[row][i];
  }
  if (!(work > 0.0)) {
    throw ComputationError(
        "the equilibrium is unstable: its stiffness is negative along the answer of the linear problem");
  }
  multiply(a, unit_force);
  return to_field(a, layout());
}

MixedVector StaticTangent::correction(const MixedVector& r, double share_left) {
  return method_named(model_.choice().method).pressure_varies ? conjugate(r, share_left)
                                                              : accelerated(r, share_left);
}

MixedVector StaticTangent::mixed_product(const MixedVector& x) {
  const double gradient = mixed_.multigrid().elements().largest_gradient(x.u);
  MixedVector Kx = mixed_.multigrid().elements().zero();
  if (!(gradient > 0.0)) return Kx;
  const double length = change / gradient;
  mixed_.move(x, length);
  mixed_.evaluate();
  Kx = mixed_.residuals();
  mixed_.body().state() = state_;
  mixed_.pressures() = pressures_;
  add(-1.0F, residuals_, Kx, blocks());
  multiply(static_cast<float>(1.0 / length), Kx, blocks());
  return Kx;
}

/// Anderson's acceleration of the multigrid cycle, for displacements and pressures.
MixedVector StaticTangent::accelerated(const MixedVector& r, double share_left) {
  const MixedVector zero = mixed_.multigrid().elements().zero();
  MixedVector x = zero, b = r, best = zero, left, step, change_of_x;
  mixed_.weigh(b);
  left = b;
  multiply(-1.0F, left, blocks());
  Acceleration acceleration(blocks());
  const double first = std::sqrt(dot(b, b, blocks()));
  double least = first, halved = first;
  int waited = 0;
  const auto stagnates = [&] { return waited == cycles_to_halve && halved < may_be_rounding * first; };
  for (int k = 0; k < most_cycles && least > share_left * first && !stagnates(); ++k) {
    step = zero;
    acceleration.combine(left, step);
    change_of_x = left;
    mixed_.correct(left, change_of_x);
    add(1.0F, change_of_x, step, blocks());
    add(1.0F, step, x, blocks());
    acceleration.moved(step);
    left = mixed_product(x);
    add(-1.0F, b, left, blocks());
    const double size = std::sqrt(dot(left, left, blocks()));
    if (!std::isfinite(size)) break;
    if (size < least) {
      least = size;
      best = x;
    }
    waited = std::min(waited + 1, cycles_to_halve);
    if (size < 0.5 * halved) {
      halved = size;
      waited = 0;
    }
  }
  return best;
}

Rows<float> StaticTangent::difference_product(const MixedVector& x) {
  const double length = change / mixed_.multigrid().elements().largest_gradient(x.u);
  mixed_.move(x, length);
  Rows<double> f;
  mixed_.evaluate(nullptr, f);
  mixed_.body().state() = state_;
  mixed_.pressures() = pressures_;
  Rows<float> Kx(f.size());
  for (std::size_t row = 0; row < f.size(); ++row) {
    for (std::size_t i = 0; i < 3; ++i)
      Kx[row][i] = static_cast<float>((f[row][i] - forces_[row][i]) / length);
  }
  return Kx;
}

/// Conjugate gradients for displacements alone, where an element has more than one pressure.
MixedVector StaticTangent::conjugate(MixedVector r, double share_left) {
  MixedVector x = mixed_.multigrid().elements().zero(), z = x, d = x, q = x;
  double rz = 0.0, first = 0.0;
  for (int k = 0; k < most_products; ++k) {
    mixed_.precondition(r, z);
    const double rz_before = rz;
    rz = dot(r, z, blocks());
    if (k == 0) first = rz;
    if (!(rz > share_left * share_left * first)) break;
    if (k > 0) multiply(static_cast<float>(rz / rz_before), d, blocks());
    add(1.0F, z, d, blocks());
    q.u = difference_product(d);
    const double curvature = dot(d, q, blocks());
    if (!(curvature > 0.0)) break;
    const auto length = static_cast<float>(rz / curvature);
    add(length, d, x, blocks());
    add(-length, q, r, blocks());
  }
  return x;
}

}  // namespace sandglass
