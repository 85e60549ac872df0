#include "solve/softest_motions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "math/dense.hpp"
#include "math/row_loops.hpp"
#include "mesh/mesh.hpp"

namespace sandglass {

namespace {

/// The largest resistance to volume changes, over the shear modulus: corrections of the multigrid method
/// nearly conserve volumes, and the remaining change must not hide that the body has lost its stiffness.
constexpr float most_lambda_over_mu = 10.0f;

/// The least number of motions; fewer may have missed the softest one.
constexpr long fewest_evaluations = 3, most_evaluations = 100;

/// The largest number of motions kept, and the number to which they are reduced.
constexpr std::size_t most_kept = 12, fewest_kept = 4;

/// A start may by accident contain little of some motion. If the smallest eigenvalue is below this, it must
/// have settled to a share of itself, and another start follows.
constexpr double clearly = 0.1, little = 0.1, first_phase = 1.0, second_phase = 2.3;

/// Motions that lower the potential are accepted if this many steps have not reduced the residual to this
/// share.
constexpr int most_stalled = 4;
constexpr double much_less = 0.7;

/// Davidson's method for K x = theta A x, where K is the tangent and A the model problem's matrix, both with
/// the same limited resistance to volume changes: in the space of the motions so far, the Rayleigh quotient
/// is made stationary, and the residual of the smallest one, preconditioned by a multigrid cycle, is the next
/// motion.
template <class Real>
class Davidson {
 public:
  Davidson(MixedBody<Real>& mixed, const NodalField& points)
      : mixed_(mixed), elements_(mixed.multigrid().elements()), points_(points) {
    resistance_.resize(elements_.zero().p.size());
    for (std::size_t c = 0; c < resistance_.size(); ++c) {
      const ElementTangent& t = elements_.tangents()[c];
      const float lambda =
          mixed.pressure_varies() ? t.lambda : std::min(t.lambda, most_lambda_over_mu * t.mu);
      if (t.volume > 0.0f) resistance_[c] = lambda / t.volume;
    }
    // The rounding of differences, and their second-order error.
    length_ = std::pow(static_cast<double>(std::numeric_limits<Real>::epsilon()), 0.4);
    found_.resolved = 2.0 * length_;
  }

  SoftestMotions find() {
    Eigenpairs small;
    MixedVector next = start(first_phase);
    if (!(dot(next, next, blocks()) > 0.0)) found_.least = 1.0;  // nothing can move
    bool once_more = true;
    long fewest = fewest_evaluations;
    for (int stalled = 0; expand(next); ++stalled) {
      small = symmetric_eigenpairs(between_motions());
      const double before = found_.least;
      const auto [residual, falling] = examine(small, next);
      if (residual < much_less * least_residual_ || falling != falling_) stalled = 0;
      if (stalled == 0) least_residual_ = residual;
      falling_ = falling;
      const bool settled = found_.least > clearly || before - found_.least < little * found_.least;
      const bool done = (falling > 0 && (residual < found_.resolved || stalled >= most_stalled)) ||
                        (found_.evaluations >= fewest && found_.resists() && settled);
      if (done && (found_.least > clearly || !std::exchange(once_more, false))) break;
      if (done) {
        next = start(second_phase);
        fewest = found_.evaluations + fewest_evaluations;
        stalled = -1;
      }
      if (found_.evaluations >= most_evaluations) break;
      if (motions_.size() == most_kept) {
        restart(small);
        small = symmetric_eigenpairs(between_motions());
      }
    }
    for (std::size_t k = 0; k < falling_; ++k)
      found_.falling.push_back(combination(small.vectors[k], &Motion::direction));
    return std::move(found_);
  }

 private:
  struct Motion {
    MixedVector direction;   // m
    MixedVector model;       // A times it, N
    MixedVector resistance;  // K times it, N
  };

  const MixedBlocks& blocks() const { return elements_.blocks(); }

  /// Sets the smallest eigenvalue and its error, and `next` to the largest preconditioned residual: of the
  /// smallest one alone or, because potentials will be compared along them, of the first two motions that
  /// lower the potential. Returns its norm, and the number of such motions.
  std::pair<double, std::size_t> examine(const Eigenpairs& small, MixedVector& next) {
    const std::vector<double>& values = small.values;
    found_.least = values[0];
    std::size_t falling = 0;
    while (falling < std::min<std::size_t>(2, values.size()) && values[falling] < -found_.resolved) ++falling;
    double largest = -1.0;
    for (std::size_t k = 0; k < std::max<std::size_t>(1, falling); ++k) {
      MixedVector correction = elements_.zero();
      const double residual = correct(values[k], small.vectors[k], correction);
      if (k == 0) {
        const double gap = values.size() > 1 ? values[1] - values[0] : 0.0;
        found_.error = gap > residual ? residual * residual / gap : residual;
      }
      if (residual > largest) {
        largest = residual;
        next = std::move(correction);
      }
    }
    return {largest, falling};
  }

