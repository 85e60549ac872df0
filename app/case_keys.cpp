#include "app/case_keys.hpp"

#include <fmt/format.h>

#include "mesh/generators.hpp"
#include "problem/case.hpp"

namespace sandglass {

namespace {

/// A key and its description, in columns.
std::string key_line(const std::string& key, std::string_view unit, const std::string& allowed,
                     const std::string& fallback, std::string_view meaning) {
  return fmt::format("  {:<28} {:<8} {:<12} {:<16} {}\n", key, fmt::format("[{}]", unit), allowed, fallback,
                     meaning);
}

/// Lines about the parameters of one aggregate, for people.
template <class Aggregate>
std::string described(const std::string& table) {
  const Aggregate defaults{};
  std::string text;
  std::apply(
      [&](const auto&... p) {
        const auto line = [&]<class Value>(const Parameter<Aggregate, Value>& parameter) {
          const Value& standard = defaults.*(parameter.member);
          if constexpr (requires { Value::parameters(); }) {
            text += described<Value>(table);
          } else {
            std::string fallback = parameter.required ? "required" : "optional",
                        allowed = parameter.range.text();
            if constexpr (std::is_arithmetic_v<Value>) {
              if (!parameter.required) fallback = fmt::format("default {}", standard);
            }
            if constexpr (std::is_enum_v<Value>) {
              allowed = fmt::to_string(fmt::join(words_of(standard), ", "));
              fallback = fmt::format("default {}", words_of(standard)[static_cast<std::size_t>(standard)]);
            } else if constexpr (std::is_same_v<Value, bool>) {
              allowed = "true, false";
            } else if constexpr (std::is_same_v<Value, std::string> || std::is_same_v<Value, Formula>) {
              allowed = "a text";
            }
            text += key_line(fmt::format("{}.{}", table, parameter.name), parameter.unit, allowed, fallback,
                             parameter.meaning);
          }
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

constexpr std::string_view before_generators =
    R"(Keys of a case file (TOML). Tables and their parameters: name, unit, range, default, meaning.

[case] name, requirement: texts; answer: "quasi-static" or "dynamic"
)";

constexpr std::string_view mesh_file = R"(
mesh.file = "FILE": instead of a generator, a mesh of hexahedra, in m: .h5 as `sandglass mesh` writes it,
  .msh of Gmsh (2.2, 4.1), .inp of Abaqus or CalculiX (C3D8...), .vtu. Its physical groups, its NSETs and
  ELSETs, its point arrays of 0 and 1 are node sets by their names; rules of [sets] add others, and replace
  those of the same name. Or a labelled image, .npy with mesh.spacing = [x, y, z], the size of a voxel in m, or
  .nii of NIfTI: an element for each voxel that is not 0, the element set label-N for each label N
)";

constexpr std::string_view parts_of_a_material = R"(
material.volumetric: the volumetric energy, where K is the initial bulk modulus: "quadratic", K/2 (J - 1)^2
  (default), "logarithmic", K/2 (ln J)^2, or "quadratic-logarithmic", K/4 (J^2 - 1 - 2 ln J)
material.fibre_direction, sheet_direction = [x, y, z], of any length: for laws with fibres, the same directions
  everywhere; the second may be left out for laws without sheets. Or
material.fibres = { axis = "x", "y" or "z", center = [x, y, z] in m (default: the origin), radii = [r0, r1] in m,
  angles = [a0, a1] in degrees }: fibres that wind around an axis, at an angle to the circle that is linear
  between two radii; sheets are radial. Or
material.fibres = { file = "FILE" }: a line for each element, with three numbers for its fibres, or six for
  its fibres and sheets
)";

constexpr std::string_view several_materials = R"(
[[materials]] instead of [material], several times, with the same keys and elements = NAME, an element set; one
  of them may leave it out and is the material of all other elements
[element_sets] NAME = { x = [low, high], y = ..., z = ..., cylinder = ... }: elements by their centres, with
  the conditions of [sets]; a mesh from a file brings its physical volumes, ELSETs or cell arrays by their names
)";

constexpr std::string_view sets_and_motions = R"(
[sets] NAME = { surface = true, x = [low, high], y = ..., z = ..., cylinder = { axis = "z",
  center = [x, y], semi_axes = [a, b] }, ellipsoid = { center = [x, y, z], semi_axes = [a, b, c] } }
  all conditions must hold, within the rounding of files (5e-6 of the largest coordinate, at most a thousandth
  of the shortest edge); lengths in m; inf and -inf are allowed

[[displacement]] set = NAME, value = [x, y, z] in m, components = "xyz" (default: all)
[[rotation]] set = NAME, axis = "x", "y", "z" or [x, y, z], angle in degrees, by the right-hand rule:
  the set turns rigidly, all components imposed; center = [x, y, z] in m, a point of the axis
  (default: the mean of the set's nodes), displacement = [x, y, z] in m, added (default: none)
[method] name, kappa (number or "auto"), kappa_modulus ("p-wave" or "shear"), accuracy
  (of an adaptive method), precision ("double" or "float"): used by `sandglass run` unless its options
  differ; `sandglass choose` writes it
[[variants.AXIS]] name, and any of these keys: every combination of one variant of each axis is a case
)";

}  // namespace

std::string describe_case_keys() {
  std::string text(before_generators);
  text += described_list(Generators{}, "mesh", "generator");
  text += mesh_file;
  text += described_list(Laws{}, "material", "law");
  text +=
      key_line("material.density", "kg/m^3", Range::positive().text(), "required", "undeformed mass density");
  text += parts_of_a_material;
  text += several_materials;
  text += sets_and_motions;
  const auto add_table = [&]<class Table>() {
    text += fmt::format("\n[[{}]]: {}\n{}", Table::name, Table::summary,
                        described<Table>(std::string(Table::name)));
  };
  for_each_type(TypeList<Refinement, NodeTie, InitialVelocity>{}, add_table);
  for_each_type(Forces{}, add_table);
  text += fmt::format("\nformula: {}\n", formula_language());
  text += "\n[relaxation]: settings of the quasi-static solver\n";
  text += described<RelaxationSettings>("relaxation");
  text += "\n[dynamics]: settings of the dynamic solver\n";
  text += described<DynamicsSettings>("dynamics");
  return text;
}

}  // namespace sandglass
