#include "solve/health.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.hpp"
#include "mesh/interpolation.hpp"

namespace sandglass {

namespace {

/// The smallest det F of each element; 1 if another rank owns it.
template <class Real>
std::vector<double> smallest_jacobians(const Body<Real>& body) {
  std::vector<double> jacobians(body.scene().mesh.cells.size(), 1.0);
  body.elements().smallest_jacobians(body.state(), jacobians);
  return jacobians;
}

}  // namespace

bool is_healthy(double jacobian) {
  return std::isfinite(jacobian) && jacobian > 0.0;
}

template <class Real>
bool is_healthy(const Body<Real>& body) {
  const std::vector<double> jacobians = smallest_jacobians(body);
  const bool healthy = std::ranges::all_of(jacobians, [](double jacobian) { return is_healthy(jacobian); });
  return !body.layout().team.ranks->any(!healthy);
}

template <class Real>
bool is_finite(const Body<Real>& body) {
  const Rows<Real>& u = body.state().u;
  const Real* number = numbers_of(u);
  Real sum = 0;  // not zero if a number is not finite
#pragma omp simd reduction(+ : sum)
  for (std::size_t k = 0; k < 4 * u.size(); ++k) sum += Real(0) * number[k];
  return sum == Real(0);
}

void require_healthy(std::span<const double> jacobians, long step) {
  std::string listed;
  int ill = 0;
  bool finite = true;
  for (std::size_t e = 0; e < jacobians.size(); ++e) {
    if (is_healthy(jacobians[e])) continue;
    finite = finite && std::isfinite(jacobians[e]);
    if (++ill <= 10) listed += fmt::format("\n  element {}: det F = {:.4g}", e, jacobians[e]);
  }
  if (ill == 0) return;
  const std::string text = fmt::format(
      "step {}: {} of {} elements {}; det F must be positive\n"
      "the first {}:{}\n"
      "remedy: {}",
      step, ill, jacobians.size(), finite ? "are inverted" : "are no longer finite", std::min(ill, 10),
      listed,
      finite ? "impose less displacement or more slowly (levels, ramp_time), refine the mesh, or use an "
               "hourglass "
               "control (method tl-perturbation or tl-mean-dilatation)"
             : "take a smaller step (step_fraction, time_step) or check more often (check_interval)");
  throw ComputationError(text, finite ? Breakdown::inverted : Breakdown::not_finite);
}

template <class Real>
void require_healthy(const Body<Real>& body, long step) {
  std::vector<double> jacobians = smallest_jacobians(body);
  gather_elements(body.layout(), jacobians);
  require_healthy(jacobians, step);
}

void require_not_passed(const Touch& touch, const NodalField& points, std::string_view moment, double value) {
  if (touch.passed < 0) return;
  const Vector& X = points[at(touch.passed)];
  throw ComputationError(fmt::format(
      "{} {:.9g}: contact '{}': node {}, undeformed at ({:.6g}, {:.6g}, {:.6g}) m, went deeper than "
      "the contact can push back from, and may have passed through\n"
      "remedy: press less or more slowly, take smaller steps (step_fraction, in static equilibrium levels), "
      "and by a penalty a larger one",
      moment, value, touch.name, touch.passed, X[0], X[1], X[2]));
}

void require_static_contact(const Scene& scene) {
  const std::string file = scene.settings.file.string();
  const auto contacts = contacts_of(scene.forces);
  for (const ContactForce* contact : contacts) {
    const std::string_view reason = contact->traits().no_potential;
    if (reason.empty() || contact->remembers_path()) continue;
    throw InputError(
        fmt::format("{}: [[{}]] has no static equilibrium: {}; allowed: a dynamic case, or leave that out",
                    file, contact->traits().name, reason));
  }
  const auto bends = [](const LoadCurve& curve) {
    return !curve.formula.text.empty() || curve.times.size() > 1;
  };
  if (remember_path(scene.forces) && scene.settings.relaxation.levels == 0 &&
      std::ranges::any_of(scene.curves, bends)) {
    throw InputError(fmt::format(
        "{}: [relaxation] levels is needed: friction in static equilibrium follows the load, and "
        "a load or the friction has a curve; allowed: enough equal levels to follow it, such as levels = 20",
        file));
  }
  if (!scene.coarser.empty() && movable_of(scene.forces).size() < contacts.size()) {
    throw InputError(
        fmt::format("{}: [[contact]] has no static equilibrium on a mesh with [[refine]]: coarser meshes do "
                    "not know which points touch; allowed: a mesh of such elements, or a dynamic case",
                    file));
  }
}

void require_apart(const Scene& scene, const NodalField& u) {
  const Mesh& mesh = scene.mesh;
  for (const ContactForce* contact : contacts_of(scene.forces)) {
    if (contact->movable()) continue;  // obstacles push nodes at any depth
    // A pressed surface is a little within the other.
    constexpr double deep_within = 0.3;
    const auto overlaps_of = [&](const NodalField& points) {
      std::set<std::pair<int, std::size_t>> found;
      for (const auto& [line, element] :
           overlaps(points, mesh.cells, contact->nodes(), deep_within, deep_within))
        found.emplace(line.nodes[0], element);
      return found;
    };
    NodalField now = mesh.points;
    for (std::size_t n = 0; n < now.size(); ++n) now[n] = sum(now[n], 1.0, u[n]);
    const auto overlapping = overlaps_of(now);
    if (overlapping.empty()) continue;
    const auto before = overlaps_of(mesh.points);
    for (const auto& [node, element] : overlapping) {
      if (before.contains({node, element})) continue;
      const Vector& X = mesh.points[at(node)];
      throw ComputationError(fmt::format(
          "contact '{}': in the equilibrium found, node {} or an edge of it, undeformed at ({:.6g}, {:.6g}, "
          "{:.6g}) m, is within element {}: bodies passed through each other\n"
          "remedy: impose less displacement, or more levels",
          contact->touch(Rows<double>(contact->memory()).data()).name, node, X[0], X[1], X[2], element));
    }
  }
}

template bool is_healthy(const Body<double>&);
template bool is_healthy(const Body<float>&);
template bool is_finite(const Body<double>&);
template bool is_finite(const Body<float>&);
template void require_healthy(const Body<double>&, long);
template void require_healthy(const Body<float>&, long);

}  // namespace sandglass
