#include "solve/adaption.hpp"

#include <algorithm>
#include <ctime>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "mesh/hexahedron.hpp"
#include "solve/error_estimate.hpp"

namespace sandglass {

namespace {

/// The largest error over its estimate, which is slightly low in slender bodies.
constexpr double largest_over_estimate = 1.1;

/// For each node 1 / (mu sum over elements of the integral of |grad N|^2), in m/N; 0 for a node without
/// elements.
std::vector<double> nodal_mobilities(const Scene& scene) {
  const std::vector<double> moduli = shear_moduli(scene.materials);
  std::vector<double> stiffness(scene.mesh.points.size(), 0.0);
  for (std::size_t e = 0; e < scene.mesh.cells.size(); ++e) {
    const Hexahedron& cell = scene.mesh.cells[e];
    const auto X = gather(scene.mesh.points, cell);
    const double mu = moduli[scene.materials.of(e)];
    for (const auto& xi : gauss_points()) {
      const PointGradient point = point_gradient(X, xi);
      for (int I = 0; I < point.gradient.rows; ++I) {
        double square = 0.0;
        for (int i = 0; i < 3; ++i) square += point.gradient(I, i) * point.gradient(I, i);
        stiffness[static_cast<std::size_t>(cell[static_cast<std::size_t>(I)])] += mu * point.measure * square;
      }
    }
  }
  for (double& k : stiffness) k = k > 0.0 ? 1.0 / k : 0.0;
  return stiffness;
}

/// The processor time (s) of this thread. A motion has few choices, so each counts, and on a busy machine the
/// wall time of one may be a hundred times as long.
double processor_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

template <class Real>
Adaption<Real>::Adaption(const Model& model, const Body<Real>& body)
    : model_(model),
      active_(method_named(model.choice().method).adapts()),
      accuracy_(model.choice().accuracy),
      imposed_(largest_imposed(model.scene())) {
  if (active_) mobility_ = body.on_free_components(nodal_mobilities(model.scene()));
}

template <class Real>
Adaptation Adaption<Real>::apply(Body<Real>& body, Demotion demotion) {
  if (!active_) return {};
  const double start = processor_seconds();
  const double length = share_ * asked(body);
  const double share = demotion == Demotion::never ? 0.0 : demotion == Demotion::reluctant ? 0.5 : 1.0;
  const Adaptation changes = body.adapt(mobility_, length, share * length);
  seconds_ += processor_seconds() - start;
  return changes;
}

template <class Real>
bool Adaption<Real>::promote_for_the_whole(Body<Real>& body) {
  double error = 0.0;
  try {
    const ErrorEstimate estimate = estimate_error(model_, body.field(body.state().u));
    error = largest_over_estimate * estimate.largest;
    evaluations_of_estimates_ += estimate.evaluations;
  } catch (const ComputationError&) {
    return false;  // nothing to compare with
  }
  constexpr int most_rounds = 10;
  for (int round = 0; round < most_rounds && tighten(body, error); ++round) {
    if (apply(body, Demotion::never).promoted > 0) return true;
    error *= 1.5;  // no element was close to its limit
  }
  return false;  // accurate enough, or nothing more can be done
}

/// Takes a measured error (m) of an answer with the current levels; the more it exceeds the accuracy, the
/// less error elements are allowed from then on. Returns whether it does.
template <class Real>
bool Adaption<Real>::tighten(const Body<Real>& body, double error) {
  // Never by less, so that the loop ends, nor by more, as the largest errors weigh most.
  constexpr double least = 0.8, most = 0.25;
  const double excess = error / asked(body);
  if (excess > 1.0) share_ *= std::clamp(1.0 / excess, most, least);
  return excess > 1.0;
}

/// The accuracy as a length, m.
template <class Real>
double Adaption<Real>::asked(const Body<Real>& body) const {
  double unit = imposed_;
  if (!(imposed_ > 0.0)) {
    const Blocks::Range own = body.layout().row_blocks.own();
    for (std::size_t row = own.first / 4; row < own.last / 4; ++row) {
      const auto& u = body.state().u[row];
      unit = std::max(unit, length(Vector{u[0], u[1], u[2]}));
    }
    unit = body.layout().team.ranks->largest(unit);
  }
  return accuracy_ * unit;
}

template class Adaption<double>;
template class Adaption<float>;

}  // namespace sandglass
