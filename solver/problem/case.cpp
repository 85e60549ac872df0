#include "problem/case.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "mesh/hash.hpp"

namespace sandglass {

namespace {

/// "name(parameter=value,...)" for an aggregate with declared parameters. Optional vectors that are zero are
/// left out.
template <class Aggregate>
std::string described(const Aggregate& aggregate) {
  std::string text = fmt::format("{}(", Aggregate::name);
  const auto add = [&]<class Value>(const Parameter<Aggregate, Value>& parameter) {
    const Value& value = aggregate.*(parameter.member);
    if constexpr (std::is_same_v<Value, Vector>) {
      if (!parameter.required && value == Vector{}) return;
    }
    text += fmt::format("{}={},", parameter.name, value);
  };
  std::apply([&](const auto&... parameter) { (add(parameter), ...); }, Aggregate::parameters());
  return text + ")";
}

std::string described(const MeshSource& source) {
  if (const auto* generator = std::get_if<AnyGenerator>(&source))
    return std::visit([](const auto& g) { return described(g); }, *generator);
  std::string text = "file";  // its content is in the mesh hash
  if (const auto* bodies = std::get_if<std::vector<PlacedBody>>(&source)) {
    text = "bodies";
    for (const auto& [label, turn, offset, generator] : *bodies)
      text += fmt::format("({}:{}:{}:{})", label, turn, offset, described(MeshSource(generator)));
  }
  return text;
}

std::string described(const NodeSetRule& rule) {
  const auto& [name, surface, within, cylinder, ellipsoid] = rule;
  std::string text = fmt::format("{}(surface={}", name, surface);
  for (const auto& interval : within) {
    text += interval ? fmt::format(",[{},{}]", interval->low, interval->high) : ",-";
  }
  if (cylinder) {
    const auto& [axis, center, semi_axes] = *cylinder;
    text += fmt::format(",cylinder({},{},{})", axis, center, semi_axes);
  }
  if (ellipsoid) {
    const auto& [center, semi_axes] = *ellipsoid;
    text += fmt::format(",ellipsoid({},{})", center, semi_axes);
  }
  return text + ")";
}

/// Empty for the law's own volumetric part.
std::string described(const VolumetricPart& volume) {
  if (std::holds_alternative<QuadraticPart>(volume)) return "";
  return std::visit([]<class Part>(const Part&) { return fmt::format("volumetric({})", Part::name); },
                    volume);
}

/// Empty for an isotropic material.
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
  if (!curve.formula.text.empty()) return fmt::format("curve({})", curve.formula.text);
  return curve.times.empty() ? "" : fmt::format("curve({}:{})", curve.times, curve.factors);
}

/// Text of words or numbers.
template <class Value>
std::string text_of(const Value& value) {
  if constexpr (std::is_enum_v<Value>) {
    return std::string(words_of(value)[static_cast<std::size_t>(value)]);
  } else {
    return fmt::format("{}", value);
  }
}

/// Whether a parameter changes how accurately an answer is computed, but not the exact answer.
template <class Force>
constexpr bool is_numerical(std::string_view parameter) {
  if constexpr (requires { Force::numerical; }) {
    return std::ranges::find(Force::numerical, parameter) != Force::numerical.end();
  } else {
    return false;
  }
}

template <class Force>
constexpr bool is_only_in_motion(std::string_view parameter) {
  if constexpr (requires { Force::only_in_motion; }) return Force::only_in_motion == parameter;
  return false;
}

/// "name(value:value)" with the parameters of a force that affect a static answer, or with those that affect
/// only motions; then its curve, and words other than the default.
template <class Force>
std::string described(const Force& force, bool in_motion) {
  std::vector<std::string> values;
  std::string others;
  const auto add = [&]<class Value>(const Parameter<Force, Value>& parameter) {
    const Value& value = force.*(parameter.member);
    if (is_only_in_motion<Force>(parameter.name) != in_motion || is_numerical<Force>(parameter.name)) return;
    if constexpr (std::is_same_v<Value, LoadCurve>) {
      others += described(value);
    } else if constexpr (requires { Value::value_type::parameters(); }) {
      for (const auto& each : value) others += described(each, in_motion);
    } else if constexpr (std::is_enum_v<Value>) {
      if (value != Force{}.*(parameter.member))
        others += fmt::format("{} {}", parameter.name, text_of(value));
    } else if constexpr (std::is_same_v<Value, Vector>) {
      values.push_back(fmt::format("{}", std::isnan(value[0]) ? Vector{} : value));  // not given
    } else {
      values.push_back(fmt::format("{}", value));
    }
  };
  std::apply([&](const auto&... parameter) { (add(parameter), ...); }, Force::parameters());
  if (values.empty()) return "";
  return fmt::format("{}({}){}", Force::name, fmt::join(values, ":"), others);
}

/// Everything that affects only motions: inertia, damping, times, initial velocities.
std::string described_motion(const Case& description) {
  const auto& [duration, ramp_time, time_step, step_fraction, damping, subcycles, body_frequency,
               check_interval, frames] = description.dynamics;
  std::string text = fmt::format("motion({}:{}:{})", duration, ramp_time, damping);
  for (const auto& material : description.materials) text += fmt::format("density({})", material.density);
  description.forces.for_each([&](const auto& force) { text += described(force, true); });
  for (const auto& [set, value, half_waves, spin] : description.velocities)
    text += fmt::format("velocity({}:{}:{}:{})", set.empty() ? "-" : set, value, half_waves, spin);
  return text;
}

}  // namespace

