#include "solve/loads.hpp"

#include <algorithm>
#include <numeric>

namespace sandglass {

template <class Real>
Loads<Real>::Loads(const Scene& scene, const Layout& layout)
    : curves_(scene.curves),
      ranks_(layout.team.ranks),
      all_dead_(first_not_dead(scene.forces) == nullptr),
      factors_(factors_at(0.0, 0.0)) {
  std::vector<int> nodes;
  for (const auto& force : scene.forces)
    nodes.insert(nodes.end(), force->nodes().begin(), force->nodes().end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  for (const int node : nodes) {
    rows_.push_back(at(layout.row_of_node[at(node)]));
    owned_.push_back(layout.owns(node));
  }
  for (const auto& force : scene.forces) {
    Placed& placed = placed_.emplace_back(Placed{force, {}});
    for (const int node : force->nodes()) {
      const auto found = std::lower_bound(nodes.begin(), nodes.end(), node);
      placed.places.push_back(static_cast<std::size_t>(found - nodes.begin()));
    }
  }
  u_ = increment_ = forces_ = forces_before_ = u_before_ = Rows<double>(rows_.size());
  work_.resize(rows_.size());
}

template <class Real>
std::vector<double> Loads<Real>::factors_at(double time, double load_factor) const {
  std::vector<double> factors;
  for (const LoadCurve& curve : curves_) factors.push_back(curve.at(time, load_factor));
  return factors;
}

template <class Real>
void Loads<Real>::set(double time, double load_factor) {
  for (std::size_t c = 0; c < factors_.size(); ++c) factors_[c] = curves_[c].at(time, load_factor);
}

template <class Real>
void Loads<Real>::take(const Rows<Real>& all, Rows<double>& loaded) const {
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    for (std::size_t i = 0; i < 3; ++i) loaded[k][i] = static_cast<double>(all[rows_[k]][i]);
  }
}

template <class Real>
void Loads<Real>::subtract(const State<Real>& state, Rows<Real>& force) {
  if (rows_.empty()) return;
  if (!all_dead_) {
    take(state.u, u_);
    take(state.increment, increment_);
  }
  std::fill(forces_.begin(), forces_.end(), Row<double>{});
  for (const Placed& p : placed_) {
    p.force->add_forces(factors_,
                        {p.among(std::as_const(u_).data()), p.among(std::as_const(increment_).data()),
                         static_cast<double>(state.step)},
                        p.among(forces_.data()));
  }
  // Dead forces are known everywhere, the others where the rank knows the displacements.
  if (!all_dead_) gather({numbers_of(forces_), 4 * rows_.size()});
  square_ = 0.0;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      force[rows_[k]][i] -= static_cast<Real>(forces_[k][i]);
      square_ += forces_[k][i] * forces_[k][i];
    }
  }
}

template <class Real>
Rows<Real> Loads<Real>::change_to(double time, double load_factor, const Rows<Real>& u) const {
  std::vector<double> changes = factors_at(time, load_factor);
  for (std::size_t c = 0; c < changes.size(); ++c) changes[c] -= factors_[c];
  Rows<double> there(rows_.size()), sums(rows_.size());
  take(u, there);
  for (const Placed& p : placed_) {
    if (!p.force->traits().drives) continue;
    const auto moved = p.among(std::as_const(there).data());
    p.force->add_forces(changes, {moved, moved, 0.0}, p.among(sums.data()));
  }
  Rows<Real> change(u.size());
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    for (std::size_t i = 0; i < 3; ++i) change[rows_[k]][i] = static_cast<Real>(sums[k][i]);
  }
  return change;
}

template <class Real>
double Loads<Real>::potential(const Rows<Real>& u) const {
  Rows<double> there(rows_.size());
  take(u, there);
  double sum = 0.0;
  for (const Placed& p : placed_) p.force->add_potential(factors_, p.among(std::as_const(there).data()), sum);
  return sum;
}

template <class Real>
void Loads<Real>::gather(std::span<double> values) const {
  if (owned_.empty()) return;
  const std::size_t each = values.size() / owned_.size();
  for (std::size_t n = 0; n < values.size(); ++n) {
    if (!owned_[n / each]) values[n] = 0.0;
  }
  ranks_->sum(values);
}

template <class Real>
void Loads<Real>::gather() {
  gather(work_);
  gather({numbers_of(u_before_), 4 * rows_.size()});
}

template <class Real>
double Loads<Real>::work() const {
  std::vector<double> all = work_;
  gather(all);
  return std::accumulate(all.begin(), all.end(), 0.0);
}

template <class Real>
void Loads<Real>::add_work(const Rows<Real>& u) {
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto now = static_cast<double>(u[rows_[k]][i]);
      work_[k] += 0.5 * (forces_[k][i] + forces_before_[k][i]) * (now - u_before_[k][i]);
      u_before_[k][i] = now;
    }
  }
  forces_before_ = forces_;
}

template class Loads<double>;
template class Loads<float>;

}  // namespace sandglass
