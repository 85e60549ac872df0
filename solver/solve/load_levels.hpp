#pragma once

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "element/one_point.hpp"
#include "solve/body.hpp"
#include "solve/row_loops.hpp"

namespace sandglass {

/// A load so small that elements hold it wherever it acts. Imposed nodes move by a hundredth of
/// the smallest element at most; and a cantilever as long as the mesh and as thick as that element, its
/// modulus the shear modulus, would turn by about a hundredth under the sum of the imposed forces: F l^2 / (2
/// E I) with I = h^4 / 12, moments counting as forces at the end of l.
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

/// Largest norm of an element's mean displacement gradient, -.
inline double largest_gradient(const Mesh& mesh, const NodalField& u) {
  double square = 0.0;
  for (const auto& cell : mesh.cells) {
    const auto element = OnePoint::geometry(to_modes(gather(mesh.points, cell)));
    const Tensor<double> H = OnePoint::mean_gradient(to_modes(gather(u, cell)), element);
    square = std::max(square, double_dot(H, H));
  }
  return std::sqrt(square);
}

/// The loads between which levels lie: 0, the whole, and for each cycle a tenth and the whole again. A tenth,
/// not nothing, because residuals are told over the reactions.
inline std::vector<double> turning_loads(int cycles) {
  std::vector<double> loads{0.0, 1.0};
  for (int n = 0; n < cycles; ++n) loads.insert(loads.end(), {0.1, 1.0});
  return loads;
}

/// The levels of what is imposed: how far to go, and where to start. Loads are relative to the case's.
template <class Real>
class LoadLevels {
 public:
  LoadLevels(const Model& model, const Body<Real>& at_rest)
      : model_(model),
        turns_(turning_loads(model.scene().description.relaxation.cycles)),
        load_(first_load(model)),
        before_(at_rest.state().u),
        last_(at_rest.state()) {}

  double load() const { return load_; }
  double increment() const { return load_ - last_load_; }

  /// Whether this level is the last.
  bool full() const { return leg_ + 1 == turns_.size() && load_ == turns_.back(); }

  /// What was gone of the way through all loads, there and back.
  double travelled() const { return before_leg_ + std::abs(load_ - turns_[leg_ - 1]); }

  /// The whole way.
  double way() const {
    double sum = 0.0;
    for (std::size_t n = 1; n < turns_.size(); ++n) sum += std::abs(turns_[n] - turns_[n - 1]);
    return sum;
  }

  /// How the terms of paths of each angle change over this level.
  std::vector<PathTerms> moved() const {
    std::vector<PathTerms> changes;
    for (const double angle : model_.scene().angles) {
      const PathTerms from = path_terms(angle, last_load_), to = path_terms(angle, load_);
      changes.push_back({to[0] - from[0], to[1] - from[1], to[2] - from[2]});
    }
    return changes;
  }

  /// Moves a body that is at the last level along the line through the last two, and imposes this load.
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

  /// Goes on from a solved level.
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

  /// Brings the body back to the last level and aims half as far; false when that was tried often enough.
  bool failed(Body<Real>& body) {
    body.state() = last_;
    increment_ = 0.5 * std::abs(increment());
    aim();
    return ++failures_ <= most_failures;
  }

  /// What the next levels read, of a body that is at the last one; see checkpoint.hpp.
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

  /// Equal levels in which no element's displacement gradient changes by more than 0.3, or the user's number.
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
  std::size_t leg_ = 1;      // the turn that the levels lead to
  double before_leg_ = 0.0;  // travelled before it
  double load_;
  double increment_ = 1.0;
  double before_load_ = 0.0;
  Rows<Real> before_;
  double last_load_ = 0.0;
  State<Real> last_;
  int failures_ = 0;
};

}  // namespace sandglass
