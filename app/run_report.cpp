#include "app/run_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "app/si_units.hpp"
#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "comparison/comparison.hpp"
#include "comparison/verdict.hpp"
#include "forces/contact_force.hpp"
#include "mesh/edges.hpp"
#include "mesh/hexahedron.hpp"
#include "mesh/parts.hpp"
#include "solve/resident.hpp"
#include "solve/stable_step.hpp"

namespace sandglass {

namespace {

/// Above this share of the strain energy, the hourglass control affects the answer; a common rule of thumb.
constexpr double much_hourglass = 0.1;

/// Above this multiple of the automatic kappa its control stiffens more than hourglass modes.
constexpr double much_kappa = 20.0;

/// The depth of a node, over the shortest edge, above which contact is too soft.
constexpr double much_depth = 0.01;

/// The unexplained share of the energy above which a motion is suspect. Free motions gain at most a percent
/// (energy_test); the damped energy is summed from the rows of the history.
constexpr double much_unexplained = 0.02, much_unexplained_if_damped = 0.1;

/// The references of a scene. One that belongs to another version of the case is reported, not fatal, so that
/// a case can be edited and run.
References references_to_show(const Scene& scene) {
  try {
    return read_references(scene);
  } catch (const InputError& error) {
    fmt::print(stderr, "note: not compared: {}\n", error.what());
    return {};
  }
}

std::string plural(long count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string force_text(const Vector& force) {
  const double unit = 1e-4 * std::max(1e-300, length(force));  // roundoff is shown as 0
  const auto component = [&](double f) { return std::abs(f) < unit ? 0.0 : f; };
  return fmt::format("({:.3g}, {:.3g}, {:.3g}) N", component(force[0]), component(force[1]),
                     component(force[2]));
}

/// The automatic kappa of a model's method; none for a method without one.
std::optional<double> automatic_kappa(const Model& model) {
  const MethodChoice& choice = model.choice();
  const CalledLaw law = elastic_law(kernel_law(model.scene().materials.list.front().law));
  return method_named(choice.method).auto_kappa(law, choice.kappa_modulus);
}

/// Whether a body loses energy in ways that the history does not show.
bool dissipates(const Model& model) {
  const Scene& scene = model.scene();
  const auto remembers = [](const Material& material) { return is_viscoelastic(material.law); };
  const auto damps = [](const auto& force) { return force->traits().dissipates; };
  return std::any_of(scene.materials.list.begin(), scene.materials.list.end(), remembers) ||
         std::any_of(scene.forces.begin(), scene.forces.end(), damps) ||
         method_named(model.choice().method).damps_only;
}

/// The energy (J) that a strain of 1e-12, far above that of rounded displacements, would store in the body.
double energy_of_rounding(const Model& model) {
  double energy = 0.0;
  for (std::size_t e = 0; e < model.element_masses().size(); ++e) {
    const Material& material = model.scene().materials.list[model.scene().materials.of(e)];
    energy += 1e-24 * elastic_law(kernel_law(material)).bulk_modulus() * model.element_masses()[e] /
              material.density;
  }
  return energy;
}

/// Of hourglass modes; 0 in a body that is not strained.
double share_of_strain_energy(const Model& model, const HistoryReport& history) {
  const bool quasi_static = model.scene().settings.quasi_static;
  const double strain = history.strain(quasi_static);
  return strain > energy_of_rounding(model) ? history.hourglass(quasi_static) / strain : 0.0;
}

/// Empty for a body in one piece.
std::string parts_text(const Scene& scene) {
  const int parts = number_of_parts(scene.mesh, scene.ties);
  return parts > 1 ? fmt::format("; {} separate parts", parts) : "";
}

/// What a step costs on another processor, or why the state was copied there in every step.
void print_device(const Scene& scene, const StepTraffic& traffic) {
  if (traffic.launches == 0) {
    fmt::print("state copied to the device in every step: {}\n", why_not_resident(scene));
  } else {
    fmt::print("state on the device: {} and {:.4g} bytes per element in a step\n",
               plural(traffic.launches, "kernel"),
               static_cast<double>(traffic.bytes) / static_cast<double>(scene.mesh.cells.size()));
  }
}

}  // namespace

void print_problem(const Scene& scene) {
  const Mesh& mesh = scene.mesh;
  double volume = 0.0, mass = 0.0;
  for (std::size_t e = 0; e < mesh.cells.size(); ++e) {
    const double V = mean_gradient(gather(mesh.points, mesh.cells[e])).volume;
    volume += V;
    mass += scene.materials.list[scene.materials.of(e)].density * V;
  }
  const std::vector<double>& masses = scene.attached_masses;
  const double attached = std::accumulate(masses.begin(), masses.end(), 0.0);
  const auto [low, high] = bounding_box(mesh.points);
  fmt::print("{}: {} x {} x {}, {}, {}; {}, {}{}\n", scene.settings.name, length_text(high[0] - low[0]),
             length_text(high[1] - low[1]), length_text(high[2] - low[2]),
             volume < 1e-3 ? fmt::format("{:.3g} cm^3", 1e6 * volume) : fmt::format("{:.3g} m^3", volume),
             mass_text(mass) + (attached > 0.0 ? fmt::format(" with {} attached", mass_text(attached)) : ""),
             plural(static_cast<long>(mesh.cells.size()), "element"),
             plural(static_cast<long>(mesh.points.size()), "node"), parts_text(scene));
  for (const Material& material : scene.materials.list) {
    const CalledLaw law = elastic_law(kernel_law(material));
    const double K = law.bulk_modulus(), mu = law.shear_modulus();
    fmt::print("{}: Young's modulus {}, shear {}, bulk {}; density {:.4g} kg/m^3, waves of {}\n",
               name_of(material.law), with_prefix(young_modulus(law), "Pa"), with_prefix(mu, "Pa"),
               with_prefix(K, "Pa"), material.density,
               with_prefix(std::sqrt((K + 4.0 / 3.0 * mu) / material.density), "m/s"));
  }
}

std::string kappa_text(const Model& model) {
  const auto& choice = model.choice();
  if (!method_named(choice.method).takes_kappa) return "";
  const double value = choice.kappa.value_or(automatic_kappa(model).value_or(0.0));
  return fmt::format("{:.6g}{}{}", value, choice.kappa ? "" : " (auto)",
                     choice.kappa_modulus == KappaModulus::shear ? " of the shear modulus" : "");
}

void print_method(const Model& model) {
  const MethodChoice& choice = model.choice();
  const double excess = choice.kappa.value_or(0.0) / automatic_kappa(model).value_or(1.0);
  if (excess > much_kappa) {
    fmt::print(stderr, "warning: kappa {:g} is {:.2g} times the automatic one: the body is too stiff\n",
               *choice.kappa, excess);
  }
  const std::string kappa = kappa_text(model);
  fmt::print("{}{}{}, {}", choice.method, kappa.empty() ? "" : ", kappa ", kappa, name_of(choice.precision));
  if (choice.ranks->count() == 1 && !method_named(choice.method).is_condensed) {
    const NodalField undeformed(model.scene().mesh.points.size());
    fmt::print(", stable step {}", with_prefix(stable_step(model, undeformed).step, "s"));
  }
  fmt::print("\n");
}

void HistoryReport::take(const HistoryRow& row) {
  if (!started_) first_ = last_ = row;
  started_ = true;
  last_ = row;
  largest_hourglass_ = std::max(largest_hourglass_, row.hourglass);
  largest_strain_ = std::max(largest_strain_, row.strain);
  largest_depth_ = std::max(largest_depth_, row.depth);
  largest_ = std::max({largest_, row.kinetic + row.strain + row.hourglass, std::abs(row.external_work)});
}

double HistoryReport::strain(bool quasi_static) const {
  return quasi_static ? last_.strain : largest_strain_;
}

double HistoryReport::hourglass(bool quasi_static) const {
  return quasi_static ? last_.hourglass : largest_hourglass_;
}

double HistoryReport::unexplained_share() const {
  const auto explained = [](const HistoryRow& row) {
    return row.kinetic + row.strain + row.hourglass + row.contact + row.friction + row.damping -
           row.external_work - row.adaption;
  };
  return largest_ > 0.0 ? (explained(last_) - explained(first_)) / largest_ : 0.0;
}

void print_static_ending(const Relaxation& found, Precision precision, double tolerance, bool went_on) {
  const bool rests = in_equilibrium(found);
  const std::string stability = found.stability_evaluations > 0
                                    ? fmt::format(" and {} of its stability", found.stability_evaluations)
                                    : std::string();
  fmt::print("{}: {}{}, {:.3g} s{}; residual {:.2e}, tolerance {:.2g}{}\n",
             rests ? fmt::format("static equilibrium ({})", stability_text(found)) : "no equilibrium",
             plural(found.steps, "evaluation"), stability, found.seconds,
             went_on ? " since the checkpoint" : "", found.residual, tolerance,
             !rests             ? "; " + outcome(found, precision)
             : !found.converged ? fmt::format(": {} precision resolves no more",
                                              precision == Precision::single_precision ? "single" : "double")
                                : "");
}

void print_dynamic_ending(const Motion& found, const Model& model, bool went_on) {
  const Scene& scene = model.scene();
  const std::string small =
      scene.settings.dynamics.subcycles > 1 ? plural(found.most_substeps, "subcycle") + ", " : std::string();
  const std::string ending =
      found.interrupted ? fmt::format("interrupted at step {}", found.steps) : "complete";
  const double of_step = found.seconds / static_cast<double>(std::max(found.steps, 1L));
  fmt::print("motion: {:.6g} s in {} of at least {}, {}{}; {:.3g} s{}\n", found.time,
             plural(found.steps, "step"), with_prefix(found.smallest_step, "s"), small, ending, found.seconds,
             went_on ? " since the checkpoint"
                     : fmt::format(", {:.4g} ns per element and step",
                                   1e9 * of_step / static_cast<double>(scene.mesh.cells.size())));
  if (model.choice().processor != nullptr) print_device(scene, found.traffic);
  if (found.never_adapted) {
    fmt::print(stderr,
               "warning: the motion ended before the levels of elements were chosen, so all had the lowest; "
               "take more "
               "steps (dynamics.step_fraction), or tl-mean-dilatation\n");
  }
}

void print_answer(const Model& model, const NodalField& u, const std::vector<double>& volume_ratios,
                  const HistoryReport& history) {
  const Scene& scene = model.scene();
  double largest = 0.0;
  for (const Vector& d : u) largest = std::max(largest, length(d));
  fmt::print("largest displacement {}", length_text(largest));
  if (!volume_ratios.empty()) {
    fmt::print("; smallest det F of an element {:.3g}",
               *std::min_element(volume_ratios.begin(), volume_ratios.end()));
  }
  fmt::print("{}", parts_text(scene));
  const bool quasi_static = scene.settings.quasi_static;
  const double share = share_of_strain_energy(model, history);
  if (share > 0.0) fmt::print("; hourglass energy {:.3g} % of strain energy", 100.0 * share);
  const HistoryRow& row = history.last();
  fmt::print("\nenergies (J): strain {:.6g}, hourglass {:.6g}", row.strain, row.hourglass);
  // Relaxation damps part of the external work away, so there the balance means nothing.
  if (!quasi_static) {
    fmt::print(", kinetic {:.6g}, external work {:.6g}", row.kinetic, row.external_work);
    if (row.adaption != 0.0) fmt::print(", added by changes of levels {:.3g}", row.adaption);
    const double damping = scene.settings.dynamics.damping;
    fmt::print("\nenergy balance: {:+.2g} % of the largest energy", 100.0 * history.unexplained_share());
    if (damping > 0.0)
      fmt::print("; damping is summed every {}", plural(scene.settings.dynamics.check_interval, "step"));
    if (std::ranges::any_of(scene.materials.list, is_viscoelastic, &Material::law))
      fmt::print("; relaxation is not counted");
  }
  if (row.friction != 0.0) fmt::print(", lost in contact {:.3g}", row.friction);
  fmt::print("\n");
  if (!contacts_of(scene.forces).empty()) {
    const double depth = history.largest_depth(quasi_static);
    fmt::print("largest depth of contact {}, {:.2g} % of the shortest edge\n", length_text(depth),
               100.0 * depth / shortest_edge(scene.mesh));
  }
  for (const auto& [set, force] : row.reactions) fmt::print("reaction at {} {}\n", set, force_text(force));
}

void warn_of_suspect(const Model& model, const HistoryReport& history) {
  const CaseSettings& settings = model.scene().settings;
  const std::string& method = model.choice().method;
  // Without kappa the control follows from the law: its energy is that of bending.
  if (const double share = share_of_strain_energy(model, history);
      share > much_hourglass && method_named(method).takes_kappa) {
    fmt::print(
        stderr,
        "warning: hourglass energy is {:.3g} % of strain energy, above {:g} %: the hourglass control affects "
        "the answer; compare with a finer mesh, or with --method tl-enhanced, whose control follows from the "
        "law\n",
        100.0 * share, 100.0 * much_hourglass);
  }
  if (!method_named(method).controls_hourglass) {
    fmt::print(
        stderr,
        "warning: method {} does not resist hourglass modes: look for zigzags, and compare with --method "
        "{}\n",
        method, golden_method);
  }
  const double depth = history.largest_depth(settings.quasi_static) / shortest_edge(model.scene().mesh);
  if (depth > much_depth) {
    const bool moves_nodes = std::ranges::any_of(contacts_of(model.scene().forces),
                                                 [](const auto* contact) { return contact->moves_nodes(); });
    fmt::print(
        stderr,
        "warning: nodes are {:.2g} % of the shortest edge deep in contact, above {:g} %: its forces may be "
        "too small; {}\n",
        100.0 * depth, 100.0 * much_depth,
        moves_nodes             ? "take a smaller step (step_fraction), or refine the mesh"
        : settings.quasi_static ? "raise its penalty"
                                : "raise its penalty, or take method = \"kinematic\"");
  }
  if (settings.quasi_static) return;
  const double damping = settings.dynamics.damping, unexplained = history.unexplained_share();
  const double much = damping > 0.0 ? much_unexplained_if_damped : much_unexplained;
  if (unexplained > much || (unexplained < -much && !dissipates(model))) {
    fmt::print(
        stderr,
        "warning: energy drifts: {:.2g} % of the largest was {}; take a smaller step (step_fraction) or "
        "another method{}\n",
        100.0 * std::abs(unexplained), unexplained > 0.0 ? "gained" : "lost",
        damping > 0.0
            ? "; with damping, check_interval = 1 tells whether only its losses were summed too coarsely"
            : "");
  }
}

void print_accuracy(const Scene& scene, const NodalField& u, bool on_own_mesh) {
  const References references = references_to_show(scene);
  const auto print = [&](const char* name, const std::optional<Displacements>& reference) {
    const auto figures = accuracy_of(scene, references.comparison, {u}, reference);
    if (!figures) return;
    fmt::print("against the {}: max {:.4g} %, rms {:.4g} % of the imposed displacement\n", name,
               100.0 * figures->max_relative_error, 100.0 * figures->rms_relative_error);
  };
  if (on_own_mesh) print("golden", references.golden);
  print("truth", references.truth);
}

void print_levels(const std::string& name, const std::vector<double>& levels, double share_of_time) {
  if (levels.empty()) return;
  std::string text;
  double level = 0.0;
  for (const auto& method : method_named(name).levels) {
    const auto count = static_cast<double>(std::count(levels.begin(), levels.end(), level++));
    text += fmt::format("{}{:.3g} % {}", text.empty() ? "" : ", ",
                        100.0 * count / static_cast<double>(levels.size()), method);
  }
  fmt::print("elements: {}; chosen in {:.2g} % of the time\n", text, 100.0 * share_of_time);
}

void print_estimate(std::string_view against, const Scene& scene, double unit, double largest, double rms,
                    const std::string& how) {
  fmt::print("estimated error against {}: max {:.4g} %, rms {:.4g} % of the {} displacement, {}\n", against,
             100.0 * largest / unit, 100.0 * rms / unit, largest_imposed(scene) > 0.0 ? "imposed" : "largest",
             how);
}

void print_traffic(const Ranks& ranks) {
  const auto most = [&](long number) {
    return ranks.largest(static_cast<double>(number)) /
           static_cast<double>(std::max(ranks.traffic().exchanges, 1L));
  };
  const Ranks::Traffic traffic = ranks.traffic();
  fmt::print("{} ranks: {} exchanges, each of at most {:.3g} messages and {:.0f} bytes from a rank\n",
             ranks.count(), traffic.exchanges, most(traffic.messages), most(traffic.bytes));
}

}  // namespace sandglass
