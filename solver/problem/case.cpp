#include "problem/case.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tuple>

#include "mesh/hash.hpp"

namespace sandglass {

namespace {

/// "name(parameter=value,...)" of an aggregate that declares its parameters.
template <class Aggregate>
std::string described(const Aggregate& aggregate) {
  std::string text = fmt::format("{}(", Aggregate::name);
  std::apply(
      [&](const auto&... parameter) {
        ((text += fmt::format("{}={},", parameter.name, aggregate.*(parameter.member))), ...);
      },
      Aggregate::parameters());
  return text + ")";
}

std::string described(const NodeSetRule& rule) {
  std::string text = fmt::format("{}(surface={}", rule.name, rule.surface);
  for (const auto& interval : rule.within) {
    text += interval ? fmt::format(",[{},{}]", interval->low, interval->high) : ",-";
  }
  if (const auto& c = rule.cylinder)
    text += fmt::format(",cylinder({},{},{})", c->axis, c->center, c->semi_axes);
  if (const auto& e = rule.ellipsoid) text += fmt::format(",ellipsoid({},{})", e->center, e->semi_axes);
  return text + ")";
}

/// Nothing for the volumetric part of the law itself.
std::string described(const VolumetricPart& volume) {
  if (std::holds_alternative<QuadraticPart>(volume)) return "";
  return std::visit([]<class Part>(const Part&) { return fmt::format("volumetric({})", Part::name); },
                    volume);
}

/// Nothing for an isotropic material.
std::string described(const FibreRule& rule) {
  if (const auto* uniform = std::get_if<UniformFibres>(&rule)) {
    return fmt::format("fibres({}:{})", uniform->fibre, uniform->sheet.value_or(Vector{}));
  }
  if (const auto* helix = std::get_if<HelicalFibres>(&rule)) {
    return fmt::format("helix({}:{}:{}:{})", helix->axis, helix->center, helix->radii, helix->angles);
  }
  if (const auto* listed = std::get_if<ListedFibres>(&rule)) {
    return fmt::format("fibres({}:{})", listed->fibres, listed->sheets);
  }
  return "";
}

std::string described(const LoadCurve& curve) {
  if (!curve.formula.empty()) return fmt::format("curve({})", curve.formula);
  return curve.times.empty() ? "" : fmt::format("curve({}:{})", curve.times, curve.factors);
}

/// What decides a motion beside what decides the answer at rest: inertia, damping, times, the start.
std::string described_motion(const Case& description) {
  const DynamicsSettings& settings = description.dynamics;
  std::string text = fmt::format("motion({}:{}:{})", settings.duration, settings.ramp_time, settings.damping);
  for (const auto& material : description.materials) text += fmt::format("density({})", material.density);
  for (const auto& support : description.supports) text += fmt::format("dashpot({})", support.damping);
  for (const auto& start : description.velocities) {
    text += fmt::format("velocity({}:{}:{}:{})", start.set.value_or("-"), start.value, start.half_waves,
                        start.spin);
  }
  return text;
}

}  // namespace

std::string case_hash(const Case& description) {
  std::string text;
  if (const auto* generator = std::get_if<AnyGenerator>(&description.mesh)) {
    text += std::visit([](const auto& g) { return described(g); }, *generator);
  } else {
    text += "file";  // its content is in the mesh hash
  }
  for (const auto& material : description.materials) {
    text += std::visit([](const auto& law) { return described(law); }, material.law);
    text += described(material.volume) + described(material.fibres);
    if (description.materials.size() > 1) text += fmt::format("of({})", material.elements);
  }
  for (const auto& rule : description.sets) text += described(rule);
  for (const auto& rule : description.element_sets) text += "elements " + described(rule);
  for (const auto& [around, elements, numbers, after, depth, layers] : description.refinements) {
    text += fmt::format("refine({}:{}:{}:{})", around, elements, depth, layers);
    if (!numbers.empty()) text += fmt::format("{}:{}", after, numbers);
  }
  for (const auto& [set, elements] : description.ties) text += fmt::format("tie({}:{})", set, elements);
  for (const auto& imposed : description.displacements) {
    text += fmt::format("{}:{}:{};", imposed.set, imposed.value, imposed.components);
  }
  for (const auto& turned : description.rotations) {
    text += fmt::format("rotation({}:{}:{}:", turned.set, turned.axis, turned.angle);
    text += turned.center ? fmt::format("{}", *turned.center) : "-";
    text += fmt::format(":{})", turned.displacement);
  }
  for (const auto& force : description.forces) {
    text += fmt::format("force({}:{}:{})", force.set, force.total, force.moment) + described(force.curve);
    if (force.on_nodes) text += "on nodes";
  }
  for (const auto& pressure : description.pressures) {
    text += fmt::format("pressure({}:{})", pressure.set, pressure.value) + described(pressure.curve);
  }
  for (const auto& gravity : description.gravity) {
    text += fmt::format("gravity({})", gravity.value) + described(gravity.curve);
    for (const auto& material : description.materials) text += fmt::format("density({})", material.density);
  }
  for (const auto& support : description.supports) {
    text += fmt::format("support({}:{}:{})", support.set, support.stiffness, support.only_normal);
  }
  if (!description.quasi_static) text += described_motion(description);
  return hash_of(text);
}

void scale_load(Case& description, double factor) {
  for (auto& displacement : description.displacements) {
    for (double& d : displacement.value) d *= factor;
  }
  for (auto& rotation : description.rotations) {
    rotation.angle *= factor;
    for (double& d : rotation.displacement) d *= factor;
  }
  for (auto& force : description.forces) {
    for (double& f : force.total) f *= factor;
    for (double& m : force.moment) m *= factor;
  }
  for (auto& pressure : description.pressures) pressure.value *= factor;
  for (auto& gravity : description.gravity) {
    for (double& g : gravity.value) g *= factor;
  }
  for (auto& start : description.velocities) {
    for (double& v : start.value) v *= factor;
    for (double& w : start.spin) w *= factor;
  }
}

}  // namespace sandglass
