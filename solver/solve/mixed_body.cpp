#include "solve/mixed_body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "assembly/method_entry.hpp"
#include "math/row_loops.hpp"
#include "solve/model_moduli.hpp"
#include "solve/span.hpp"

namespace sandglass {

namespace {

/// Smaller changes of displacement gradients do not impair the multigrid method.
constexpr float hardly_changed = 0.1f;

/// The share of the smoother's diagonal that is added to the cycle, which pressures could make indefinite.
constexpr float added_diagonal = 0.5f;

/// A displacement is rounded by half an epsilon. The stiffness of all elements at a node, at most three times
/// the diagonal, turns this into forces; the arithmetic of an element rounds a few times as much.
template <class Real>
constexpr double rounding = 8.0 * static_cast<double>(std::numeric_limits<Real>::epsilon());

/// Reactions above this share of the force that a node of the undeformed body would bear are never rounding.
constexpr double most_rounding = 1e-4;

/// The multigrid method prepares steps as if lambda were no larger, in shear moduli: this changes the step by
/// a hundredth of a percent, and the coarsest grid, which eliminates pressures, does not lose mu in the
/// rounding of lambda.
constexpr double most_lambda_over_mu = 1e4;

/// With obstacles it is that of Poisson's ratio 0.49. Stiff springs of contact hold all nodes of some boxes
/// of the grids, where then only 1 / lambda limits the pressures: with a larger lambda they would grow far
/// beyond those of the elements.
constexpr double most_lambda_over_mu_in_contact = 50.0;

/// The share of forces in the diagonal of the stiffness, N/m; empty if there is none.
Rows<float> stiffness_of_forces(const Scene& scene, const Layout& layout) {
  Rows<float> stiffness(layout.rows());
  for (const auto& force : scene.forces) force->add_stiffness({stiffness.data(), layout.row_of_node});
  const auto is_zero = [](const Row<float>& row) { return row.x == Row<float>{}.x; };
  return std::ranges::all_of(stiffness, is_zero) ? Rows<float>{} : stiffness;
}

/// As each spring remembers at least one row.
std::size_t springs_at_most(const BodyForces& forces) {
  std::size_t most = 0;
  for (const ContactForce* contact : contacts_of(forces)) most += contact->memory();
  return most;
}

}  // namespace

template <class Real>
MixedBody<Real>::MixedBody(const Model& model, const InternalForce<Real>& elements)
    : elements_(elements),
      body_(model, elements),
      materials_(model.scene().materials),
      moduli_(model_moduli(model)),
      stiffening_(model),
      linear_(method_named(model.choice().method).is_linear),
      pressure_varies_(method_named(model.choice().method).pressure_varies),
      free_(body_.on_free_components(std::vector<double>(elements.layout().nodes, 1.0))),
      multigrid_(model.scene().mesh, model.scene().ties, model.scene().coarser, elements.layout(),
                 rounded_rows<float>(free_), stiffness_of_forces(model.scene(), elements.layout())),
      linearized_at_(free_.size()),
      most_springs_(springs_at_most(model.scene().forces)),
      p_(model.scene().mesh.cells.size()),
      defect_(p_.size()),
      pressure_force_(free_.size()),
      weights_(multigrid_.elements()),
      residuals_(multigrid_.elements().zero()),
      scratch_(residuals_) {
  for (const ModelModuli& moduli : moduli_) lambdas_.push_back(moduli.lambda);
  linearize();
  double stiffest = 0.0;
  for (const Row<float>& k : multigrid_.elements().stiffness()) {
    for (std::size_t i = 0; i < 3; ++i) stiffest = std::max(stiffest, static_cast<double>(k[i]));
  }
  const double amplification = std::max(1.0, largest_lambda_over_mu(materials_));  // of the rounding of J - 1
  unfelt_ = std::min(rounding<Real> * amplification, most_rounding) * stiffest;
  farthest_ = span(model.scene().mesh.points) + largest_imposed(model.scene());
}

template <class Real>
bool MixedBody<Real>::contact_changed() {
  if (!may_touch()) return false;
  contact_now_ = body_.springs_of_contact();
  return differ(contact_now_, contact_, hardly_changed);
}

template <class Real>
void MixedBody<Real>::linearize_contact() {
  if (!contact_changed()) return;
  contact_ = contact_now_;
  multigrid_.set_contact(contact_);
  if (linearized_) multigrid_.update_contact();
}

template <class Real>
void MixedBody<Real>::set_drags() {
  const bool dragged = !drags_.empty();
  drags_ = drags_of(contact_, free_);
  if (dragged || !drags_.empty()) compare();
}

template <class Real>
void MixedBody<Real>::linearize(double penalty) {
  Rows<float> u = linear_ ? Rows<float>(free_.size()) : rounded_rows<float>(body_.state().u);
  if (penalty == linearized_penalty_) {
    if (!linearized_) update_multigrid();
    Rows<float> change = u;
    for (std::size_t row = 0; row < change.size(); ++row) {
      for (std::size_t i = 0; i < 3; ++i) change[row][i] -= linearized_at_[row][i];
    }
    if (multigrid_.elements().largest_gradient(change) < double{hardly_changed}) return linearize_contact();
  }
  linearized_at_ = std::move(u);
  linearized_penalty_ = penalty;
  linearized_ = false;
  linearize_contact();
  update_multigrid();
}

template <class Real>
void MixedBody<Real>::update_multigrid() {
  std::vector<ModelModuli> moduli = moduli_;
  const std::vector<double> lambdas = remaining(linearized_penalty_);
  const double most = may_touch() ? most_lambda_over_mu_in_contact : most_lambda_over_mu;
  for (std::size_t m = 0; m < moduli.size(); ++m)
    moduli[m].lambda = std::min(lambdas[m], most * moduli[m].mu);
  multigrid_.update(linearized_at_, moduli, stiffening_.by_cell(linearized_at_, body_.layout()));
  linearized_ = true;
}

template <class Real>
std::vector<double> MixedBody<Real>::remaining(double penalty) const {
  std::vector<double> lambdas = lambdas_;
  for (std::size_t m = 0; m < lambdas.size(); ++m) {
    if (penalty < INFINITY) lambdas[m] = 1.0 / (1.0 / lambdas[m] + 1.0 / (penalty * moduli_[m].mu));
  }
  return lambdas;
}

template <class Real>
auto MixedBody<Real>::multipliers(double penalty) const -> Multipliers {
  const std::vector<double> left = remaining(penalty);
  Multipliers multipliers{p_, penalty, lambdas_};
  for (std::size_t m = 0; m < left.size(); ++m) multipliers.given_up[m] -= left[m];
  for (std::size_t e = 0; e < p_.size(); ++e) {
    const std::size_t m = materials_.of(e);
    multipliers.pressures[e] *= static_cast<Real>(multipliers.given_up[m] / lambdas_[m]);
  }
  return multipliers;
}

template <class Real>
void MixedBody<Real>::weigh() {
  weights_.set_forces(multigrid_.elements());
  for_each_element([&](std::size_t e, std::size_t c) {
    weights_.set_pressure(c, moduli_[materials_.of(e)].mu, volume(e));
  });
}

template <class Real>
void MixedBody<Real>::evaluate() {
  evaluate_forces();
  compare();
}

/// Forces that depend on the path have taken the increment into their history: another evaluation in the same
/// place must not take it again.
template <class Real>
void MixedBody<Real>::evaluate_forces() {
  body_.evaluate_forces();
  if (elements_.needs_increment()) std::ranges::fill(body_.state().increment, Row<Real>{});
  ++evaluations_;
  residual_ = body_.residual();
}

template <class Real>
void MixedBody<Real>::replace_pressures(const std::vector<Real>& pressures,
                                        const std::vector<double>& lambdas) {
  elements_.replace_pressures(body_.state(), pressures, lambdas, pressure_force_, defect_);
  body_.ties().hand_on(pressure_force_);
}

template <class Real>
void MixedBody<Real>::compare() {
  replace_pressures(p_, lambdas_);
  const Real *f = numbers_of(body_.free_forces()), *g = numbers_of(pressure_force_),
             *free = numbers_of(free_);
  float* r = numbers_of(residuals_.u);
  multigrid_.elements().blocks().u.for_each([=](std::size_t first, std::size_t last) {
#pragma omp simd
    for (std::size_t k = first; k < last; ++k) r[k] = static_cast<float>(f[k] + free[k] * g[k]);
  });
  replace_drags(drags_, residuals_.u);
  for_each_element([&](std::size_t e, std::size_t c) { residuals_.p[c] = static_cast<float>(defect_[e]); });
  weigh(residuals_);
}

template <class Real>
void MixedBody<Real>::differentiate(const MixedVector& direction, double length, double most_lambda_over_mu,
                                    Rows<float>& change) {
  const auto step = static_cast<Real>(length);
  State<Real> state = body_.state();
  for (std::size_t row = 0; row < free_.size(); ++row) {
    for (std::size_t i = 0; i < 3; ++i) state.u[row][i] += step * static_cast<Real>(direction.u[row][i]);
  }
  body_.ties().follow(state.u);
  Rows<Real> f(free_.size()), before = body_.free_forces();
  body_.evaluate_forces(state, f);
  const auto replace = [&](const State<Real>& at, const std::vector<Real>& p) {
    elements_.replace_pressures(at, p, lambdas_, pressure_force_, defect_);
    body_.ties().hand_on(pressure_force_);
  };
  const auto add_pressures = [&](Rows<Real>& forces) {
    for (std::size_t row = 0; row < forces.size(); ++row) {
      for (std::size_t i = 0; i < 3; ++i) forces[row][i] += free_[row][i] * pressure_force_[row][i];
    }
  };
  if (!pressure_varies_) {
    std::vector<Real> p = p_;
    replace(body_.state(), p_);
    add_pressures(before);
    const std::vector<Real> defect = defect_;
    replace(state, p_);
    for_each_element([&](std::size_t e, std::size_t) {
      const double resists = std::min(lambda(e), most_lambda_over_mu * moduli_[materials_.of(e)].mu);
      p[e] += static_cast<Real>(resists / volume(e)) * (defect_[e] - defect[e]);
    });
    replace(state, p);
    add_pressures(f);
  }
  for (std::size_t row = 0; row < f.size(); ++row) {
    for (std::size_t i = 0; i < 3; ++i)
      change[row][i] = static_cast<float>((f[row][i] - before[row][i]) / step);
  }
}

template <class Real>
template <class Term>
double MixedBody<Real>::sum_over_components(const Term& term) const {
  const float* k = numbers_of(multigrid_.elements().stiffness());
  const Real* u = numbers_of(body_.state().u);
  return multigrid_.elements().blocks().u.sum([&](std::size_t first, std::size_t last) {
    double sum = 0.0;
    for (std::size_t n = first; n < last; ++n)
      sum += term(static_cast<double>(k[n]), static_cast<double>(u[n]));
    return sum;
  });
}

template <class Real>
bool MixedBody<Real>::at_rounding(bool in_both) {
  const double energy = sum_over_components([](double k, double u) { return k * u * u; });
  const double limit = rounding<Real> * std::sqrt(energy);
  if (in_both && norm() <= limit) return true;
  const MixedBlocks& blocks = multigrid_.elements().blocks();
  const Real* f = numbers_of(body_.free_forces());
  float* forces = numbers_of(scratch_.u);
  blocks.u.for_each([=](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) forces[k] = static_cast<float>(f[k]);
  });
  std::fill(scratch_.p.begin(), scratch_.p.end(), 0.0f);
  weigh(scratch_);
  return std::sqrt(dot(scratch_, scratch_, blocks)) <= limit;
}

