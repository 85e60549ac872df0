#include "app/case_keys.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "forces/formula.hpp"
#include "sandglass/case_tables.hpp"

namespace sandglass {

namespace {

/// A key and its description, in columns; many allowed words follow the meaning.
std::string key_line(const std::string& table, const CaseKey& key) {
  constexpr std::size_t most = 28;
  const bool many = key.allowed.size() > most;
  const std::string fallback = key.required           ? "required"
                               : key.standard.empty() ? "optional"
                                                      : "default " + key.standard;
  return fmt::format("  {:<28} {:<8} {:<12} {:<16} {}{}\n", fmt::format("{}.{}", table, key.name),
                     fmt::format("[{}]", key.unit),
                     many || key.allowed.empty() ? "a " + key.type : key.allowed, fallback, key.meaning,
                     many ? ": " + key.allowed : "");
}

constexpr std::string_view head =
    R"(Keys of a case file (TOML). Tables and their parameters: name, unit, range, default, meaning.

[case] name, requirement: texts; answer: "quasi-static" or "dynamic"
)";

constexpr std::string_view mesh_file = R"(
mesh.file = "FILE": instead of a generator, a mesh of hexahedra, in m: .h5 as `sandglass mesh` writes it,
  .msh of Gmsh (2.2, 4.1), .inp of Abaqus or CalculiX (C3D8...), .vtu or .vtk. Its physical groups, its NSETs and
  ELSETs, its point arrays of 0 and 1 are node sets by their names; rules of [sets] add others, and replace
  sets of the same name. Or a labelled image, .npy with mesh.spacing = [x, y, z], the size of a voxel in m, or
  .nii of NIfTI: an element for each voxel that is not 0, the element set label-N for each label N
)";

constexpr std::string_view bodies = R"(
[[mesh.bodies]], several times: bodies of one mesh, each with a generator and its keys, and with name, which also
  names the sets of its nodes and elements; turn = [x, y, z] in degrees (default: none), a rotation about the origin
  whose direction is its axis; and offset = [x, y, z] in m (default: none), a displacement after the rotation
)";

constexpr std::string_view materials = R"(
material.fibres = { axis = "x", "y" or "z", center = [x, y, z] in m (default: the origin), radii = [r0, r1] in m,
  angles = [a0, a1] in degrees }: fibres at an angle to the circle; the angle is linear between two radii, and
  sheets are radial. Or { file = "FILE" }: a line for each element, with three numbers for its fibres, or six for its
  fibres and sheets
[[materials]] instead of [material], several times, with the same keys and elements = NAME, an element set; one
  of them may leave it out and is the material of all other elements
[element_sets] NAME = { x = [low, high], y = ..., z = ..., cylinder = ... }: elements by their centres, with
  the conditions of [sets]; a mesh from a file brings its physical volumes, ELSETs or cell arrays by their names
[sets] NAME = { surface = true, x = [low, high], y = ..., z = ..., cylinder = { axis = "z",
  center = [x, y], semi_axes = [a, b] }, ellipsoid = { center = [x, y, z], semi_axes = [a, b, c] } }
  all conditions must hold, within the rounding of files (5e-6 of the largest coordinate, at most a thousandth
  of the shortest edge); lengths in m; inf and -inf are allowed
[[variants.AXIS]] name, and any of these keys: every combination of one variant of each axis is a case
)";

}  // namespace

std::string describe_case_keys() {
  std::string text(head);
  const std::vector<CaseTable> tables = case_tables();
  for (auto first = tables.begin(), last = first; first != tables.end(); first = last) {
    // The choices of a table: the keys that all of them have follow them.
    last = std::find_if(first, tables.end(), [&](const auto& other) { return other.table != first->table; });
    const auto shared = [&](const CaseKey& key) {
      return std::all_of(first, last, [&](const CaseTable& table) {
        return std::ranges::count(table.keys, key.name, &CaseKey::name) > 0;
      });
    };
    for (auto table = first; table != last && !table->choice.empty(); ++table) {
      text += fmt::format("\n{}.{} = \"{}\": {}\n", table->table, table->choice_key, table->choice,
                          table->summary);
      for (const CaseKey& key : table->keys)
        if (!shared(key)) text += key_line(table->table, key);
    }
    std::string keys;
    for (const CaseKey& key : first->keys)
      if (shared(key)) keys += key_line(first->table, key);
    if (first->choice.empty()) {
      text += fmt::format(fmt::runtime(first->several ? "\n[[{}]]: {}\n" : "\n[{}]: {}\n"), first->table,
                          first->summary);
    } else if (!keys.empty()) {
      text += fmt::format("\n[{}], with any {}\n", first->table, first->choice_key);
    }
    text += keys;
    if (first->table == "mesh") text.append(mesh_file).append(bodies);
    if (first->table == "material") text += materials;
  }
  return text + fmt::format("\nformula: {}\n", formula_language());
}

}  // namespace sandglass
