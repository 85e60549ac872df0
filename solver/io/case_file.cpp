#include "io/case_file.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "io/case_materials.hpp"
#include "io/case_mesh.hpp"
#include "io/case_variants.hpp"
#include "io/foreign_file.hpp"
#include "io/mesh_file.hpp"
#include "io/table_reader.hpp"
#include "mesh/interpolation.hpp"

namespace sandglass {

namespace {

void read_mesh(TableReader& reader, Case& description) {
  TableReader table = reader.required_table("mesh");
  description.mesh = read_mesh_source(table, description.file.parent_path());
}

CylinderRegion read_cylinder(TableReader table) {
  CylinderRegion region;
  region.axis = table.required_choice("axis", {"x", "y", "z"})[0] - 'x';
  region.center = table.required<std::array<double, 2>>("center");
  region.semi_axes = table.required<std::array<double, 2>>("semi_axes", Range::positive());
  table.finish();
  return region;
}

EllipsoidRegion read_ellipsoid(TableReader table) {
  EllipsoidRegion region;
  region.center = table.optional<Vector>("center").value_or(Vector{});
  region.semi_axes = table.required<Vector>("semi_axes", Range::positive());
  table.finish();
  return region;
}

NodeSetRule read_set(TableReader table, const std::string& name, bool of_nodes) {
  NodeSetRule rule;
  rule.name = name;
  if (of_nodes) rule.surface = table.optional<bool>("surface").value_or(false);
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
  if (auto ellipsoid = table.table("ellipsoid")) rule.ellipsoid = read_ellipsoid(*ellipsoid);
  table.finish();
  return rule;
}

ImposedDisplacement read_displacement(TableReader table) {
  ImposedDisplacement imposed;
  imposed.set = table.required<std::string>("set");
  imposed.value = table.required<Vector>("value", Range::any());
  if (const auto components = table.optional<std::string>("components")) {
    imposed.components = {};
    for (const char c : *components) {
      if (c < 'x' || c > 'z' || std::exchange(imposed.components[static_cast<std::size_t>(c - 'x')], true))
        table.fail("components", fmt::format("= '{}' must consist of x, y, z, each once", *components));
    }
    if (components->empty()) table.fail("components", "= '' must name at least one of x, y, z");
    for (std::size_t i = 0; i < 3; ++i) {
      if (imposed.components[i] || imposed.value[i] == 0.0) continue;
      table.fail("value",
                 fmt::format("has {:g} m along {}, which components = '{}' does not impose; allowed: "
                             "0, or to impose it too",
                             imposed.value[i], "xyz"[i], *components));
    }
  }
  table.finish();
  return imposed;
}

/// The unit vector of an axis given as a letter or as a vector of any length but zero.
Vector read_axis(TableReader& table) {
  Vector axis{};
  if (table.holds_text("axis")) {
    axis[static_cast<std::size_t>(table.required_choice("axis", {"x", "y", "z"})[0] - 'x')] = 1.0;
    return axis;
  }
  axis = table.required<Vector>("axis", Range::any());
  const double length = std::hypot(axis[0], axis[1], axis[2]);
  if (length == 0.0) table.fail("axis", "= [0, 0, 0] must not be zero: it is a direction");
  for (double& a : axis) a /= length;
  return axis;
}

ImposedRotation read_rotation(TableReader table) {
  ImposedRotation turned;
  turned.set = table.required<std::string>("set");
  turned.axis = read_axis(table);
  turned.angle = table.required<double>("angle", Range::any()) / 180.0 * std::numbers::pi;
  turned.center = table.optional<Vector>("center", Range::any());
  turned.displacement = table.optional<Vector>("displacement", Range::any()).value_or(Vector{});
  table.finish();
  return turned;
}

/// The hourglass parameter of a method: a number, or none for "auto".
std::optional<double> read_strength(TableReader& table, const std::string& method) {
  if (!table.holds_number("kappa")) {
    if (table.optional<std::string>("kappa")) table.required_choice("kappa", {"auto"});
    return std::nullopt;
  }
  const auto kappa = table.required<double>("kappa", Range::at_least(0.0));
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
  if (const auto accuracy = table.optional<double>("accuracy", Range::positive())) {
    if (!method_named(choice.method).adapts())
      table.fail("accuracy", "applies only to adaptive methods; leave it out");
    choice.accuracy = *accuracy;
  }
  table.finish();
  return choice;
}

void read_header(TableReader table, Case& description) {
  description.family = table.required<std::string>("name");
  description.name = description.family;
  for (const auto& variant : description.variants) description.name += "-" + variant;
  description.requirement = table.required<std::string>("requirement");
  description.quasi_static = table.required_choice("answer", {"quasi-static", "dynamic"}) == "quasi-static";
  table.finish();
}

/// The files from which a case was read.
std::vector<std::filesystem::path> files_of(const Case& description) {
  std::vector<std::filesystem::path> files{description.file};
  if (const auto* mesh = std::get_if<MeshFile>(&description.mesh)) files.push_back(mesh->path);
  for (const CaseMaterial& material : description.materials) {
    if (const auto* listed = std::get_if<ListedFibres>(&material.fibres)) files.push_back(listed->file);
  }
  for (const Obstacle& obstacle : description.forces.of<Obstacle>())
    if (!obstacle.file.empty()) files.push_back(description.file.parent_path() / obstacle.file);
  return files;
}

MeshWithSets read_mesh_of(const Case& description, const MeshFile& file) {
  try {
    if (is_foreign_mesh(file.path)) return read_foreign_mesh(file);
    if (file.spacing) throw InputError("mesh.spacing was given; it applies only to images");
    return read_mesh_file(file.path);
  } catch (const InputError& error) {
    const std::string ending = file.path.extension().string();
    const bool ours = is_foreign_mesh(file.path) || ending == ".h5" || ending == ".hdf5";
    throw InputError(fmt::format(
        "{}: mesh.file: {}{}", description.file.string(), error.what(),
        ours ? ""
             : "; a file that is not HDF5 must end in .msh (Gmsh), .inp (Abaqus), .vtu, .vtk, .npy or .nii"));
  }
}

/// Throws InputError for bodies that overlap, unless a [[tie]] joins bodies that do.
void require_bodies_apart(const Case& description, const Mesh& mesh) {
  if (!description.ties.empty()) return;
  std::vector<bool> on_boundary = nodes_of(boundary_faces(mesh.cells), mesh.points.size());
  std::vector<int> nodes;
  for (std::size_t n = 0; n < on_boundary.size(); ++n)
    if (on_boundary[n]) nodes.push_back(static_cast<int>(n));
  constexpr double well_within = 0.3;
  const auto found =
      overlaps(mesh.points, mesh.cells, points_within(mesh.points, mesh.cells, nodes, well_within));
  if (found.empty()) return;
  const Vector& X = found.front().first.from;
  throw InputError(fmt::format(
      "{}: mesh.bodies: the point ({:.6g}, {:.6g}, {:.6g}) m is in two bodies; allowed: bodies that do not "
      "intersect, or a [[tie]] that joins them",
      description.file.string(), X[0], X[1], X[2]));
}

/// `read_mesh(reader, case)` sets its mesh.
template <class ReadMesh>
Case read_case(const CaseTables& tables, const std::filesystem::path& path, const ReadMesh& read_mesh) {
  Case description;
  description.file = path;
  description.variants = tables.variants;
  TableReader reader(tables.root, path, "");
  read_header(reader.required_table("case"), description);
  read_mesh(reader, description);
  description.materials = read_materials(reader);
  const auto read_sets = [&](const std::string& key, bool of_nodes) {
    std::vector<NodeSetRule> rules;
    if (auto sets = reader.table(key)) {
      for (const auto& name : sets->keys())
        rules.push_back(read_set(sets->required_table(name), name, of_nodes));
    }
    return rules;
  };
  description.sets = read_sets("sets", true);
  description.element_sets = read_sets("element_sets", false);
  const auto read_tables = [&]<class Table>(std::vector<Table>& found) {
    for (TableReader& table : reader.tables(std::string(Table::name))) {
      table.parameters(found.emplace_back());
      table.finish();
    }
  };
  read_tables(description.refinements);
  read_tables(description.ties);
  for (const auto& table : reader.tables("displacement"))
    description.displacements.push_back(read_displacement(table));
  for (const auto& table : reader.tables("rotation")) description.rotations.push_back(read_rotation(table));
  for_each_type(Forces{}, [&]<class Force>() { read_tables(description.forces.of<Force>()); });
  if (auto relaxation = reader.table("relaxation")) {
    relaxation->parameters(description.relaxation);
    relaxation->finish();
  }
  if (!description.quasi_static) {
    read_tables(description.velocities);
    auto dynamics = reader.required_table("dynamics");
    dynamics.parameters(description.dynamics);
    dynamics.finish();
  } else {
    for (const std::string& key : reader.keys()) {
      if (key == "dynamics" || key == InitialVelocity::name)
        reader.fail(key, "is for motions; allowed: a case with answer = 'dynamic'");
    }
  }
  if (auto method = reader.table("method")) description.method = read_method(*method);
  for (const auto& name : tables_not_read) reader.leave(name);
  reader.finish();
  description.files = files_of(description);
  return description;
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

CaseOnMesh with_mesh(Case description) {
  if (const auto* file = std::get_if<MeshFile>(&description.mesh)) {
    auto [mesh, sets, element_sets] = read_mesh_of(description, *file);
    return {std::move(description), std::move(mesh), std::move(sets), std::move(element_sets)};
  }
  if (const auto* bodies = std::get_if<std::vector<PlacedBody>>(&description.mesh)) {
    auto [mesh, sets, element_sets] = build(*bodies);
    require_bodies_apart(description, mesh);
    return {std::move(description), std::move(mesh), std::move(sets), std::move(element_sets)};
  }
  Mesh mesh = generate_mesh(std::get<AnyGenerator>(description.mesh));
  return {std::move(description), std::move(mesh)};
}

CaseOnMesh with_mesh(const std::string& text, MeshWithSets mesh) {
  const std::string name = "case text";
  const auto in_memory = [&](TableReader& /*reader*/, Case& description) {
    description.mesh = MeshFile{"in memory"};
  };
  return {read_case(parse_case_text(text, name), name, in_memory), std::move(mesh.mesh), std::move(mesh.sets),
          std::move(mesh.element_sets)};
}

Scene read_scene(Case description) {
  return make_scene(with_mesh(std::move(description)));
}

Scene read_scene(const std::string& text, MeshWithSets mesh) {
  return make_scene(with_mesh(text, std::move(mesh)));
}

Scene read_scene(const std::filesystem::path& path) {
  return read_scene(read_case_file(path));
}

MethodChoice method_of(const CaseSettings& settings, const std::optional<std::string>& named) {
  MethodChoice choice = settings.method.value_or(MethodChoice{.method = "tl-perturbation"});
  if (named && *named != choice.method) choice = {.method = *named, .precision = choice.precision};
  return choice;
}

}  // namespace sandglass
