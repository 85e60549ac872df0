#include "solve/loads.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace sandglass {

template <class Real>
Loads<Real>::Loads(const Scene& scene, const Layout& layout)
    : curves_(scene.curves),
      contacts_(contacts_of(scene.forces)),
      moves_nodes_(std::ranges::any_of(contacts_, [](const auto* one) { return one->moves_nodes(); })),
      pushes_(std::ranges::any_of(contacts_, [](const auto* one) { return !one->moves_nodes(); })),
      ranks_(layout.team.ranks),
      place_of_node_(scene.mesh.points.size(), -1),
      all_dead_(std::ranges::all_of(scene.forces,
                                    [](const auto& force) {
                                      const auto* contact = dynamic_cast<const ContactForce*>(force.get());
                                      return contact != nullptr ? contact->moves_nodes()
                                                                : !force->dead_loads().empty();
                                    })),
      factors_(factors_at(0.0, 0.0)),
      movable_(movable_of(scene.forces)) {
  const auto place_nodes = [&](bool dead) {
    std::vector<bool> loaded(place_of_node_.size());
    for (const auto& force : scene.forces) {
      if (force->dead_loads().empty() == dead) continue;
      for (const int node : force->nodes()) loaded[at(node)] = place_of_node_[at(node)] < 0;
    }
    for (std::size_t n = 0; n < loaded.size(); ++n) {
      if (!loaded[n]) continue;
      place_of_node_[n] = static_cast<int>(rows_.size());
      rows_.push_back(at(layout.row_of_node[n]));
      owned_.push_back(layout.owns(static_cast<int>(n)));
    }
  };
  place_nodes(false);
  u_ = increment_ = Rows<double>(rows_.size());
  if (!contacts_.empty()) touching_ = masses_ = u_;
  if (moves_nodes_) pushes_of_step_ = last_increment_ = u_;
  place_nodes(true);
  forces_ = forces_before_ = u_before_ = Rows<double>(rows_.size());
  for (const auto& force : scene.forces) {
    if (std::ranges::find(contacts_, force.get()) == contacts_.end()) loads_.push_back(force.get());
  }
  std::size_t remembered = 0;
  for (const ContactForce* contact : contacts_) {
    memory_of_.push_back(remembered);
    remembered += contact->memory();
  }
  memory_ = memory_before_ = Rows<double>(remembered);
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
void Loads<Real>::begin_again(const Reactions& forces, const Reactions& moments) {
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    Row<double>* memory = memory_.data() + memory_of_[c];
    const std::string name(contacts_[c]->touch(memory).name);
    const auto moment = moments.find(name);  // of obstacles only
    contacts_[c]->begin_again(forces.at(name), moment == moments.end() ? Vector{} : moment->second, memory);
  }
  std::fill(last_increment_.begin(), last_increment_.end(), Row<double>{});
  has_pushed_ = 0.0;
}

template <class Real>
void Loads<Real>::move_obstacles(std::span<const double> moves) {
  for (std::size_t k = 0; k < moves.size(); ++k) factors_[movable_[k / 3].first_curve + k % 3] = moves[k];
}

template <class Real>
Rows<double> Loads<Real>::loaded(const Rows<Real>& all) const {
  Rows<double> rows(rows_.size());
  take(all, rows);
  return rows;
}

template <class Real>
void Loads<Real>::take(const Rows<Real>& all, Rows<double>& loaded) const {
  for (std::size_t k = 0; k < loaded.size(); ++k) {
    for (std::size_t i = 0; i < 4; ++i) loaded[k][i] = static_cast<double>(all[rows_[k]][i]);
  }
}

template <class Real>
void Loads<Real>::subtract(const State<Real>& state, Rows<Real>& force) {
  if (loads_.empty() && !pushes_) return;
  if (!all_dead_) {
    take(state.u, u_);
    take(state.increment, increment_);
  }
  std::fill(forces_.begin(), forces_.end(), Row<double>{});
  const Rows<double>&u = u_, &increment = increment_;
  const NodalMotion motion{by_node(u.data()), by_node(increment.data()), static_cast<double>(state.step)};
  for (const auto* one : loads_) one->add_forces(factors_, motion, by_node(forces_.data()));
  // Dead forces are known on all ranks, others on ranks that know the displacements.
  if (!all_dead_) gather({numbers_of(forces_), 4 * rows_.size()});
  Row<double> squares{};  // a sum of its own for each component, as additions wait for one another
  const auto take_off = [&](std::size_t k, const Row<double>& one) {
    for (std::size_t i = 0; i < 3; ++i) {
      force[rows_[k]][i] -= static_cast<Real>(one[i]);
      squares[i] += one[i] * one[i];
    }
  };
  for (std::size_t k = 0; k < rows_.size(); ++k) take_off(k, forces_[k]);
  if (pushes_) {
    std::fill(touching_.begin(), touching_.end(), Row<double>{});
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
      contacts_[c]->add_contact(factors_, motion.u, memory_.data() + memory_of_[c],
                                by_node(touching_.data()));
    }
    for (std::size_t k = 0; k < touching_.size(); ++k) take_off(k, touching_[k]);
  }
  square_ = squares[0] + squares[1] + squares[2];
}