  /// Forces of every wavelength, which depend on positions only, and the same forces smoothed. Of the model
  /// problem's answers, the smoothed one contains the softest motions, the other some of all.
  MixedVector start(double first) {
    const auto [low, high] = bounding_box(points_);
    const double size = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
    MixedVector r = elements_.zero(), rough = r, smooth = r, forces = r;
    const auto& diagonal = elements_.stiffness();
    for (std::size_t row = 0; row < elements_.layout().nodes; ++row) {
      const Vector& X = points_[at(elements_.layout().node_of_row[row])];
      double phase = first;
      for (std::size_t i = 0; i < 3; ++i)
        phase += (7.3 + 5.1 * static_cast<double>(i)) * (X[i] - low[i]) / size;
      for (std::size_t i = 0; i < 3; ++i) {
        const double wave = std::sin(3000.0 * std::pow(phase + static_cast<double>(i), 2));
        r.u[row][i] = elements_.free()[row][i] * static_cast<float>(wave) * std::sqrt(diagonal[row][i]);
      }
    }
    const auto answer = [&](MixedVector& x) {
      mixed_.multigrid().cycle(r, x);
      std::fill(x.p.begin(), x.p.end(), 0.0f);
      const double energy = energy_of(x, forces);
      multiply(energy > 0.0 ? static_cast<float>(1.0 / std::sqrt(energy)) : 0.0f, x, blocks());
    };
    answer(rough);
    for (std::size_t row = 0; row < r.u.size(); ++row) {
      for (std::size_t i = 0; i < 3; ++i)
        r.u[row][i] = elements_.free()[row][i] * diagonal[row][i] * rough.u[row][i];
    }
    answer(smooth);
    add(0.5f, rough, smooth, blocks());
    return smooth;
  }

  /// The norm of the residual of an eigenpair of the small problem; sets `correction` to the preconditioned
  /// residual.
  double correct(double value, const std::vector<double>& shares, MixedVector& correction) {
    MixedVector r = combination(shares, &Motion::resistance);
    add(static_cast<float>(-value), combination(shares, &Motion::model), r, blocks());
    mixed_.multigrid().cycle(r, correction);
    return std::sqrt(std::max(0.0, dot(r.u, correction.u, blocks().u)));
  }

  /// x with the pressures that resist its volume changes.
  MixedVector with_pressures(const MixedVector& x) const {
    MixedVector both = x;
    elements_.divergence(x.u, both.p);
    for (std::size_t c = 0; c < both.p.size(); ++c) both.p[c] *= resistance_[c];
    return both;
  }

  /// x A x; sets `forces` to A x.
  double energy_of(const MixedVector& x, MixedVector& forces) const {
    elements_.apply(with_pressures(x), forces);
    std::fill(forces.p.begin(), forces.p.end(), 0.0f);
    for (std::size_t row = 0; row < forces.u.size(); ++row) {
      for (std::size_t i = 0; i < 3; ++i) forces.u[row][i] *= elements_.free()[row][i];
    }
    return dot(x, forces, blocks());
  }

  /// Adds the part of a motion that is independent of the earlier ones; false if there is none.
  bool expand(MixedVector x) {
    std::fill(x.p.begin(), x.p.end(), 0.0f);
    Motion motion{x, elements_.zero(), elements_.zero()};
    MixedVector& direction = motion.direction;
    for (int round = 0; round < 2; ++round) {
      for (const Motion& other : motions_)
        add(static_cast<float>(-dot(other.model, direction, blocks())), other.direction, direction, blocks());
      const double energy = energy_of(direction, motion.model);
      if (!(energy > 0.0) || !std::isfinite(energy)) return false;
      const auto scale = static_cast<float>(1.0 / std::sqrt(energy));
      multiply(scale, direction, blocks());
      multiply(scale, motion.model, blocks());
    }
    mixed_.differentiate(direction, length_ / elements_.largest_gradient(direction.u),
                         static_cast<double>(most_lambda_over_mu), motion.resistance.u);
    ++found_.evaluations;
    std::vector<double> row;
    for (const Motion& other : motions_) {
      row.push_back(0.5 * (dot(other.direction, motion.resistance, blocks()) +
                           dot(motion.direction, other.resistance, blocks())));
    }
    row.push_back(dot(motion.direction, motion.resistance, blocks()));
    if (!std::isfinite(row.back())) return false;
    motions_.push_back(std::move(motion));
    stiffness_.push_back(std::move(row));
    return true;
  }

  /// All entries of the stiffness between the motions.
  std::vector<double> between_motions() const {
    const std::size_t n = motions_.size();
    std::vector<double> entries(n * n);
    for (std::size_t i = 0; i < n; ++i) std::ranges::copy(stiffness_[i], entries.data() + i * n);
    return entries;
  }

  MixedVector combination(const std::vector<double>& shares, MixedVector Motion::*of) const {
    MixedVector sum = elements_.zero();
    for (std::size_t k = 0; k < motions_.size(); ++k)
      add(static_cast<float>(shares[k]), motions_[k].*of, sum, blocks());
    return sum;
  }

  /// Keeps the softest motions, between which the stiffness is diagonal.
  void restart(const Eigenpairs& small) {
    std::vector<Motion> motions;
    stiffness_.clear();
    for (std::size_t k = 0; k < fewest_kept; ++k) {
      motions.push_back({combination(small.vectors[k], &Motion::direction),
                         combination(small.vectors[k], &Motion::model),
                         combination(small.vectors[k], &Motion::resistance)});
      stiffness_.emplace_back(k + 1).back() = small.values[k];
    }
    motions_ = std::move(motions);
  }

  MixedBody<Real>& mixed_;
  const ElementLevel& elements_;
  const NodalField& points_;
  std::vector<float> resistance_;  // Pa/m^3, by cell
  double length_;
  std::vector<Motion> motions_;                 // A-orthonormal
  std::vector<std::vector<double>> stiffness_;  // between them, the lower triangle by rows
  double least_residual_ = 0.0;
  std::size_t falling_ = 0;  // motions that lower the potential, at most two
  SoftestMotions found_;
};

}  // namespace

template <class Real>
SoftestMotions softest_motions(MixedBody<Real>& mixed, const NodalField& points) {
  return Davidson<Real>(mixed, points).find();
}

template SoftestMotions softest_motions(MixedBody<double>&, const NodalField&);
template SoftestMotions softest_motions(MixedBody<float>&, const NodalField&);

}  // namespace sandglass
