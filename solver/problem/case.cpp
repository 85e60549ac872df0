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
  return text + ")";
}

}  // namespace

std::string case_hash(const Case& scene) {
  std::string text;
  if (const auto* generator = std::get_if<AnyGenerator>(&scene.mesh)) {
    text += std::visit([](const auto& g) { return described(g); }, *generator);
  } else {
    text += "file";  // its content is in the mesh hash
  }
  text += std::visit([](const auto& law) { return described(law); }, scene.law);
  for (const auto& rule : scene.sets) text += described(rule);
  for (const auto& imposed : scene.displacements) {
    text += fmt::format("{}:{}:{};", imposed.set, imposed.value, imposed.components);
  }
  for (const auto& turned : scene.rotations) {
    text += fmt::format("rotation({}:{}:{}:", turned.set, turned.axis, turned.angle);
    text += turned.center ? fmt::format("{}", *turned.center) : "-";
    text += fmt::format(":{})", turned.displacement);
  }
  for (const auto& force : scene.forces) {
    text += fmt::format("force({}:{}:{})", force.set, force.total, force.moment);
  }
  return hash_of(text);
}

}  // namespace sandglass