template <class Real>
bool MixedBody<Real>::bears_nothing() const {
  const double most = farthest_ * farthest_;
  const double square = sum_over_components([most](double, double u) { return std::min(u * u, most); });
  return body_.carried() <= unfelt_ * std::sqrt(square);
}

template <class Real>
void MixedBody<Real>::correct(const MixedVector& weighted, MixedVector& step) {
  // The range of single precision is small.
  const MixedBlocks& blocks = multigrid_.elements().blocks();
  const double size = std::sqrt(dot(weighted, weighted, blocks));
  weights_.divide(static_cast<float>(size > 0.0 ? -1.0 / size : 1.0), weighted, scratch_, blocks);
  multigrid_.cycle(scratch_, step);
  multiply(static_cast<float>(size), step, blocks);
}

template <class Real>
void MixedBody<Real>::precondition(const MixedVector& r, MixedVector& z) {
  multigrid_.cycle(r, z);
  std::fill(z.p.begin(), z.p.end(), 0.0f);
  multigrid_.elements().relax(added_diagonal, r.u, z.u);
}

template <class Real>
void MixedBody<Real>::move(const MixedVector& step, double share) {
  const auto factor = static_cast<Real>(share);
  const float* s = numbers_of(step.u);
  if (may_touch()) before_ = body_.state().u;
  Real *u = numbers_of(body_.state().u), *increment = numbers_of(body_.state().increment);
  multigrid_.elements().blocks().u.for_each([=](std::size_t first, std::size_t last) {
#pragma omp simd
    for (std::size_t k = first; k < last; ++k) {
      increment[k] = factor * static_cast<Real>(s[k]);
      u[k] += increment[k];
    }
  });
  for_each_element([&](std::size_t e, std::size_t c) { p_[e] += factor * static_cast<Real>(step.p[c]); });
  slide();
  body_.follow();
}

