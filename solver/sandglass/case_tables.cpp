#include "sandglass/case_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "assembly/method_entry.hpp"
#include "io/case_file.hpp"
#include "io/case_mesh.hpp"
#include "io/case_variants.hpp"
#include "io/table_reader.hpp"

namespace sandglass {

namespace {

template <class Value>
CaseKey typed(const Value& standard) {
  if constexpr (std::is_enum_v<Value>) {
    const auto words = words_of(standard);
    return {.type = "word",
            .allowed = fmt::to_string(fmt::join(words, ", ")),
            .standard = std::string(words[static_cast<std::size_t>(standard)])};
  } else if constexpr (std::is_same_v<Value, bool>) {
    return {.type = "flag", .allowed = "true, false", .standard = standard ? "true" : "false"};
  } else if constexpr (std::is_same_v<Value, std::string> || std::is_same_v<Value, Formula>) {
    return {.type = "text"};
  } else if constexpr (std::is_arithmetic_v<Value>) {
    return {.type = std::is_integral_v<Value> ? "integer" : "number", .standard = fmt::to_string(standard)};
  } else if constexpr (requires { Value::value_type::parameters(); }) {
    return {.type = "table", .count = 0};
  } else {
    CaseKey key = typed(typename Value::value_type{});
    key.standard = "";
    key.count = 0;
    if constexpr (requires { std::tuple_size<Value>::value; }) key.count = std::tuple_size_v<Value>;
    return key;
  }
}

/// The declared parameters of an aggregate; those of a parameter that is itself an aggregate are among them.
template <class Aggregate>
std::vector<CaseKey> declared() {
  const Aggregate defaults{};
  std::vector<CaseKey> keys;
  const auto add = [&]<class Value>(const Parameter<Aggregate, Value>& parameter) {
    if constexpr (requires { Value::parameters(); }) {
      std::vector<CaseKey> own = declared<Value>();
      own.front().meaning += fmt::format("; {}", parameter.meaning);
      std::ranges::move(own, std::back_inserter(keys));
    } else {
      CaseKey key = typed(defaults.*(parameter.member));
      key.name = parameter.name;
      key.unit = parameter.unit;
      key.required = parameter.required;
      key.meaning = parameter.meaning;
      if (key.type == "number" || key.type == "integer") key.allowed = parameter.range.text();
      if (parameter.required) key.standard = "";
      keys.push_back(std::move(key));
    }
  };
  std::apply([&](const auto&... parameters) { (add(parameters), ...); }, Aggregate::parameters());
  return keys;
}

// The keys that the reader of cases reads one by one.

CaseKey text_key(const char* name, bool required, const char* meaning) {
  return {.name = name, .type = "text", .unit = "-", .required = required, .meaning = meaning};
}

CaseKey number_key(const char* name, int count, const char* unit, bool required, const char* meaning) {
  return {.name = name,
          .type = "number",
          .count = count,
          .unit = unit,
          .allowed = Range::any().text(),
          .required = required,
          .meaning = meaning};
}

CaseKey word_key(const char* name, bool required, const std::vector<std::string>& words,
                 const char* meaning) {
  return {.name = name,
          .type = "word",
          .unit = "-",
          .allowed = fmt::to_string(fmt::join(words, ", ")),
          .required = required,
          .meaning = meaning};
}

std::vector<CaseKey> keys_of_materials(const AnyLaw& law) {
  std::vector<CaseKey> keys{{.name = "density",
                             .type = "number",
                             .unit = "kg/m^3",
                             .allowed = Range::positive().text(),
                             .meaning = "undeformed mass density"}};
  if (splits_volume(law))
    keys.push_back(word_key("volumetric", false, names_of(VolumetricParts{}),
                            "the volumetric energy, where K is the initial bulk modulus: K/2 (J - 1)^2, the "
                            "default, K/2 (ln J)^2, or K/4 (J^2 - 1 - 2 ln J)"));
  if (has_fibres(law)) {
    keys.push_back(
        number_key("fibre_direction", 3, "-", false, "direction of the fibres everywhere, of any length"));
    keys.push_back(
        number_key("sheet_direction", 3, "-", false, "the same of the sheets, for laws with sheets"));
    keys.push_back({.name = "fibres",
                    .type = "table",
                    .unit = "-",
                    .required = false,
                    .meaning = "fibres that wind around an axis: axis, center, radii, angles; or file"});
  }
  keys.push_back(
      text_key("elements", false, "an element set, with several materials; without it, all other elements"));
  return keys;
}

CaseTable displacement_table() {
  return {.table = "displacement",
          .several = true,
          .summary = "a displacement imposed on a node set",
          .keys = {text_key("set", true, "a node set"), number_key("value", 3, "m", true, "its displacement"),
                   text_key("components", false, "the imposed components, such as \"xy\"; default: all")}};
}

CaseTable rotation_table() {
  CaseKey axis = word_key("axis", true, {"x", "y", "z"}, "axis of the rotation, or its direction [x, y, z]");
  return {
      .table = "rotation",
      .several = true,
      .summary = "a rigid rotation imposed on a node set, by the right-hand rule",
      .keys = {text_key("set", true, "a node set"), axis, number_key("angle", 1, "deg", true, "its angle"),
               number_key("center", 3, "m", false, "a point of the axis; default: the mean of the nodes"),
               number_key("displacement", 3, "m", false, "added to the rotation; default: none")}};
}

CaseTable method_table() {
  CaseKey kappa = number_key("kappa", 1, "-", false, "strength of the hourglass control, or \"auto\"");
  kappa.allowed = Range::at_least(0.0).text();
  CaseKey accuracy = number_key("accuracy", 1, "-", false, "target of an adaptive method");
  accuracy.allowed = Range::positive().text();
  return {
      .table = "method",
      .summary =
          "how `sandglass run` computes the answer unless its options differ; `sandglass choose` writes it",
      .keys = {word_key("name", true, method_names(), "a method"), kappa,
               word_key("kappa_modulus", false, {"p-wave", "shear"}, "the modulus that kappa multiplies"),
               accuracy, word_key("precision", false, {"double", "float"}, "the numbers to compute in")}};
}

}  // namespace

std::vector<CaseTable> case_tables() {
  std::vector<CaseTable> tables;
  for_each_type(Generators{}, [&]<class Generator>() {
    tables.push_back({.table = "mesh",
                      .choice_key = "generator",
                      .choice = std::string(Generator::name),
                      .summary = std::string(Generator::summary),
                      .keys = declared<Generator>()});
  });
  for_each_type(Laws{}, [&]<class Law>() {
    std::vector<CaseKey> keys = declared<Law>();
    for (CaseKey& key : keys_of_materials(Law{})) keys.push_back(std::move(key));
    tables.push_back({.table = "material",
                      .choice_key = "law",
                      .choice = std::string(Law::name),
                      .summary = std::string(Law::summary),
                      .keys = std::move(keys)});
  });
  tables.push_back(displacement_table());
  tables.push_back(rotation_table());
  const auto add = [&]<class Table>() {
    tables.push_back({.table = std::string(Table::name),
                      .several = true,
                      .summary = std::string(Table::summary),
                      .keys = declared<Table>()});
  };
  for_each_type(Forces{}, add);
  for_each_type(TypeList<Refinement, NodeTie, InitialVelocity>{}, add);
  tables.push_back({.table = "relaxation",
                    .summary = "settings of the quasi-static solver",
                    .keys = declared<RelaxationSettings>()});
  tables.push_back({.table = "dynamics",
                    .summary = "settings of the dynamic solver",
                    .keys = declared<DynamicsSettings>()});
  tables.push_back(method_table());
  return tables;
}

MeshWithSets mesh_of_keys(const std::string& keys) {
  const CaseTables tables = parse_case_text(keys, "mesh");
  TableReader table(tables.root, "mesh", "mesh");
  Case description;
  description.file = "mesh";
  description.mesh = read_mesh_source(table, {});
  CaseOnMesh found = with_mesh(std::move(description));
  return {std::move(found.mesh), std::move(found.sets), std::move(found.element_sets)};
}

}  // namespace sandglass