template <class Real>
void Loads<Real>::subtract_derivatives_of_power(const State<Real>& state, const Rows<Real>& w,
                                                Rows<Real>& by_u, Rows<Real>& by_increment) const {
  if (all_dead_) return;
  const Rows<double> u = loaded(state.u), increment = loaded(state.increment), v = loaded(w);
  Rows<double> of_u(rows_.size()), of_increment(rows_.size());
  const NodalMotion motion{by_node(u.data()), by_node(increment.data()), static_cast<double>(state.step)};
  for (const auto* one : loads_) {
    one->add_derivatives_of_power(factors_, motion, by_node(v.data()), by_node(of_u.data()),
                                  by_node(of_increment.data()));
  }
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      by_u[rows_[k]][i] -= static_cast<Real>(of_u[k][i]);
      by_increment[rows_[k]][i] -= static_cast<Real>(of_increment[k][i]);
    }
  }
}

/// A push acts between two steps, so its work is the product with the mean of their motions. The first acts
/// for half a step: if it changes the velocity v of a mass m by d, its work is m d (v + d / 2).
template <class Real>
bool Loads<Real>::push_out(State<Real>& state, const Rows<Real>& inverse_masses, double gain) {
  if (!moves_nodes_) return false;
  take(state.u, u_);
  take(state.increment, increment_);
  take(inverse_masses, masses_);
  const Rows<double>&masses = masses_, &last = last_increment_;
  pushes_of_step_ = increment_;
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    contacts_[c]->push_out(factors_, {by_node(u_.data()), by_node(increment_.data()), by_node(last.data()),
                                      by_node(masses.data()), gain, memory_.data() + memory_of_[c]});
  }
  for (std::size_t k = 0; k < pushes_of_step_.size(); ++k) {
    Row<double>& push = pushes_of_step_[k];  // so far the increment that the node had
    if (push.x == increment_[k].x) {         // as most have
      push = {};
      continue;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      state.u[rows_[k]][i] = static_cast<Real>(u_[k][i]);
      state.increment[rows_[k]][i] = static_cast<Real>(increment_[k][i]);
      const double now = increment_[k][i], by = now - push[i];
      const double before = has_pushed_ != 0.0 ? last[k][i] : -0.5 * by;
      push[i] = by != 0.0 ? by / (masses[k][i] * gain) : 0.0;
      work_of_pushes_ += 0.5 * push[i] * (before + now);
    }
  }
  std::swap(last_increment_, increment_);
  has_pushed_ = 1.0;
  return true;
}

template <class Real>
void Loads<Real>::subtract_pushes(Rows<Real>& force) const {
  for (std::size_t k = 0; k < pushes_of_step_.size(); ++k) {
    for (std::size_t i = 0; i < 3; ++i) force[rows_[k]][i] -= static_cast<Real>(pushes_of_step_[k][i]);
  }
}

template <class Real>
double Loads<Real>::lost_by_pushes() const {
  double lost = -work_of_pushes_;
  for_each_touch([&](const Touch& touch) { lost += touch.worked; });
  return lost;
}

template <class Real>
Rows<Real> Loads<Real>::change_to(double time, double load_factor, const Rows<Real>& u) const {
  const std::vector<double> factors = factors_at(time, load_factor);
  std::vector<double> changes = factors;
  for (std::size_t c = 0; c < changes.size(); ++c) changes[c] -= factors_[c];
  const Rows<double> there = loaded(u);
  const NodalMotion motion{by_node(there.data()), by_node(there.data()), 0.0};
  Rows<double> sums(rows_.size());
  for (const auto* load : loads_) {
    if (load->traits().drives) load->add_forces(changes, motion, by_node(sums.data()));
  }
  Rows<double> before(touching_.size()), memory = memory_;
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    Row<double>* rows = memory.data() + memory_of_[c];
    contacts_[c]->add_contact(factors_, motion.u, rows, by_node(before.data()));
    contacts_[c]->add_contact(factors, motion.u, rows, by_node(sums.data()));
  }
  for (std::size_t k = 0; k < before.size(); ++k) {
    for (std::size_t i = 0; i < 3; ++i) sums[k][i] -= before[k][i];
  }
  Rows<Real> change(u.size());
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    for (std::size_t i = 0; i < 3; ++i) change[rows_[k]][i] = static_cast<Real>(sums[k][i]);
  }
  return change;
}

template <class Real>
double Loads<Real>::potential(const Rows<Real>& u) const {
  const Rows<double> there = loaded(u);
  double sum = 0.0;
  for (const auto* load : loads_) load->add_potential(factors_, by_node(there.data()), sum);
  for (std::size_t c = 0; c < contacts_.size(); ++c)
    contacts_[c]->add_contact_potential(factors_, by_node(there.data()), memory_.data() + memory_of_[c], sum);
  return sum;
}