/// Moves touching nodes, where they are free, along obstacles.
template <class Real>
void MixedBody<Real>::slide() {
  if (!may_touch()) return;
  Rows<Real>&u = body_.state().u, &increment = body_.state().increment;
  slid_ = u;
  body_.slide(before_, slid_);
  for (std::size_t row = 0; row < u.size(); ++row) {
    for (std::size_t i = 0; i < 3; ++i) {
      u[row][i] += free_[row][i] * (slid_[row][i] - u[row][i]);
      increment[row][i] = u[row][i] - before_[row][i];
    }
  }
}

template <class Real>
void MixedBody<Real>::take_own_pressures() {
  std::fill(p_.begin(), p_.end(), Real(0));
  replace_pressures(p_, lambdas_);
  for (std::size_t e = 0; e < p_.size(); ++e) {
    p_[e] = static_cast<Real>(lambda(e) * static_cast<double>(defect_[e]) / volume(e));
  }
}

template <class Real>
void MixedBody<Real>::average_pressures(const std::vector<int>& element_of) {
  std::vector<double> volumes(p_.size(), 0.0), sums(p_.size(), 0.0);  // of the coarser mesh, which is smaller
  for (std::size_t e = 0; e < p_.size(); ++e) {
    volumes[at(element_of[e])] += volume(e);
    sums[at(element_of[e])] += volume(e) * static_cast<double>(p_[e]);
  }
  for (std::size_t e = 0; e < p_.size(); ++e) {
    const auto whole = at(element_of[e]);
    p_[e] = static_cast<Real>(sums[whole] / volumes[whole]);
  }
}

