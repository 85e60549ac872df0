#include "solve/loads.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sandglass {

namespace {

double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

template <class Real>
Loads<Real>::Loads(const Scene& scene, const Layout& layout)
    : curves_(scene.curves), ranks_(layout.team.ranks) {
  std::vector<int> nodes;
  for (const auto& load : scene.loads) nodes.push_back(load.node);
  for (const auto& pressure : scene.pressures) {
    nodes.insert(nodes.end(), pressure.face.begin(), pressure.face.end());
  }
  for (const auto& support : scene.supports) {
    nodes.insert(nodes.end(), support.face.begin(), support.face.end());
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  const auto at = [&](int node) {
    return static_cast<std::size_t>(std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin());
  };
  for (const int node : nodes) {
    rows_.push_back(static_cast<std::size_t>(layout.row_of_node[static_cast<std::size_t>(node)]));
    owned_.push_back(layout.owns(node));
  }
  for (const auto& load : scene.loads) dead_.push_back({at(load.node), load.curve, load.force});
  const auto all_at = [&](const Quadrilateral& face) {
    return std::array{at(face[0]), at(face[1]), at(face[2]), at(face[3])};
  };
  const NodalField& points = scene.mesh.points;
  for (const auto& [face, pressure, curve] : scene.pressures) {
    faces_.push_back({all_at(face), corners_of(points, face), pressure, curve});
  }
  for (const auto& [face, stiffness, damping, only_normal] : scene.supports) {
    supports_.push_back(
        {all_at(face), gauss_points_of(corners_of(points, face)), stiffness, damping, only_normal});
  }
  forces_ = forces_before_ = u_before_ = Rows<double>(rows_.size());
  work_.resize(rows_.size());
  factors_ = factors_at(0.0, 0.0);
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
std::array<Vector, 4> Loads<Real>::corners(const Rows<Real>& u, const Face& face) const {
  std::array<Vector, 4> x = face.corners;
  for (std::size_t I = 0; I < 4; ++I) {
    const Vector moved = displacement(u, face.at[I]);
    for (std::size_t i = 0; i < 3; ++i) x[I][i] += moved[i];
  }
  return x;
}

template <class Real>
template <class Add>
void Loads<Real>::for_each_load(const std::vector<double>& factors, const Rows<Real>& u,
                                const Add& add) const {
  for (const auto& [at, curve, force] : dead_) {
    const double factor = factors[curve];
    add(at, Vector{factor * force[0], factor * force[1], factor * force[2]});
  }
  for (const Face& face : faces_) {
    const double p = factors[face.curve] * face.pressure;
    if (p == 0.0) continue;
    const auto forces = pressure_forces(corners(u, face));
    for (std::size_t I = 0; I < 4; ++I) {
      add(face.at[I], Vector{p * forces[I][0], p * forces[I][1], p * forces[I][2]});
    }
  }
}

template <class Real>
template <class Use>
void Loads<Real>::for_each_point(const Support& support, const Rows<Real>& field, const Use& use) const {
  for (const FacePoint& point : support.points) {
    Vector t{};
    for (std::size_t I = 0; I < 4; ++I) {
      const Vector v = displacement(field, support.at[I]);
      for (std::size_t i = 0; i < 3; ++i) t[i] += point.N[I] * point.area * v[i];
    }
    if (support.only_normal) {
      const auto& n = point.normal.entries;
      const double along = (n[0] * t[0] + n[1] * t[1] + n[2] * t[2]) / (point.area * point.area);
      t = {along * n[0], along * n[1], along * n[2]};
    }
    use(point.N, t);
  }
}

template <class Real>
void Loads<Real>::subtract(const State<Real>& state, Rows<Real>& force) {
  if (rows_.empty()) return;
  std::fill(forces_.begin(), forces_.end(), Row<double>{});
  for_each_load(factors_, state.u, [&](std::size_t at, const Vector& f) {
    for (std::size_t i = 0; i < 3; ++i) forces_[at][i] += f[i];
  });
  for (const Support& support : supports_) {
    const auto resist = [&](double factor, const Rows<Real>& field) {
      for_each_point(support, field, [&](const std::array<double, 4>& N, const Vector& t) {
        for (std::size_t I = 0; I < 4; ++I) {
          for (std::size_t i = 0; i < 3; ++i) forces_[support.at[I]][i] -= factor * N[I] * t[i];
        }
      });
    };
    resist(support.stiffness, state.u);
    // The velocity is that of half a step before; without time it is zero.
    if (support.damping > 0.0) resist(support.damping / state.step, state.increment);
  }
  // Dead forces are known everywhere, the others where the rank knows the displacements.
  if (!faces_.empty() || !supports_.empty()) gather({numbers_of(forces_), 4 * rows_.size()});
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
  Rows<Real> change(u.size());
  for_each_load(changes, u, [&](std::size_t at, const Vector& f) {
    for (std::size_t i = 0; i < 3; ++i) change[rows_[at]][i] += static_cast<Real>(f[i]);
  });
  return change;
}

template <class Real>
double Loads<Real>::potential(const Rows<Real>& u) const {
  double sum = 0.0;
  for (const auto& [at, curve, force] : dead_) sum -= factors_[curve] * dot(force, displacement(u, at));
  // The volume below a face is a third of the integral of x . n da.
  for (const Face& face : faces_) {
    const auto x = corners(u, face);
    const auto forces = pressure_forces(x);
    for (std::size_t I = 0; I < 4; ++I)
      sum -= factors_[face.curve] * face.pressure / 3.0 * dot(x[I], forces[I]);
  }
  for (const Support& support : supports_) {
    for_each_point(support, u, [&](const std::array<double, 4>& N, const Vector& t) {
      for (std::size_t I = 0; I < 4; ++I) {
        sum += 0.5 * support.stiffness * N[I] * dot(displacement(u, support.at[I]), t);
      }
    });
  }
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
    const Vector now = displacement(u, k);
    for (std::size_t i = 0; i < 3; ++i) {
      work_[k] += 0.5 * (forces_[k][i] + forces_before_[k][i]) * (now[i] - u_before_[k][i]);
      u_before_[k][i] = now[i];
    }
  }
  forces_before_ = forces_;
}

template class Loads<double>;
template class Loads<float>;

}  // namespace sandglass