template <class Real>
void Loads<Real>::slide(const Rows<Real>& before, Rows<Real>& u) const {
  if (contacts_.empty()) return;
  Rows<double> from(u_.size()), to(u_.size());
  take(before, from);
  take(u, to);
  for (std::size_t c = 0; c < contacts_.size(); ++c)
    contacts_[c]->slide(factors_, by_node(std::as_const(from).data()), memory_.data() + memory_of_[c],
                        by_node(to.data()));
  for (std::size_t k = 0; k < to.size(); ++k) {
    for (std::size_t i = 0; i < 3; ++i) u[rows_[k]][i] = static_cast<Real>(to[k][i]);
  }
}

template <class Real>
void Loads<Real>::fix_contact(Fixing fixing) {
  for (std::size_t c = 0; c < contacts_.size(); ++c)
    contacts_[c]->fix_contact(fixing, memory_.data() + memory_of_[c]);
}

template <class Real>
bool Loads<Real>::augment_contact(Augmentation augmentation) {
  bool any = false;
  for (std::size_t c = 0; c < contacts_.size(); ++c)
    any = contacts_[c]->augment(augmentation, memory_.data() + memory_of_[c]) || any;
  return any;
}

template <class Real>
Touch Loads<Real>::end_level(const Rows<Real>& u, bool may_shorten) {
  const Rows<double> before = memory_;
  const Rows<double> there = loaded(u);
  for (std::size_t c = 0; c < contacts_.size(); ++c)
    contacts_[c]->end_level(factors_, by_node(there.data()), may_shorten, memory_.data() + memory_of_[c]);
  Touch through;
  for_each_touch([&](const Touch& touch) {
    if (touch.passed >= 0) through = touch;
  });
  if (through.passed >= 0) memory_ = before;
  return through;
}

template <class Real>
void Loads<Real>::correct_contact() {
  for (std::size_t c = contacts_.size(); c-- > 0;) {
    if (contacts_[c]->correct_contact(memory_.data() + memory_of_[c])) return;
  }
}

template <class Real>
double Loads<Real>::share_in_reach(const Rows<float>& change) const {
  double share = INFINITY;
  for (const ContactForce* contact : contacts_) {
    if (contact->movable()) continue;  // obstacles limit the levels themselves
    Vector low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
    for (const int node : contact->nodes()) {
      const Row<float>& of_node = change[rows_[at(place_of_node_[at(node)])]];
      for (std::size_t i = 0; i < 3; ++i) {
        low[i] = std::min(low[i], static_cast<double>(of_node[i]));
        high[i] = std::max(high[i], static_cast<double>(of_node[i]));
      }
    }
    share = std::min(share, 0.5 * contact->half_thickness() / distance(high, low));
  }
  return share;
}

template <class Real>
std::vector<Spring> Loads<Real>::springs_of_contact(const Rows<Real>& u) const {
  const Rows<double> there = loaded(u);
  std::vector<Spring> springs;
  for (std::size_t c = 0; c < contacts_.size(); ++c)
    contacts_[c]->add_springs(factors_, by_node(there.data()), memory_.data() + memory_of_[c], springs);
  for (Spring& spring : springs) {
    for (std::size_t n = 0; n < spring.size; ++n)
      spring.nodes[n] = static_cast<int>(rows_[at(place_of_node_[at(spring.nodes[n])])]);
  }
  return springs;
}

template <class Real>
void Loads<Real>::gather(std::span<double> values) const {
  if (owned_.empty() || ranks_->count() == 1) return;
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
  double sum = std::accumulate(all.begin(), all.end(), work_of_obstacles_);
  for_each_touch([&](const Touch& touch) { sum += touch.worked; });
  return sum;
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
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const Touch now = contacts_[c]->touch(memory_.data() + memory_of_[c]),
                then = contacts_[c]->touch(memory_before_.data() + memory_of_[c]);
    for (std::size_t i = 0; i < 3; ++i)
      work_of_obstacles_ += 0.5 * (now.force[i] + then.force[i]) * (now.moved[i] - then.moved[i]);
  }
  std::copy(memory_.begin(), memory_.end(), memory_before_.begin());
}

template <class Real>
Rows<Real> Loads<Real>::by_row(std::size_t rows) const {
  Rows<Real> all(rows);
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    for (std::size_t i = 0; i < 3; ++i) all[rows_[k]][i] = static_cast<Real>(forces_[k][i]);
  }
  return all;
}

template <class Real>
void Loads<Real>::follow(const Rows<Real>& u, const Rows<Real>& loads, std::span<const Real> works) {
  take(u, u_before_);
  take(loads, forces_);
  forces_before_ = forces_;
  square_ = 0.0;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    work_[k] += static_cast<double>(works[rows_[k]]);
    for (std::size_t i = 0; i < 3; ++i) square_ += forces_[k][i] * forces_[k][i];
  }
}

template class Loads<double>;
template class Loads<float>;

}  // namespace sandglass