template <class Real>
void MixedBody<Real>::evaluate(const Multipliers* multipliers, Rows<Real>& f) {
  evaluate_forces();
  f = body_.free_forces();
  if (multipliers == nullptr) return;
  replace_pressures(multipliers->pressures, multipliers->given_up);
  for (std::size_t row = 0; row < f.size(); ++row) {
    for (std::size_t i = 0; i < 3; ++i) f[row][i] += free_[row][i] * pressure_force_[row][i];
  }
}

template <class Real>
double MixedBody<Real>::potential(const Multipliers* multipliers) const {
  const StrainEnergies energies = body_.energies();
  const double sum = energies.strain + energies.hourglass + body_.load_potential();
  if (multipliers == nullptr) return sum;
  return sum + multigrid_.elements().blocks().p.sum([&](std::size_t first, std::size_t last) {
    double work = 0.0;
    for (std::size_t c = first; c < last; ++c) {
      if (body_.layout().elements[c] < 0) continue;
      const auto e = at(body_.layout().elements[c]);
      const auto m = static_cast<double>(multipliers->pressures[e]);
      const double change = volume_change(e, *multipliers);
      work += volume(e) * change * (m - 0.5 * multipliers->given_up[materials_.of(e)] * change);
    }
    return work;
  });
}

template <class Real>
void MixedBody<Real>::take_pressures(const Multipliers& multipliers) {
  for (std::size_t e = 0; e < p_.size(); ++e) {
    const auto m = static_cast<double>(multipliers.pressures[e]);
    const double left = lambda(e) - multipliers.given_up[materials_.of(e)];
    p_[e] = static_cast<Real>(m + left * volume_change(e, multipliers));
  }
}

template class MixedBody<double>;
template class MixedBody<float>;

}  // namespace sandglass
