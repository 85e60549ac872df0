/// Slender bodies beyond their buckling loads: answers reported as stable are minima of the potential.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "solve/central_difference.hpp"
#include "solve/relaxation.hpp"
#include "support/dense_matrix.hpp"
#include "support/random_scene.hpp"

namespace sandglass::verification::buckling_test {
namespace {

/// A different scene for each number: columns clamped at one end, or at both but free to shorten, and arches
/// with clamped ends; Poisson's ratio from 0 to .499; loads of half to three times what beam theory allows,
/// with side forces of a hundredth of that, a ten thousandth or none.
class SlenderScene {
 public:
  SlenderScene(long seed, long number) : random_(static_cast<std::uint64_t>(9000011 * seed + number)) {
    constexpr std::array ratios{0.0, 0.3, 0.45, 0.49, 0.499};
    constexpr std::array sides{0.01, 1e-4, 0.0};
    law_ = {.young_modulus = 1e6, .poisson_ratio = ratios[index(whole(0, 4))]};
    load_ = random_.uniform(0.5, 3.0);
    side_ = sides[index(whole(0, 2))];
    thickness_ = 1.0 / random_.uniform(8.0, 20.0);
    width_ = thickness_ * random_.uniform(1.0, 2.0);
    is_arch_ = random_.uniform(0.0, 1.0) < 0.4;
    is_arch_ ? make_arch() : make_column();
  }

  /// A motion with strong damping for this many of a straight beam's slowest times, or static for 0.
  Scene scene(double times = 0.0) const {
    Case description = plain_case(law_);
    description.displacements = {{"foot", {}}};
    if (is_arch_) description.displacements.push_back({"end", {}});
    if (guided_) description.displacements.push_back({"head", {}, {true, true, false}});
    description.forces.of<DeadForce>() = {
        {.set = "head",
         .total = force_,
         .on = is_arch_ ? DeadForce::Carrier::nodes : DeadForce::Carrier::faces}};
    if (times > 0.0) {
      const double frequency =
          3.5 * thickness_ * std::sqrt(law_.young_modulus / (12.0 * density)) / (length_ * length_);
      description.quasi_static = false;
      description.dynamics.duration = times / frequency;
      description.dynamics.ramp_time = 0.3 * times / frequency;
      description.dynamics.damping = frequency;
    }
    return make_scene(description, mesh_, sets_);
  }

  bool is_arch() const { return is_arch_; }
  double load() const { return load_; }
  double side() const { return side_; }
  double poisson_ratio() const { return law_.poisson_ratio; }

 private:
  static constexpr double density = 1000.0;

  int whole(int low, int high) { return low + static_cast<int>(random_.uniform(0.0, high - low + 1.0)); }

  double bending_stiffness() const {
    return law_.young_modulus * width_ * thickness_ * thickness_ * thickness_ / 12.0;
  }

  void make_column() {
    mesh_ = box({width_, thickness_, length_}, {whole(1, 2), whole(1, 2), whole(6, 12)});
    sets_["foot"] = nodes_where(mesh_.points, [](const Vector& X) { return X[2] < 1e-9; });
    sets_["head"] = nodes_where(mesh_.points, [&](const Vector& X) { return X[2] > length_ - 1e-9; });
    guided_ = random_.uniform(0.0, 1.0) < 0.3;
    const double pi = std::numbers::pi;
    const double force = load_ * (guided_ ? 4.0 : 0.25) * pi * pi * bending_stiffness() / (length_ * length_);
    if (guided_) side_ = 0.0;  // the guide would carry it
    force_ = {side_ * force * random_.uniform(-1.0, 1.0), side_ * force, -force};
  }

  void make_arch() {
    const double angle = random_.uniform(0.5, 1.2);  // from the crown to an end; the radius is 1
    const int half = whole(4, 7);
    length_ = 2.0 * angle;
    mesh_ = lattice({2 * half, whole(1, 2), 1}, [&](const Vector& x) -> Vector {
      const double phi = angle * (2.0 * x[0] - 1.0), r = 1.0 + thickness_ * (x[1] - 0.5);
      return {r * std::sin(phi), 2.0 * width_ * (0.5 - x[2]), r * std::cos(phi)};
    });
    const auto at_angle = [&](double phi) {
      return nodes_where(mesh_.points,
                         [&](const Vector& X) { return std::abs(std::atan2(X[0], X[2]) - phi) < 1e-6; });
    };
    sets_ = {{"foot", at_angle(-angle)}, {"end", at_angle(angle)}, {"head", at_angle(0.0)}};
    width_ *= 2.0;
    const double force = load_ * (20.0 / (angle * angle) - 1.0) * angle * bending_stiffness();
    force_ = {side_ * force, 0.3 * side_ * force, -force};
  }

