#pragma once

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "element/one_point.hpp"
#include "solve/body.hpp"
#include "solve/row_loops.hpp"

namespace sandglass {

/// A load factor so small that no element inverts wherever the load acts. Driven nodes move by at most a
/// hundredth of the smallest element's size h; and a cantilever as long as the mesh and as thick as that
/// element, with the shear modulus for E, would rotate by about a hundredth under the sum F of the imposed
/// forces, by F l^2 / (2 E I) with I = h^4 / 12, where moments count as forces at the end of l.
inline double first_load(const Model& model) {
  const Scene& scene = model.scene();
  const auto& masses = model.element_masses();
  const double h = std::cbrt(*std::min_element(masses.begin(), masses.end()) / scene.description.density);
  const double l = diagonal(scene.mesh.points);
  const double mu = std::visit([](const auto& law) { return law.shear_modulus(); }, scene.description.law);
  double F = 0.0;
  for (const auto& [set, total, moment] : scene.description.forces) {
    F += std::hypot(total[0], total[1], total[2]) + std::hypot(moment[0], moment[1], moment[2]) / l;
  }
  const double turn = F * l * l * 6.0 / (mu * h * h * h * h);
  return std::min({1.0, 0.01 * h / fastest_imposed(scene), 0.01 / turn});
}

/// The largest norm of an element's mean displacement gradient.
inline double largest_gradient(const Mesh& mesh, const NodalField& u) {
  double square = 0.0;
  for (const auto& cell : mesh.cells) {
    const auto element = OnePoint::geometry(to_modes(gather(mesh.points, cell)));
    const Tensor<double> H = OnePoint::mean_gradient(to_modes(gather(u, cell)), element);
    square = std::max(square, double_dot(H, H));
  }
  return std::sqrt(square);
}

/// The turning points of the load: 0, the full load, and for each cycle a tenth and the full load again; a
/// tenth instead of zero, because residuals are relative to reactions.
inline std::vector<double> turning_loads(int cycles) {
  std::vector<double> loads{0.0, 1.0};
  for (int n = 0; n < cycles; ++n) loads.insert(loads.end(), {0.1, 1.0});
  return loads;
}

/// The load levels of a search: their loads, relative to the case's, and the displacements to start from.
template <class Real>
class LoadLevels {
 public:
  /// Starts from an undeformed body.
  LoadLevels(const Model& model, const Body<Real>& undeformed)
      : model_(model),
        turns_(turning_loads(model.scene().description.relaxation.cycles)),
        load_(first_load(model)),
        before_(undeformed.state().u),
        last_(undeformed.state()) {}

  double load() const { return load_; }
  double increment() const { return load_ - last_load_; }

  /// Whether this load level is the last.
  bool full() const { return leg_ + 1 == turns_.size() && load_ == turns_.back(); }

  /// The length of the path through all loads up to here.
  double travelled() const { return before_leg_ + std::abs(load_ - turns_[leg_ - 1]); }

  /// The length of the whole path.
  double way() const {
    double sum = 0.0;
    for (std::size_t n = 1; n < turns_.size(); ++n) sum += std::abs(turns_[n] - turns_[n - 1]);
    return sum;
  }

  /// The changes of the terms of paths of each angle over this load level.
  std::vector<PathTerms> moved() const {
    std::vector<PathTerms> changes;
    for (const double angle : model_.scene().angles) {
      const PathTerms from = path_terms(angle, last_load_), to = path_terms(angle, load_);
      changes.push_back({to[0] - from[0], to[1] - from[1], to[2] - from[2]});
    }
    return changes;
  }

  /// Extrapolates a body from the last two load levels linearly, and imposes this load.
  void predict(Body<Real>& body) const {
    if (last_load_ != before_load_) {
      const auto t = static_cast<Real>((load_ - last_load_) / (last_load_ - before_load_));
      Rows<Real> target = last_.u;
      const Real* before = numbers_of(before_);
      Real* to = numbers_of(target);
      for (std::size_t k = 0; k < 4 * target.size(); ++k) to[k] += t * (to[k] - before[k]);
      body.move_to(target);
    } else {
      body.move_to(last_.u);
    }
    body.impose(load_);
  }

  /// Proceeds to the next load level from a solved one.
  void solved(const Body<Real>& body) {
    if (last_load_ == 0.0) increment_ = choose_increment(body.field(body.state().u));
    before_ = std::move(last_.u);
    before_load_ = last_load_;
    last_ = body.state();
    last_load_ = load_;
    if (load_ == turns_[leg_] && leg_ + 1 < turns_.size()) {
      before_leg_ = travelled();
      ++leg_;
    }
    aim();
  }

  /// Resets the body to the last load level and halves the increment; false after too many attempts.
  bool failed(Body<Real>& body) {
    body.state() = last_;
    increment_ = 0.5 * std::abs(increment());
    aim();
    return ++failures_ <= most_failures;
  }

  /// The data that the next load levels depend on, for a body at the last one; see checkpoint.hpp.
  template <class Archive>
  void keep(Archive& archive, const Body<Real>& body) {
    archive("leg", leg_);
    if (leg_ == 0 || leg_ >= turns_.size()) {
      throw InputError("checkpoint: 'leg' must be one of the case's cycles; it belongs to another case");
    }
    archive("way before the leg", before_leg_);
    archive("load", load_);
    archive("load increment", increment_);
    archive("load before", before_load_);
    archive("displacement before", before_);
    archive("last load", last_load_);
    archive("failures", failures_);
    last_ = body.state();
  }

 private:
  static constexpr int most_failures = 10;

  /// The increment of equal load levels: as many as the user wants, or such that no element's displacement
  /// gradient changes by more than 0.3.
  double choose_increment(const NodalField& u) const {
    const int chosen = model_.scene().description.relaxation.levels;
    if (chosen > 0) return 1.0 / chosen;
    const double gradient = largest_gradient(model_.scene().mesh, u) / load_;
    return 1.0 / std::clamp(std::ceil(gradient / 0.3), 2.0, 50.0);
  }

  void aim() {
    const double left = turns_[leg_] - last_load_;
    load_ = std::abs(left) < 1.1 * increment_ ? turns_[leg_] : last_load_ + std::copysign(increment_, left);
  }

  const Model& model_;
  std::vector<double> turns_;
  std::size_t leg_ = 1;      // index of the next turning point
  double before_leg_ = 0.0;  // length of the path up to the previous one
  double load_;
  double increment_ = 1.0;
  double before_load_ = 0.0;
  Rows<Real> before_;
  double last_load_ = 0.0;
  State<Real> last_;
  int failures_ = 0;
};

}  // namespace sandglass
