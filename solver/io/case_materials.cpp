#include "io/case_materials.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <numbers>
#include <sstream>

#include "base/error.hpp"

namespace sandglass {

namespace {

/// Rows of three or six numbers, separated by spaces or commas: the fibres of the elements, and the sheets.
ListedFibres read_fibre_file(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw InputError(fmt::format("{}: cannot be read", path.string()));
  ListedFibres listed{.fibres = {}, .sheets = {}, .file = path};
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos || line.front() == '#') continue;
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    const std::vector<double> row{std::istream_iterator<double>(words), {}};
    const bool fits = row.size() == 3 || row.size() == 6;
    const bool as_before = listed.fibres.empty() || listed.sheets.empty() == (row.size() == 3);
    if (!fits || !words.eof() || !as_before) {
      throw InputError(
          fmt::format("{}:{}: '{}' must be three numbers, the direction of an element's fibres, or six, the "
                      "directions of its fibres and sheets, the same in all lines",
                      path.string(), number, line));
    }
    listed.fibres.push_back({row[0], row[1], row[2]});
    if (row.size() == 6) listed.sheets.push_back({row[3], row[4], row[5]});
  }
  return listed;
}

HelicalFibres read_helix(TableReader& table) {
  HelicalFibres helix;
  helix.axis = table.required_choice("axis", {"x", "y", "z"})[0] - 'x';
  helix.center = table.optional<Vector>("center", Range::any()).value_or(Vector{});
  helix.radii = table.required<std::array<double, 2>>("radii", Range::at_least(0.0));
  if (!(helix.radii[0] < helix.radii[1])) {
    table.fail("radii", fmt::format("= [{}, {}] must increase", helix.radii[0], helix.radii[1]));
  }
  helix.angles = table.required<std::array<double, 2>>(
      "angles", Range{.low = -90.0, .high = 90.0, .low_open = false, .high_open = false});
  for (double& angle : helix.angles) angle *= std::numbers::pi / 180.0;
  return helix;
}

/// The fibres of a law: fibre_direction and sheet_direction, or [material.fibres].
FibreRule read_fibres(TableReader& table, const AnyLaw& law) {
  const auto fibre = table.optional<Vector>("fibre_direction", Range::any());
  const auto sheet = table.optional<Vector>("sheet_direction", Range::any());
  auto field = table.table("fibres");
  const std::string key = field ? "fibres" : fibre ? "fibre_direction" : "sheet_direction";
  if (!has_fibres(law)) {
    if (fibre || sheet || field) {
      table.fail(key, fmt::format("was given, but law '{}' is isotropic; leave it out", name_of(law)));
    }
    return {};
  }
  if (fibre.has_value() == field.has_value() || (sheet && !fibre)) {
    table.fail("fibre_direction", fmt::format("or fibres must be given, but not both: law '{}' has fibres; "
                                              "sheet_direction goes with fibre_direction",
                                              name_of(law)));
  }
  if (fibre) {
    const UniformFibres uniform{*fibre, sheet};
    try {
      axes_along(uniform.fibre, uniform.sheet);
    } catch (const InputError& error) {
      table.fail(key, fmt::format("is not usable: {}", error.what()));
    }
    return uniform;
  }
  FibreRule rule;
  if (const auto file = field->optional<std::string>("file")) {
    try {
      rule = read_fibre_file(field->file().parent_path() / *file);
    } catch (const InputError& error) {
      field->fail("file", fmt::format("= '{}' is not usable: {}", *file, error.what()));
    }
  } else {
    rule = read_helix(*field);
  }
  field->finish();
  return rule;
}

/// The volumetric part of a material: its law's, unless the file names another.
VolumetricPart read_volume(TableReader& table, const AnyLaw& law) {
  if (!table.optional<std::string>("volumetric")) return {};
  const VolumetricPart volume = table.required_listed<VolumetricParts>("volumetric");
  if (!splits_volume(law) && !std::holds_alternative<QuadraticPart>(volume)) {
    table.fail("volumetric",
               fmt::format("must be left out: the energy of law '{}' has no separate volumetric "
                           "part",
                           name_of(law)));
  }
  return volume;
}

CaseMaterial read_material(TableReader table, bool one_of_several) {
  CaseMaterial material;
  material.law = table.required_listed<Laws>("law");
  material.volume = read_volume(table, material.law);
  material.fibres = read_fibres(table, material.law);
  material.density = table.required<double>("density", Range::positive());
  if (one_of_several) material.elements = table.optional<std::string>("elements").value_or("");
  table.finish();
  return material;
}

}  // namespace

std::vector<CaseMaterial> read_materials(TableReader& reader) {
  std::vector<CaseMaterial> materials;
  for (const auto& table : reader.tables("materials")) materials.push_back(read_material(table, true));
  if (materials.empty()) return {read_material(reader.required_table("material"), false)};
  if (reader.table("material")) {
    reader.fail("material", "and [[materials]] were given; a case has one or the other");
  }
  const auto others = std::count_if(materials.begin(), materials.end(),
                                    [](const CaseMaterial& material) { return material.elements.empty(); });
  if (others > 1) {
    reader.fail(
        "materials",
        fmt::format(
            "lack `elements` {} times; at most one material may, which is then used for all other elements",
            others));
  }
  return materials;
}

}  // namespace sandglass