  RandomGeometry random_;
  NeoHookean law_{};
  double load_ = 0.0, side_ = 0.0, length_ = 1.0, thickness_ = 0.0, width_ = 0.0;
  bool is_arch_ = false, guided_ = false;
  Mesh mesh_;
  NodeSets sets_;
  Vector force_{};
};

/// The smallest eigenvalue of the tangent stiffness of the free components at u, over the largest one, by
/// central differences of the forces and a dense matrix.
double smallest_eigenvalue(const Scene& scene, const Model& model, const NodalField& u,
                           const std::vector<double>& levels) {
  const auto& elements = *std::get<std::unique_ptr<InternalForce<double>>>(model.internal_force());
  std::vector<std::array<std::size_t, 2>> free;  // row, component
  const Layout& layout = elements.layout();
  for (std::size_t n = 0; n < u.size(); ++n) {
    for (std::size_t i = 0; i < 3; ++i) {
      const bool held = std::ranges::any_of(scene.constraints, [&](const auto& constraint) {
        return index(constraint.node) == n && index(constraint.component) == i;
      });
      if (!held) free.push_back({index(layout.row_of_node[n]), i});
    }
  }
  State<double> state = state_at(elements, u);
  elements.set_levels(state, levels);
  const double step = 1e-6 * std::cbrt(1.0 / static_cast<double>(scene.mesh.cells.size()));
  std::vector<double> K(free.size() * free.size());
  Rows<double> plus(state.u.size()), minus = plus;
  for (std::size_t k = 0; k < free.size(); ++k) {
    double& moved = state.u[free[k][0]][free[k][1]];
    const double before = moved;
    moved = before + step;
    elements.evaluate(state, plus);
    moved = before - step;
    elements.evaluate(state, minus);
    moved = before;
    for (std::size_t m = 0; m < free.size(); ++m) {
      const auto& [row, i] = free[m];
      const double entry = (plus[row][i] - minus[row][i]) / (2.0 * step);
      K[m * free.size() + k] += 0.5 * entry;
      K[k * free.size() + m] += 0.5 * entry;
    }
  }
  const std::vector<double> values = symmetric_eigenvalues(K);
  return values.front() / values.back();
}

/// The methods whose forces have a potential and resist all deformations.
std::vector<std::string> methods_with_a_potential(const Scene& scene) {
  std::vector<std::string> names;
  for (const MethodEntry& method : methods()) {
    if (!method.controls_hourglass || method.is_condensed || method.is_linear) continue;
    const Model model(scene, {std::string(method.name)});
    if (std::visit([](const auto& elements) { return elements->needs_increment(); }, model.internal_force()))
      continue;
    names.emplace_back(method.name);
  }
  return names;
}

/// Stable answers may be another minimum than the end of a slow motion: at most one in fifty, none of these
/// few scenes. SANDGLASS_SCENES=200 buckling_test runs more scenes and prints a row for each.
TEST(Buckling, what_is_called_stable_is_a_minimum) {
  constexpr long usual = 13;  // one for each method
  const long first = from_environment("SANDGLASS_FIRST", 0),
             count = from_environment("SANDGLASS_SCENES", usual);
  const long seed = from_environment("SANDGLASS_SEED", 1);
  long minima = 0, left = 0, undecided = 0, failed = 0, compared = 0, elsewhere = 0;
  for (long number = first; number < first + count; ++number) {
    const SlenderScene slender(seed, number);
    const Scene scene = slender.scene();
    const auto names = methods_with_a_potential(scene);
    const std::string method = names[static_cast<std::size_t>(number) % names.size()];
    const std::string which = fmt::format("{:4} {:22} {} nu {:5} load {:.2f} side {:6}", number, method,
                                          slender.is_arch() ? "arch  " : "column", slender.poisson_ratio(),
                                          slender.load(), slender.side());
    const Model model(scene, {method});
    Recorder recorder;
    std::string row = which;
    try {
      const Relaxation found = relax(model, recorder);
      ASSERT_TRUE(in_equilibrium(found)) << which << outcome(found, Precision::double_precision);
      const double least = smallest_eigenvalue(scene, model, found.u, recorder.frames.back().levels);
      row += fmt::format(": {:4} + {:3}, least eigenvalue {:9.2e}, {}", found.steps,
                         found.stability_evaluations, least, stability_text(found));
      if (found.stability == Stability::not_decided) {
        ++undecided;
      } else {
        ++minima;
        left += found.stability == Stability::saddle_left ? 1 : 0;
        EXPECT_GT(least, 0.0) << which;
      }
      // An adaptive method has other levels in motion, and without a side force a motion may stay straight.
      if (slender.side() > 0.0 && !method_named(method).adapts()) {
        Observer silent;
        const Motion motion = integrate(Model(slender.scene(400.0), {method}), silent);
        double largest = 0.0;
        for (const Vector& d : motion.u) largest = std::max(largest, length(d));
        const double distance = largest_distance(motion.u, found.u) / largest;
        ++compared;
        elsewhere += distance > 0.01 ? 1 : 0;
        row += fmt::format(", motion {:.2e} away", distance);
      }
    } catch (const ComputationError& error) {
      ++failed;
      row += fmt::format(": {}", error.what());
    }
    if (count > usual) {
      fmt::print("{}\n", row);
      std::fflush(stdout);
    }
  }
  fmt::print(
      "seed {}: {} minima, {} after a saddle, {} undecided, {} failed; of {} motions {} end elsewhere\n",
      seed, minima, left, undecided, failed, compared, elsewhere);
  EXPECT_GE(left, count / usual);
  EXPECT_LE(undecided + failed, count / 50);
  EXPECT_LE(elsewhere, compared / 50);
}

}  // namespace
}  // namespace sandglass::verification::buckling_test