std::optional<BrokenRule> Refinement::broken_rule() const {
  if (!around.empty() + !elements.empty() + !numbers.empty() != 1) {
    return BrokenRule{"around",
                      "elements or numbers: exactly one of the three must be given: the name of a node set, "
                      "the name of an element set, or numbers of at least one element"};
  }
  if (after != 0 && numbers.empty()) return BrokenRule{"after", "needs numbers; leave it out"};
  if (depth != 1 && !numbers.empty())
    return BrokenRule{"depth", "cannot be combined with numbers; leave it out"};
  if (layers != 2 && around.empty()) return BrokenRule{"layers", "needs around; leave it out"};
  return std::nullopt;
}

std::string case_hash(const Case& description) {
  std::string text = described(description.mesh);
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
  for (const auto& [set, value, components] : description.displacements)
    text += fmt::format("{}:{}:{};", set, value, components);
  for (const auto& [set, axis, angle, center, displacement] : description.rotations) {
    text += fmt::format("rotation({}:{}:{}:{}:{})", set, axis, angle,
                        center ? fmt::format("{}", *center) : "-", displacement);
  }
  description.forces.for_each([&]<class Force>(const Force& force) {
    text += described(force, false);
    for (const auto& material : description.materials)
      text += Force::by_mass ? fmt::format("density({})", material.density) : "";
  });
  if (!description.quasi_static) text += described_motion(description);
  return hash_of(text);
}

std::string numerical_settings(const Case& description) {
  const auto& [tolerance, levels, cycles, max_steps, check_interval] = description.relaxation;
  std::string text =
      fmt::format("cycles {} tolerance {} levels {} at most {}", cycles, tolerance, levels, max_steps);
  description.forces.for_each([&]<class Force>(const Force& force) {
    const auto add = [&]<class Value>(const Parameter<Force, Value>& parameter) {
      constexpr bool is_plain = !std::is_same_v<Value, LoadCurve> && !requires {
        Value::value_type::parameters();
      };
      if constexpr (is_plain) {
        if (is_numerical<Force>(parameter.name))
          text += fmt::format(" {} {}", parameter.name, text_of(force.*(parameter.member)));
      }
    };
    std::apply([&](const auto&... parameter) { (add(parameter), ...); }, Force::parameters());
  });
  return text;
}

}  // namespace sandglass
