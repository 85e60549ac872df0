#include "io/case_file.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "io/case_variants.hpp"
#include "io/foreign_file.hpp"
#include "io/mesh_file.hpp"
#include "io/table_reader.hpp"
#include "model/method_entry.hpp"

namespace sandglass {

namespace {

/// The entry of a list of types that a key names, with its parameters read.
template <class List>
VariantOf<List> read_listed(TableReader& table, const std::string& key) {
  VariantOf<List> chosen;
  with_named_type(List{}, table.required_choice(key, names_of(List{})), [&]<class Type>() {
    Type value{};
    table.parameters(value);
    chosen = value;
  });
  return chosen;
}

void read_mesh(TableReader& reader, Case& scene) {
  TableReader table = reader.required_table("mesh");
  if (const auto file = table.optional<std::string>("file")) {
    scene.mesh = MeshFile{scene.file.parent_path() / *file};
  } else {
    const auto keys = table.keys();
    if (std::find(keys.begin(), keys.end(), "generator") == keys.end()) {
      table.fail("generator",
                 fmt::format("is missing; this key or mesh.file must be given, but there {}",
                             keys.empty() ? "is no key" : fmt::format("is only {}", fmt::join(keys, ", "))));
    }
    scene.mesh = read_listed<Generators>(table, "generator");
  }
  table.finish();
}

void read_material(TableReader table, Case& scene) {
  scene.law = read_listed<Laws>(table, "law");
  scene.density = table.required<double>("density");
  table.require_in_range("density", scene.density, Range::positive());
  table.finish();
}

CylinderRegion read_cylinder(TableReader table) {
  CylinderRegion region;
  region.axis = table.required_choice("axis", {"x", "y", "z"})[0] - 'x';
  region.center = table.required<std::array<double, 2>>("center");
  region.semi_axes = table.required<std::array<double, 2>>("semi_axes");
  for (const double a : region.semi_axes) table.require_in_range("semi_axes", a, Range::positive());
  table.finish();
  return region;
}

NodeSetRule read_set(TableReader table, const std::string& name) {
  NodeSetRule rule;
  rule.name = name;
  rule.surface = table.optional<bool>("surface").value_or(false);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string key(1, "xyz"[i]);
    const auto ends = table.optional<std::array<double, 2>>(key);
    if (!ends) continue;
    const auto [low, high] = *ends;
    if (!(low <= high))
      table.fail(key, fmt::format("= [{}, {}] must be an interval, low end first", low, high));
    rule.within[i] = Interval{low, high};
  }
  if (auto cylinder = table.table("cylinder")) rule.cylinder = read_cylinder(*cylinder);
  table.finish();
  return rule;
}

ImposedDisplacement read_displacement(TableReader table) {
  ImposedDisplacement imposed;
  imposed.set = table.required<std::string>("set");
  imposed.value = table.required<Vector>("value");
  for (const double d : imposed.value) table.require_in_range("value", d, Range::any());
  if (const auto components = table.optional<std::string>("components")) {
    imposed.components = {};
    for (const char c : *components) {
      if (c < 'x' || c > 'z')
        table.fail("components", fmt::format("= '{}' must consist of x, y, z", *components));
      imposed.components[static_cast<std::size_t>(c - 'x')] = true;
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (!imposed.components[i]) imposed.value[i] = 0.0;
  }
  table.finish();
  return imposed;
}

/// An axis as written: a letter, or a vector of any length but zero. Returns it with length one.
Vector read_axis(TableReader& table) {
  Vector axis{};
  if (table.holds_text("axis")) {
    axis[static_cast<std::size_t>(table.required_choice("axis", {"x", "y", "z"})[0] - 'x')] = 1.0;
    return axis;
  }
  axis = table.required<Vector>("axis");
  for (const double a : axis) table.require_in_range("axis", a, Range::any());
  const double length = std::hypot(axis[0], axis[1], axis[2]);
  if (length == 0.0) table.fail("axis", "= [0, 0, 0] must not be zero: it is a direction");
  for (double& a : axis) a /= length;
  return axis;
}

ImposedRotation read_rotation(TableReader table) {
  ImposedRotation turned;
  turned.set = table.required<std::string>("set");
  turned.axis = read_axis(table);
  const auto degrees = table.required<double>("angle");
  table.require_in_range("angle", degrees, Range::any());
  turned.angle = degrees / 180.0 * std::numbers::pi;
  turned.center = table.optional<Vector>("center");
  for (const double c : turned.center.value_or(Vector{})) table.require_in_range("center", c, Range::any());
  turned.displacement = table.optional<Vector>("displacement").value_or(Vector{});
  for (const double d : turned.displacement) table.require_in_range("displacement", d, Range::any());
  table.finish();
  return turned;
}

/// Along an axis, or around it.
std::vector<std::string> directions() {
  return {"x", "y", "z", "around-x", "around-y", "around-z"};
}

ImposedForce read_force(TableReader table) {
  ImposedForce force;
  force.set = table.required<std::string>("set");
  const auto total = table.optional<Vector>("total"), moment = table.optional<Vector>("moment");
  if (!total && !moment) table.fail("total", "or moment must be given, or both");
  force.total = total.value_or(Vector{});
  force.moment = moment.value_or(Vector{});
  for (const double f : force.total) table.require_in_range("total", f, Range::any());
  for (const double m : force.moment) table.require_in_range("moment", m, Range::any());
  table.finish();
  return force;
}

InitialVelocity read_velocity(TableReader table) {
  InitialVelocity velocity;
  velocity.set = table.optional<std::string>("set");
  const auto value = table.optional<Vector>("value"), spin = table.optional<Vector>("spin");
  if (!value && !spin) table.fail("value", "or spin must be given, or both");
  velocity.value = value.value_or(Vector{});
  velocity.spin = spin.value_or(Vector{});
  for (const double v : velocity.value) table.require_in_range("value", v, Range::any());
  for (const double w : velocity.spin) table.require_in_range("spin", w, Range::any());
  if (const auto half_waves = table.optional<std::array<int, 3>>("half_waves")) {
    for (const int n : *half_waves) table.require_in_range("half_waves", n, Range::at_least(0.0));
    velocity.half_waves = *half_waves;
  }
  table.finish();
  return velocity;
}

PublishedValue read_published(TableReader table) {
  PublishedValue published;
  published.set = table.required<std::string>("set");
  published.component = table.required_choice("component", directions());
  published.value = table.required<double>("value");
  table.require_in_range("value", published.value, Range::any());
  if (published.value == 0.0) table.fail("value", "= 0 must not be zero: results are told as shares of it");
  published.source = table.required<std::string>("source");
  table.finish();
  return published;
}

Profile read_profile(TableReader table) {
  Profile profile{.set = table.required<std::string>("set"),
                  .order = table.required_choice("order", directions())};
  table.finish();
  return profile;
}

/// A kappa as written: a number, "auto" (also when absent) or "best".
std::string read_kappa(TableReader& table) {
  if (table.holds_number("kappa")) {
    const auto kappa = table.required<double>("kappa");
    table.require_in_range("kappa", kappa, Range::at_least(0.0));
    return fmt::to_string(kappa);
  }
  return table.optional<std::string>("kappa") ? table.required_choice("kappa", {"auto", "best"}) : "auto";
}

/// The hourglass parameter of a method as written: a number, or none for "auto".
std::optional<double> read_strength(TableReader& table, const std::string& method) {
  if (!table.holds_number("kappa")) {
    if (table.optional<std::string>("kappa")) table.required_choice("kappa", {"auto"});
    return std::nullopt;
  }
  const auto kappa = table.required<double>("kappa");
  table.require_in_range("kappa", kappa, Range::at_least(0.0));
  if (!method_named(method).takes_kappa) {
    table.fail("kappa", fmt::format("= {} was given, but method '{}' has no such parameter", kappa, method));
  }
  return kappa;
}

MethodChoice read_method(TableReader table) {
  MethodChoice choice;
  choice.method = table.required_choice("name", method_names());
  choice.kappa = read_strength(table, choice.method);
  const auto is = [&](const std::string& key, const std::vector<std::string>& words, std::string_view word) {
    return table.optional<std::string>(key) && table.required_choice(key, words) == word;
  };
  if (is("kappa_modulus", {"p-wave", "shear"}, "shear")) choice.kappa_modulus = KappaModulus::shear;
  if (is("precision", {"double", "float"}, "float")) choice.precision = Precision::single_precision;
  if (const auto accuracy = table.optional<double>("accuracy")) {
    if (!method_named(choice.method).adapts())
      table.fail("accuracy", "is for an adaptive method alone; leave it out");
    if (!(*accuracy > 0.0)) table.fail("accuracy", "must be positive");
    choice.accuracy = *accuracy;
  }
  table.finish();
  return choice;
}

Expectation read_expectation(TableReader table) {
  Expectation expected;
  expected.method = table.required_choice("method", method_names());
  expected.kappa = read_kappa(table);
  expected.reference = table.required_choice("reference", {"golden", "truth", "published"});
  expected.figure = table.required_choice(
      "figure",
      expected.reference == "published"
          ? std::vector<std::string>{"relative_error"}
          : std::vector<std::string>{"max_relative_error", "profile_relative_error", "rms_relative_error"});
  expected.below = table.optional<double>("below");
  expected.above = table.optional<double>("above");
  expected.reason = table.required<std::string>("reason");
  table.finish();
  if (expected.below.has_value() == expected.above.has_value()) {
    table.fail("below", "or above must be given, one of the two");
  }
  return expected;
}

void read_comparison(TableReader table, Case& scene) {
  scene.kappas = table.optional<std::vector<double>>("kappas").value_or(std::vector<double>{});
  for (const double kappa : scene.kappas) table.require_in_range("kappas", kappa, Range::at_least(0.0));
  const auto folder = scene.file.parent_path();
  if (const auto golden = table.optional<std::string>("golden")) scene.golden = folder / *golden;
  if (const auto truth = table.optional<std::string>("truth")) scene.truth = folder / *truth;
  table.finish();
}

void read_header(TableReader table, Case& scene) {
  scene.family = table.required<std::string>("name");
  scene.name = scene.family;
  for (const auto& variant : scene.variants) scene.name += "-" + variant;
  scene.requirement = table.required<std::string>("requirement");
  scene.quasi_static = table.required_choice("answer", {"quasi-static", "dynamic"}) == "quasi-static";
  table.finish();
}

MeshWithSets read_mesh_of(const Case& scene, const MeshFile& file) {
  try {
    return is_foreign_mesh(file.path) ? read_foreign_mesh(file.path) : read_mesh_file(file.path);
  } catch (const InputError& error) {
    const std::string ending = file.path.extension().string();
    const bool ours = is_foreign_mesh(file.path) || ending == ".h5" || ending == ".hdf5";
    throw InputError(
        fmt::format("{}: mesh.file: {}{}", scene.file.string(), error.what(),
                    ours ? "" : "; what is no HDF5 file must end in .msh (Gmsh), .inp (Abaqus) or .vtu"));
  }
}

/// Lines about the parameters of one aggregate, for people.
template <class Aggregate>
std::string described(const std::string& table) {
  const Aggregate defaults{};
  std::string text;
  std::apply(
      [&](const auto&... p) {
        const auto line = [&](const auto& parameter) {
          using Value = std::remove_cvref_t<decltype(defaults.*(parameter.member))>;
          std::string fallback = "required";
          if constexpr (std::is_arithmetic_v<Value>) {
            if (!parameter.required) fallback = fmt::format("default {}", defaults.*(parameter.member));
          }
          text += fmt::format(
              "  {:<28} {:<6} {:<12} {:<16} {}\n", fmt::format("{}.{}", table, parameter.name),
              fmt::format("[{}]", parameter.unit), parameter.range.text(), fallback, parameter.meaning);
        };
        (line(p), ...);
      },
      Aggregate::parameters());
  return text;
}

template <class... Types>
std::string described_list(TypeList<Types...> /*list*/, const std::string& table, const std::string& key) {
  std::string text;
  ((text += fmt::format("\n{}.{} = \"{}\": {}\n{}", table, key, Types::name, Types::summary,
                        described<Types>(table))),
   ...);
  return text;
}

/// `read_mesh(reader, case)` says where its mesh is from.
template <class ReadMesh>
Case read_case(const CaseTables& tables, const std::filesystem::path& path, const ReadMesh& read_mesh) {
  Case scene;
  scene.file = path;
  scene.variants = tables.variants;
  TableReader reader(tables.root, path, "");
  read_header(reader.required_table("case"), scene);
  scene.golden = path.parent_path() / ".." / "reference" / "golden" / (scene.name + ".h5");
  scene.truth = path.parent_path() / ".." / "reference" / "truth" / (scene.name + ".h5");
  read_mesh(reader, scene);
  read_material(reader.required_table("material"), scene);
  if (auto sets = reader.table("sets")) {
    for (const auto& name : sets->keys()) scene.sets.push_back(read_set(sets->required_table(name), name));
  }
  for (const auto& table : reader.tables("displacement"))
    scene.displacements.push_back(read_displacement(table));
  for (const auto& table : reader.tables("rotation")) scene.rotations.push_back(read_rotation(table));
  for (const auto& table : reader.tables("force")) scene.forces.push_back(read_force(table));
  if (auto profile = reader.table("profile")) scene.profile = read_profile(*profile);
  if (auto relaxation = reader.table("relaxation")) {
    relaxation->parameters(scene.relaxation);
    relaxation->finish();
  }
  if (!scene.quasi_static) {
    for (const auto& table : reader.tables("velocity")) scene.velocities.push_back(read_velocity(table));
    auto dynamics = reader.required_table("dynamics");
    dynamics.parameters(scene.dynamics);
    dynamics.finish();
  }
  if (auto method = reader.table("method")) scene.method = read_method(*method);
  if (auto comparison = reader.table("comparison")) read_comparison(*comparison, scene);
  for (const auto& table : reader.tables("published")) scene.published.push_back(read_published(table));
  for (const auto& table : reader.tables("expect")) scene.expectations.push_back(read_expectation(table));
  reader.finish();
  if (scene.quasi_static && scene.displacements.empty() && scene.rotations.empty()) {
    reader.fail("displacement",
                "is missing; a quasi-static case needs at least one [[displacement]] or [[rotation]]");
  }
  return scene;
}

}  // namespace

std::vector<Case> read_cases(const std::filesystem::path& path) {
  std::vector<Case> cases;
  for (const auto& tables : read_case_tables(path)) cases.push_back(read_case(tables, path, read_mesh));
  return cases;
}

Case read_case_file(const std::filesystem::path& path) {
  auto cases = read_cases(path);
  if (cases.size() > 1) {
    throw InputError(fmt::format("{}: has {} variants, '{}' and others; one of them must be named",
                                 path.string(), cases.size(), cases.front().name));
  }
  return std::move(cases.front());
}

Scene read_scene(Case scene) {
  if (const auto* file = std::get_if<MeshFile>(&scene.mesh)) {
    MeshWithSets read = read_mesh_of(scene, *file);
    return make_scene(std::move(scene), std::move(read.mesh), std::move(read.sets));
  }
  Mesh mesh = generate_mesh(std::get<AnyGenerator>(scene.mesh));
  return make_scene(std::move(scene), std::move(mesh));
}

Scene read_scene(const std::filesystem::path& path) {
  return read_scene(read_case_file(path));
}

Scene read_scene(const std::string& text, MeshWithSets mesh) {
  const std::string name = "case text";
  const auto in_memory = [&](TableReader& /*reader*/, Case& scene) { scene.mesh = MeshFile{"in memory"}; };
  return make_scene(read_case(parse_case_text(text, name), name, in_memory), std::move(mesh.mesh),
                    std::move(mesh.sets));
}

MethodChoice method_of(const Case& description, const std::optional<std::string>& named) {
  MethodChoice choice = description.method.value_or(MethodChoice{.method = "tl-perturbation"});
  if (named && *named != choice.method) choice = {.method = *named, .precision = choice.precision};
  return choice;
}

std::string describe_case_keys() {
  std::string text =
      "Keys of a case file (TOML). Tables and their parameters: name, unit, range, default, meaning.\n"
      "\n[case] name, requirement: texts; answer: \"quasi-static\" or \"dynamic\"\n";
  text += described_list(Generators{}, "mesh", "generator");
  text +=
      "\nmesh.file = \"FILE\": instead of a generator, a mesh of hexahedra, in m: .h5 as `sandglass mesh` "
      "writes it, .msh of\n  Gmsh (2.2, 4.1), .inp of Abaqus or CalculiX (C3D8...), .vtu. Its physical "
      "groups, its NSETs and ELSETs, its point\n  arrays of 0 and 1 are node sets by their names; rules of "
      "[sets] add others, and replace those of the same name\n";
  text += described_list(Laws{}, "material", "law");
  text += fmt::format("  {:<28} {:<6} {:<12} {:<16} {}\n", "material.density", "[kg/m^3]",
                      Range::positive().text(), "required", "mass density at rest");
  text +=
      "\n[sets] NAME = { surface = true, x = [low, high], y = ..., z = ..., cylinder = { axis = \"z\", "
      "center = [x, y], "
      "semi_axes = [a, b] } }\n  all conditions must hold; lengths in m; inf and -inf are allowed\n"
      "\n[[displacement]] set = NAME, value = [x, y, z] in m, components = \"xyz\" (default: all)\n"
      "[[rotation]] set = NAME, axis = \"x\", \"y\", \"z\" or [x, y, z], angle in degrees, by the right-hand "
      "rule:\n  the set turns rigidly, all components imposed; center = [x, y, z] in m, a point of the axis "
      "(default: the mean of\n  the set's nodes), displacement = [x, y, z] in m, added (default: none)\n"
      "[[force]] set = NAME, total = [x, y, z] in N, moment = [x, y, z] in N m about the middle of the "
      "faces:\n"
      "  a dead load on the boundary faces within the set\n"
      "[[published]] set = NAME, component = \"x\", ... or \"around-x\", ..., value in m or rad: mean "
      "displacement "
      "or rotation of the set,\n  source: a text\n"
      "[[velocity]] set = NAME (default: the whole body), value = [x, y, z] in m/s, spin = [x, y, z] in "
      "rad/s about the\n  set's centre of mass, half_waves = [x, y, z]: value as a wave that stands in the "
      "set,\n  value * cos(pi half_waves (x - low) / (high - low)); where a dynamic answer starts, several "
      "add "
      "up\n"
      "[profile] set = NAME, order = \"x\" | \"y\" | \"z\" | \"around-x\" | \"around-y\" | \"around-z\"\n"
      "[method] name, kappa (number or \"auto\"), kappa_modulus (\"p-wave\" or \"shear\"), accuracy\n"
      "  (of an adaptive method), precision (\"double\" or \"float\"): what `sandglass run` takes unless its "
      "options\n  say otherwise; `sandglass choose` writes it\n"
      "[comparison] kappas = [numbers], golden = \"FILE.h5\", truth = \"FILE.h5\"\n"
      "[[expect]] method, kappa (number, \"auto\" or \"best\"), reference (\"golden\", \"truth\" or "
      "\"published\"),\n  figure, below or above, reason\n"
      "[[variants.AXIS]] name, and any of these keys: every combination of one variant of each axis is a "
      "case\n";
  text +=
      "\n[relaxation]: how a quasi-static answer is found\n" + described<RelaxationSettings>("relaxation");
  text += "\n[dynamics]: how a dynamic answer is found\n" + described<DynamicsSettings>("dynamics");
  return text;
}

}  // namespace sandglass
