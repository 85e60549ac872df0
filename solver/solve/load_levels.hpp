#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "element/one_point.hpp"
#include "math/row_loops.hpp"
#include "solve/equilibrium.hpp"
#include "solve/span.hpp"

namespace sandglass {

/// The largest changes of the factors of curves per load.
inline std::vector<double> largest_changes(const Scene& scene) {
  std::vector<double> changes;
  for (const LoadCurve& curve : scene.curves) changes.push_back(curve.steepest());
  return changes;
}

/// A load factor so small that no element inverts wherever the load acts. Driven nodes and obstacles move by
/// at most a hundredth of the smallest element's size h. Under the sum F of the forces, a cantilever as long
/// as the mesh, l, and as thick as that element, with the smallest shear modulus as E, would rotate by F l^2
/// / (2 E I), I = h^4 / 12, at most about a hundredth; moments count as forces at the end of l.
inline double first_load(const Model& model) {
  const Scene& scene = model.scene();
  double smallest = INFINITY;  // volume
  for (std::size_t e = 0; e < scene.mesh.cells.size(); ++e) {
    const Material& material = scene.materials.list[scene.materials.of(e)];
    smallest = std::min(smallest, model.element_masses()[e] / material.density);
  }
  const double h = std::cbrt(smallest);
  const double l = span(scene.mesh.points);
  const std::vector<double> moduli = shear_moduli(scene.materials);
  const double mu = *std::min_element(moduli.begin(), moduli.end());
  double F = 0.0;
  for (const auto& force : scene.forces) force->add_size(l, F);
  double share = 1.0;  // of the case's load
  for (const LoadCurve& curve : scene.curves) share = std::max(share, std::abs(curve.share));
  const double turn = share * F * l * l * 6.0 / (mu * h * h * h * h);
  double fastest = fastest_imposed(scene);
  const std::vector<double> changes = largest_changes(scene);
  for (const ContactForce* contact : contacts_of(scene.forces))
    fastest = std::max(fastest, contact->travel(changes));
  return std::min({1.0, 0.01 * h / fastest, 0.01 / turn});
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

/// The turning points of the load: 0, the full load, and for each cycle a tenth and the full load again. It
/// is a tenth instead of zero because residuals are relative to reactions.
inline std::vector<double> turning_loads(int cycles) {
  std::vector<double> loads{0.0, 1.0};
  for (int n = 0; n < cycles; ++n) loads.insert(loads.end(), {0.1, 1.0});
  return loads;
}

/// The load levels of a search: their loads, relative to the case's, and the displacements to start from.
/// There are as many equal levels as the user wants. By default, if forces depend on the path, levels are
/// equal and so short that no element's displacement gradient changes by more than 0.3; otherwise they are as
/// few as possible, each twice as long as the previous one.
template <class Real>
class LoadLevels {
 public:
  /// Starts from an undeformed body.
  LoadLevels(const Model& model, const Body<Real>& undeformed, bool forces_depend_on_path)
      : model_(model),
        chosen_(model.scene().settings.relaxation.levels),
        depends_on_path_(forces_depend_on_path),
        rubs_(remember_path(model.scene().forces)),
        equal_(chosen_ > 0 || forces_depend_on_path),
        turns_(turning_loads(model.scene().settings.relaxation.cycles)),
        longest_(longest_increment(model.scene())),
        load_(equal_ ? first_load(model) : longest_),
        increment_(load_),
        last_{0.0, undeformed.state(), std::vector<Real>(model.scene().mesh.cells.size())},
        before_{0.0, last_.state.u, last_.pressures} {}

  double load() const { return load_; }
  double increment() const { return load_ - last_.load; }

  /// Whether more levels are allowed: the user's number for each leg, and a thousand more. Each writes a
  /// frame.
  bool has_more() const { return solved_ < more_than_asked + chosen_ * static_cast<int>(turns_.size()); }

  /// Whether the load of this level differs from the last one by more than rounding.
  bool advances() const { return std::abs(increment()) > least_increment; }

  /// The load of the last level that was solved.
  double solved_load() const { return last_.load; }

  /// Whether this load level is the last.
  bool full() const { return leg_ + 1 == turns_.size() && load_ == turns_.back(); }

  /// The effort for this level: brief, unless shorter increments have not helped. Forces that depend on the
  /// path have no potential, so that only patience can help; with friction it helps more than shorter
  /// increments.
  Effort effort() const {
    if (!rubs_ && in_a_row_ == 0 && failures_ < few_failures) return Effort::brief;
    return depends_on_path_ ? Effort::patient : Effort::full;
  }

  /// The length of the path through all loads up to here.
  double travelled() const { return before_leg_ + std::abs(load_ - turns_[leg_ - 1]); }

  /// The length of the whole path.
  double way() const {
    double sum = 0.0;
    for (std::size_t n = 1; n < turns_.size(); ++n) sum += std::abs(turns_[n] - turns_[n - 1]);
    return sum;
  }

  /// The share of a search that is done, for display: loads up to 0.3, then the digits of the residual.
  double progress(double residual, double tolerance) const {
    if (!full()) return 0.3 * travelled() / way();
    return 0.3 + 0.7 * std::log(std::clamp(residual, tolerance, 1.0)) / std::log(tolerance);
  }

  /// The changes of the terms of paths of each angle over this load level.
  std::vector<PathTerms> moved() const {
    std::vector<PathTerms> changes;
    for (const double angle : model_.scene().angles) {
      const PathTerms from = path_terms(angle, last_.load), to = path_terms(angle, load_);
      changes.push_back({to[0] - from[0], to[1] - from[1], to[2] - from[2]});
    }
    return changes;
  }

  /// Extrapolates the search linearly from the last two load levels, and imposes this load, or a smaller one
  /// at which no element is strained by more than `largest_strain` from here: a law may stiffen a hundredfold
  /// beyond. The first level uses the linear answer instead, and so do all if there are obstacles.
  void predict(Equilibrium<Real>& search) {
    Body<Real>& body = search.body();
    body.move_to(last_.state.u);
    search.pressures() = last_.pressures;
    if (search.may_touch()) body.impose(last_.load);
    if (last_.load == before_.load || search.may_touch()) {
      load_ = search.extend(load_, largest_first_gradient);
      return;
    }
    Rows<Real> target = last_.state.u;
    const Real* before = numbers_of(before_.u);
    Real* to = numbers_of(target);
    if (!equal_) {
      Rows<float> change(target.size());
      for (std::size_t k = 0; k < 4 * target.size(); ++k)
        numbers_of(change)[k] = static_cast<float>(to[k] - before[k]);
      const double most =
          search.steps_to_strain(change, largest_strain) * std::abs(last_.load - before_.load);
      if (std::abs(load_ - last_.load) > most) load_ = last_.load + std::copysign(most, load_ - last_.load);
    }
    const auto t = static_cast<Real>((load_ - last_.load) / (last_.load - before_.load));
    for (std::size_t k = 0; k < 4 * target.size(); ++k) to[k] += t * (to[k] - before[k]);
    for (std::size_t e = 0; e < before_.pressures.size(); ++e) {
      search.pressures()[e] += t * (last_.pressures[e] - before_.pressures[e]);
    }
    body.move_to(target);
    body.impose(load_);
  }

  /// Goes to the full load in one level, with full effort, because there is no shorter increment to try.
  void skip_to_end() {
    leg_ = turns_.size() - 1;
    load_ = turns_.back();
    failures_ = few_failures;
  }

  /// Whether a search below the full load is accurate enough for predictions. Forces that depend on the path
  /// remember every level, friction more than a residual of 0.1, and the first of equal levels determines
  /// their number. After many failures, a level that is farther from equilibrium than the increment of the
  /// load would mislead the next one.
  bool far_enough(const Equilibrium<Real>& search) const {
    constexpr double residual = 0.1, reduction = 0.03, residual_of_first = 1e-3;
    if (rubs_) return search.residual() < residual_of_first && search.contact_agrees();
    if (equal_ && last_.load == 0.0) return search.residual() < residual_of_first;
    if (failures_ >= few_failures) {
      const double load = std::max(std::abs(load_), std::abs(last_.load));
      return search.residual() < std::min(residual, std::abs(increment()) / load);
    }
    return search.residual() < residual || (!depends_on_path_ && search.reduction() < reduction);
  }

  /// Proceeds to the next load level from a solved one.
  void solved(Equilibrium<Real>& search) {
    const Body<Real>& body = search.body();
    if (equal_ && last_.load == 0.0) {
      increment_ = longest_ = choose_increment(body.field(body.state().u));
    } else {
      increment_ = std::min(2.0 * std::abs(increment()), longest_);
    }
    in_a_row_ = 0;
    ++solved_;
    before_ = {last_.load, std::move(last_.state.u), std::move(last_.pressures)};
    last_ = {load_, body.state(), search.pressures()};
    if (load_ == turns_[leg_] && leg_ + 1 < turns_.size()) {
      before_leg_ = travelled();
      ++leg_;
    }
    aim();
  }

  /// Whether this level may be shortened to follow a path around corners of obstacles. Where a node snaps
  /// around one, no level is short enough.
  bool may_shorten() const { return corners_ < most_for_corners; }

  /// Notes that a node came around a corner, or passed through an obstacle, in this level.
  void note_corner() { ++corners_; }

  /// Resets the body to the last load level.
  void restart(Body<Real>& body) const { body.state() = last_.state; }

  /// The same, and halves the increment; false after too many attempts.
  bool failed(Body<Real>& body) {
    restart(body);
    increment_ = 0.5 * std::abs(increment());
    aim();
    ++in_a_row_;
    return ++failures_ <= most_failures && in_a_row_ <= most_in_a_row && advances();
  }

  /// The data that the next load levels depend on, for a body at the last one; see checkpoint.hpp.
  template <class Archive>
  void keep(Archive& archive, const Body<Real>& body) {
    body.layout().gather_rows(before_.u.data());
    gather_elements(body.layout(), before_.pressures);
    gather_elements(body.layout(), last_.pressures);
    archive("leg", leg_);
    if (leg_ == 0 || leg_ >= turns_.size()) {
      throw InputError("checkpoint: 'leg' must be one of the case's cycles; it belongs to another case");
    }
    archive("way before the leg", before_leg_);
    archive("load", load_);
    archive("load increment", increment_);
    archive("longest load increment", longest_);
    archive("load before", before_.load);
    archive("displacement before", before_.u);
    archive("pressure before", before_.pressures);
    archive("last load", last_.load);
    archive("last pressure", last_.pressures);
    archive("solved levels", solved_);
    archive("failures", failures_);
    archive("failures in a row", in_a_row_);
    archive("failures at corners", corners_);
    last_.state = body.state();
  }

 private:
  /// The largest change of displacement gradients in the first level.
  static constexpr double largest_first_gradient = 0.4;

  static constexpr int more_than_asked = 1000;

  /// An increment below the rounding of single precision, the multigrid method's, changes nothing.
  static constexpr double least_increment = 1e-9;

  /// The strain, relative to the current configuration, up to which levels are extrapolated.
  static constexpr double largest_strain = 0.3;

  /// The number of halvings in a row, to a few millionths of the load increment.
  static constexpr int most_in_a_row = 20;

  /// Levels that are shortened for corners, in all.
  static constexpr int most_for_corners = 6;

  /// Levels solved between failures may approach a load without ever passing it.
  static constexpr int most_failures = 200;

  /// After this many failures in all, every level gets more effort.
  static constexpr int few_failures = 4;

  struct Solved {
    double load;
    State<Real> state;
    std::vector<Real> pressures;
  };
  struct Before {
    double load;
    Rows<Real> u;
    std::vector<Real> pressures;
  };

  /// Rotations advance by at most an eighth of a turn per level: a whole turn would look like none. Obstacles
  /// advance by at most half of half their thickness: nodes beyond their middle would leave on the other
  /// side.
  static double longest_increment(const Scene& scene) {
    double largest = 0.0;
    for (const double angle : scene.angles) largest = std::max(largest, std::abs(angle));
    constexpr double eighth = std::numbers::pi / 4.0;
    double longest = largest > eighth ? eighth / largest : 1.0;
    const std::vector<double> changes = largest_changes(scene);
    for (const ContactForce* contact : contacts_of(scene.forces))
      longest = std::min(longest, 0.5 * contact->half_thickness() / contact->travel(changes));
    return longest;
  }

  /// The increment of equal load levels: from the user's number, or such that no element's displacement
  /// gradient changes by more than 0.3, with friction at least ten.
  double choose_increment(const NodalField& u) const {
    if (chosen_ > 0) return 1.0 / chosen_;
    const double gradient = largest_gradient(model_.scene().mesh, u) / load_;
    const double fewest = rubs_ ? 10.0 : 2.0;  // what slips in a long level may depend on rounding
    return 1.0 / std::clamp(std::ceil(gradient / 0.3), fewest, 50.0);
  }

  void aim() {
    const double left = turns_[leg_] - last_.load;
    load_ = std::abs(left) < 1.1 * increment_ ? turns_[leg_] : last_.load + std::copysign(increment_, left);
  }

  const Model& model_;
  int chosen_;
  bool depends_on_path_;
  bool rubs_;  // whether there is friction
  bool equal_;
  std::vector<double> turns_;
  double longest_;
  std::size_t leg_ = 1;      // index of the next turning point
  double before_leg_ = 0.0;  // length of the path up to the previous one
  double load_;
  double increment_;
  int solved_ = 0;
  int failures_ = 0;
  int in_a_row_ = 0;
  int corners_ = 0;
  Solved last_;
  Before before_;
};

}  // namespace sandglass
