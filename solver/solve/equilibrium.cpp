#include "solve/equilibrium.hpp"

#include <numeric>

#include "solve/row_loops.hpp"

namespace sandglass {

namespace {

double dot(const CoarseVector& a, const CoarseVector& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// N sums of products over the rows of a block, each as a vector of lanes.
template <class Real, std::size_t N>
class LaneSums {
 public:
  /// Adds a * b to sum n.
  template <int W>
  void add(std::size_t n, const RowVector<Real, W>& a, const RowVector<Real, W>& b) {
    if constexpr (W == row_vector_width<Real>) {
      wide_[n] += a * b;
    } else {
      single_[n] += a * b;
    }
  }

  double sum(std::size_t n) const { return sum_of_lanes(wide_[n]) + sum_of_lanes(single_[n]); }

 private:
  std::array<RowVector<Real, row_vector_width<Real>>, N> wide_{};
  std::array<RowVector<Real, 4>, N> single_{};
};

/// Sums of the first pass.
struct Comparison {
  ConjugateGradient::TrialSums trial;
  double force_square = 0.0;
  Comparison& operator+=(const Comparison& other) {
    trial += other.trial;
    force_square += other.force_square;
    return *this;
  }
};

}  // namespace

template <class Real>
Equilibrium<Real>::Equilibrium(const Model& model, const InternalForce<Real>& elements)
    : body_(model, elements),
      tells_increment_(elements.needs_increment()),
      preconditioner_(model, elements, body_),
      g_(body_.state().u.size()),
      p_(g_.size()),
      coarse_g_(preconditioner_.coarse_size()),
      coarse_d_(coarse_g_.size()),
      solved_g_(coarse_g_.size()),
      solved_d_(coarse_g_.size()) {}

/// With g and p zero, the first step takes the whole force, in the direction of steepest descent.
template <class Real>
void Equilibrium<Real>::begin() {
  preconditioner_.update(body_);
  method_ = {};
  clear(g_, body_.threads());
  clear(p_, body_.threads());
  std::fill(coarse_g_.begin(), coarse_g_.end(), 0.0);
  std::fill(solved_g_.begin(), solved_g_.end(), 0.0);
}

template <class Real>
void Equilibrium<Real>::start() {
  begin();
  evaluate();
}

template <class Real>
void Equilibrium<Real>::restart() {
  begin();
  compare();
}

template <class Real>
bool Equilibrium<Real>::step() {
  switch (method_.assess(sums_)) {
    case ConjugateGradient::Action::move:
      advance();
      break;
    case ConjugateGradient::Action::retry:
      retry();
      break;
    case ConjugateGradient::Action::fail:
      return false;
  }
  evaluate();
  return true;
}

template <class Real>
void Equilibrium<Real>::evaluate() {
  body_.evaluate_forces();
  ++evaluations_;
  compare();
}

/// Computes the sums with d = f - g, d on the coarse grid, and the residual.
template <class Real>
void Equilibrium<Real>::compare() {
  const Real *f = numbers_of(body_.free_forces()), *g = numbers_of(g_), *p = numbers_of(p_);
  const auto sums =
      sum_over_blocks<Comparison>(4 * g_.size(), body_.threads(), [&](std::size_t first, std::size_t last) {
        LaneSums<Real, 4> lanes;
        for_each_row_vector<Real>(first, last, [&]<int W>(std::size_t k) {
          const auto fk = load<W>(f + k), gk = load<W>(g + k);
          const RowVector<Real, W> d = fk - gk;
          const auto Bd = preconditioner_.template nodal<W>(k, d);
          lanes.template add<W>(0, load<W>(p + k), d);
          lanes.template add<W>(1, gk, Bd);
          lanes.template add<W>(2, d, Bd);
          lanes.template add<W>(3, fk, fk);
        });
        return Comparison{{lanes.sum(0), lanes.sum(1), lanes.sum(2)}, lanes.sum(3)};
      });
  sums_ = sums.trial;
  residual_ = body_.residual(sums.force_square);
  preconditioner_.restrict_to_coarse(body_.free_forces(), coarse_d_, body_.threads());
  for (std::size_t k = 0; k < coarse_d_.size(); ++k) coarse_d_[k] -= coarse_g_[k];
  preconditioner_.solve(coarse_d_, solved_d_);
  sums_.g_P_d += dot(solved_g_, coarse_d_);
  sums_.d_P_d += dot(solved_d_, coarse_d_);
}

/// The updates of ConjugateGradient and the next trial.
template <class Real>
void Equilibrium<Real>::advance() {
  const double move = method_.move();
  for (std::size_t k = 0; k < coarse_g_.size(); ++k) {
    coarse_g_[k] += move * coarse_d_[k];
    solved_g_[k] += move * solved_d_[k];
  }
  preconditioner_.take(solved_g_);
  const auto share = static_cast<Real>(move), turn = static_cast<Real>(method_.turn());
  const auto rest_of_step = static_cast<Real>((move - 1.0) * length_);  // from the trial to the minimum
  const auto length = static_cast<Real>(method_.length());
  const Real* f = numbers_of(body_.free_forces());
  Real *g = numbers_of(g_), *p = numbers_of(p_), *u = numbers_of(body_.state().u);
  Real* increment = tells_increment_ ? numbers_of(body_.state().increment) : nullptr;
  auto sums = sum_over_blocks<ConjugateGradient::DirectionSums>(
      4 * g_.size(), body_.threads(), [&](std::size_t first, std::size_t last) {
        LaneSums<Real, 2> lanes;
        for_each_row_vector<Real>(first, last, [&]<int W>(std::size_t k) {
          const auto g_before = load<W>(g + k), p_before = load<W>(p + k);
          const RowVector<Real, W> gk = g_before + share * (load<W>(f + k) - g_before);
          const auto Bg = preconditioner_.template nodal<W>(k, gk);
          const auto Zc = preconditioner_.template from_coarse<W>(k);
          const RowVector<Real, W> pk = turn * p_before - (Bg + Zc);
          const RowVector<Real, W> step = rest_of_step * p_before + length * pk;
          store(gk, g + k);
          store(pk, p + k);
          store(RowVector<Real, W>(load<W>(u + k) + step), u + k);
          if (increment != nullptr) store(step, increment + k);
          lanes.template add<W>(0, gk, pk);
          lanes.template add<W>(1, gk, Bg);
        });
        return ConjugateGradient::DirectionSums{lanes.sum(0), lanes.sum(1)};
      });
  sums.g_P_g += dot(solved_g_, coarse_g_);
  method_.take(sums);
  length_ = method_.length();
}

/// Moves to another trial along the same direction.
template <class Real>
void Equilibrium<Real>::retry() {
  const auto change = static_cast<Real>(method_.length() - length_);
  length_ = method_.length();
  const Real* p = numbers_of(p_);
  Real* u = numbers_of(body_.state().u);
  Real* increment = numbers_of(body_.state().increment);
  for_each_block(4 * p_.size(), body_.threads(), [=](std::size_t first, std::size_t last) {
#pragma omp simd
    for (std::size_t k = first; k < last; ++k) {
      increment[k] = change * p[k];
      u[k] += increment[k];
    }
  });
}

template class Equilibrium<double>;
template class Equilibrium<float>;

}  // namespace sandglass
