#include "stability/axis.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "base/names.hpp"
#include "choice/variations.hpp"

namespace sandglass {

namespace {

/// Evaluations of the forces after which a trial has no equilibrium: existing answers take a few thousand.
constexpr int most_evaluations = 20000;

bool has_generator(const Case& description) {
  return !std::holds_alternative<MeshFile>(description.mesh);
}

bool has_obstacles(const Case& description) {
  return !description.forces.of<Obstacle>().empty();
}

/// A set is not rigid in rotation once it is stretched, and obstacles keep their shape.
bool can_be_shaped(const Case& description) {
  return has_generator(description) && description.rotations.empty() && !has_obstacles(description);
}

bool has_poisson_ratio(const Case& description) {
  if (description.materials.size() > 1) return false;  // ambiguous
  return std::visit(
      []<class Law>(const Law&) {
        return requires(Law law) {
          law.poisson_ratio = 0.0;
        };
      },
      description.materials.front().law);
}

bool can_move(const Trial& trial) {
  return !method_named(trial.choice.method).is_condensed;
}

/// The strength of a control that resists velocities only does not matter in static equilibrium.
bool takes_strength(const Trial& trial) {
  const MethodEntry& method = method_named(trial.choice.method);
  return !method.is_condensed && (trial.is_dynamic() ? method.takes_kappa : method.kappa_affects_equilibrium);
}

void set_kappa(Trial& trial, double value) {
  trial.choice.kappa = value;
}

void set_poisson_ratio(Trial& trial, double value) {
  std::visit(
      [&](auto& law) {
        if constexpr (requires { law.poisson_ratio = value; }) law.poisson_ratio = value;
      },
      trial.description.materials.front().law);
}

void set_penalty(Trial& trial, double value) {
  for (Obstacle& obstacle : trial.description.forces.of<Obstacle>()) obstacle.penalty = value;
}

void set_load(Trial& trial, double value) {
  trial.load = value;
}

void set_aspect(Trial& trial, double value) {
  trial.aspect = value;
}

void set_skew(Trial& trial, double value) {
  trial.skew = value;
}

void set_elements(Trial& trial, double value) {
  const auto set = [&](AnyGenerator& generator) {
    generator = with_elements_across(generator, static_cast<int>(value));
  };
  MeshSource& mesh = trial.description.mesh;
  if (auto* bodies = std::get_if<std::vector<PlacedBody>>(&mesh)) {
    for (PlacedBody& body : *bodies) set(body.generator);
  } else {
    set(std::get<AnyGenerator>(mesh));
  }
}

void set_bytes(Trial& trial, double value) {
  trial.choice.precision = value == 8.0 ? Precision::double_precision : Precision::single_precision;
}

void set_cycles(Trial& trial, double value) {
  trial.description.relaxation.cycles = static_cast<int>(value);
}

void set_step(Trial& trial, double value) {
  trial.step = value;
}

void set_noise(Trial& trial, double value) {
  trial.noise = value;
}

constexpr Range four_or_eight{.low = 4.0, .high = 8.0, .low_open = false, .high_open = false};

const std::vector<Axis>& list() {
  static const std::vector<Axis> axes{
      {.name = "kappa",
       .range = Range::at_least(0.0),
       .meaning = "strength of the hourglass control",
       .values = {1e-4, 3e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1, 0.3},
       .apply = set_kappa,
       .matters = takes_strength},
      {.name = "nu",
       .range = Range::between(-1.0, 0.5),
       .meaning = "initial Poisson's ratio",
       .values = {0.25, 0.4, 0.45, 0.49, 0.499, 0.4999},
       .apply = set_poisson_ratio,
       .possible = has_poisson_ratio,
       .needs = "a law with poisson_ratio"},
      {.name = "penalty",
       .range = Range::positive(),
       .meaning = "penalty of the obstacles",
       .values = {1, 3, 10, 30, 100, 300, 1000, 3000},
       .apply = set_penalty,
       .possible = has_obstacles,
       .needs = "an [[obstacle]]"},
      {.name = "load",
       .range = Range::positive(),
       .meaning = "imposed motions and forces over those of the case",
       .values = {0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 2.0},
       .apply = set_load},
      {.name = "aspect",
       .range = Range::positive(),
       .meaning = "stretch of body, elements and imposed displacements along z",
       .values = {0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0},
       .apply = set_aspect,
       .possible = can_be_shaped,
       .needs = "a mesh from a generator, no imposed rotation and no [[obstacle]]"},
      {.name = "skew",
       .range = Range::any(),
       .meaning = "slope dx/dz of body, elements and imposed displacements",
       .values = {0.0, 0.25, 0.5, 1.0},
       .apply = set_skew,
       .possible = can_be_shaped,
       .needs = "a mesh from a generator, no imposed rotation and no [[obstacle]]"},
      {.name = "elements",
       .range = Range::at_least(1.0),
       .meaning = "elements across the thinnest part; all directions in proportion",
       .values = {1, 2, 3, 4, 6},
       .whole_numbers = true,
       .apply = set_elements,
       .possible = has_generator,
       .needs = "a mesh from a generator"},
      {.name = "bytes",
       .range = four_or_eight,
       .meaning = "bytes of a number: 4 for float, 8 for double",
       .values = {4, 8},
       .whole_numbers = true,
       .apply = set_bytes},
      {.name = "cycles",
       .range = Range::at_least(0.0),
       .meaning = "number of times that the load returns to a tenth and rises again",
       .values = {0, 1, 3, 10},
       .whole_numbers = true,
       .apply = set_cycles,
       .matters = can_move},
      {.name = "step",
       .range = Range::positive(),
       .meaning = "dynamic: time step over the stable one",
       .values = {0.5, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4, 1.6, 2.0},
       .apply = set_step,
       .matters = can_move},
      {.name = "noise",
       .range = Range::positive(),
       .meaning = "dynamic: initial zigzag of velocities over the speed of shear waves, good up to a tenth "
                  "of its free path",
       .values = {0.001, 0.01, 0.1, 0.3},
       .apply = set_noise,
       .matters = can_move}};
  return axes;
}

double parse_value(const Axis& axis, const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool number = error == std::errc() && end == text.data() + text.size();
  if (number && axis.range.contains(value) && (!axis.whole_numbers || value == std::round(value)))
    return value;
  throw InputError(fmt::format("--values: {} = '{}' must be a {} in {}", axis.name, text,
                               axis.whole_numbers ? "whole number" : "number", axis.range.text()));
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  std::size_t start = 0;
  for (std::size_t comma; (comma = text.find(',', start)) != std::string::npos; start = comma + 1) {
    parts.push_back(text.substr(start, comma - start));
  }
  parts.push_back(text.substr(start));
  return parts;
}

}  // namespace

std::span<const Axis> axes() {
  return list();
}

const Axis& find_axis(std::string_view name) {
  std::vector<std::string> known;
  for (const auto& axis : axes()) {
    if (axis.name == name) return axis;
    known.emplace_back(axis.name);
  }
  throw InputError(fmt::format("'{}' is not an axis of a map; {}", name, suggestion(name, known)));
}

std::string Map::name() const {
  return y == nullptr ? std::string(x->name) : fmt::format("{}-{}", x->name, y->name);
}

Map parse_map(const std::string& text) {
  const auto names = split(text);
  if (names.size() > 2 || (names.size() == 2 && names[0] == names[1])) {
    throw InputError(
        fmt::format("--map = '{}' must be one axis, or two different ones separated by a comma", text));
  }
  const Axis& x = find_axis(names[0]);
  if (names.size() == 1) return {&x, nullptr, x.values};
  const Axis& y = find_axis(names[1]);
  return {&x, &y, x.values, y.values};
}

std::vector<Map> usual_maps(const Case& description) {
  std::vector<Map> maps;
  for (const auto* text : {"load,nu", "kappa,nu", "aspect,skew", "elements,nu", "bytes,nu", "cycles,load",
                           "step,load", "noise,nu"}) {
    Map map = parse_map(text);
    if (map.x->possible(description) && map.y->possible(description)) maps.push_back(std::move(map));
  }
  return maps;
}

void set_values(const std::string& text, std::vector<Map>& maps) {
  const std::size_t sign = text.find('=');
  if (sign == std::string::npos) {
    throw InputError(
        fmt::format("--values = '{}' must be an axis, '=', and values separated by commas", text));
  }
  const Axis& axis = find_axis(text.substr(0, sign));
  std::vector<double> values;
  for (const auto& part : split(text.substr(sign + 1))) values.push_back(parse_value(axis, part));
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  bool used = false;
  for (auto& map : maps) {
    if (map.x == &axis) map.xs = values;
    if (map.y == &axis) map.ys = values;
    used = used || map.x == &axis || map.y == &axis;
  }
  if (!used)
    throw InputError(fmt::format("--values: no map has the axis '{}'; name it with --map", axis.name));
}

void require_possible(const Map& map, const Case& description) {
  for (const Axis* axis : {map.x, map.y}) {
    if (axis == nullptr || axis->possible(description)) continue;
    throw InputError(fmt::format("{}: this case cannot be varied along '{}' ({}): it needs {}",
                                 description.file.string(), axis->name, axis->meaning, axis->needs));
  }
}

Trial trial_of(const Map& map, const Case& description, const std::string& method, double x, double y) {
  Trial trial{description, {method}};
  auto& most = trial.description.relaxation.max_steps;
  most = std::min(most, most_evaluations);
  map.x->apply(trial, x);
  if (map.y != nullptr) map.y->apply(trial, y);
  return trial;
}

bool concerns(const Map& map, const Case& description, const std::string& method) {
  const Trial trial = trial_of(map, description, method, map.xs.front(), map.ys.front());
  return map.x->matters(trial) && (map.y == nullptr || map.y->matters(trial));
}

}  // namespace sandglass
