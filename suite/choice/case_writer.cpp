#include "choice/case_writer.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "assembly/method_entry.hpp"
#include "choice/variations.hpp"
#include "comparison/comparison.hpp"
#include "io/case_variants.hpp"
#include "io/toml_text.hpp"

namespace sandglass {

namespace {

namespace fs = std::filesystem;

/// A path relative to a folder, for a file in it, so that both may be moved together.
std::string path_from(const fs::path& folder, const fs::path& path) {
  const fs::path to = fs::weakly_canonical(fs::absolute(path));
  return to.lexically_proximate(fs::weakly_canonical(folder)).generic_string();
}

toml::table& table_of(toml::table& root, std::string_view key) {
  return *root.insert(key, toml::table{}).first->second.as_table();
}

toml::table method_table(const MethodChoice& choice) {
  toml::table method{{"name", choice.method}, {"precision", std::string(name_of(choice.precision))}};
  if (method_named(choice.method).adapts()) method.insert("accuracy", choice.accuracy);
  if (!method_named(choice.method).takes_kappa) return method;
  if (choice.kappa) {
    method.insert("kappa", *choice.kappa);
  } else {
    method.insert("kappa", "auto");
  }
  method.insert("kappa_modulus", choice.kappa_modulus == KappaModulus::shear ? "shear" : "p-wave");
  return method;
}

/// Numbers and texts are changed in place, so that they keep their position in the file.
void set_counts(toml::table& mesh, const AnyGenerator& generator) {
  for (const auto& [parameter, counts] : element_counts(generator)) {
    toml::node& node = *mesh.get(parameter);
    for (std::size_t i = 0; i < counts.size(); ++i) {
      toml::node& count = node.is_array() ? node.as_array()->at(i) : node;
      *count.as_integer() = counts[i];
    }
  }
}

void set_text(toml::table& table, std::string_view key, const std::string& text) {
  *table.get(key)->as_string() = text;
}

/// References are not moved; from another folder they have another path.
void set_references(toml::table& root, const Case& description, const fs::path& folder) {
  const Comparison comparison = read_comparison(description);
  for (const auto& [key, path] : {std::pair{"golden", comparison.golden}, {"truth", comparison.truth}}) {
    std::error_code ignored;
    if (!fs::exists(path, ignored)) continue;
    table_of(root, "comparison").insert_or_assign(key, path_from(folder, path));
  }
}

/// Keeps only the sets of a case.
void keep_sets(toml::table& sets, const Case& description) {
  const toml::table all = sets;
  for (const auto& [key, node] : all) {
    const auto is = [&, name = std::string_view(key.str())](const NodeSetRule& rule) {
      return rule.name == name;
    };
    if (std::none_of(description.sets.begin(), description.sets.end(), is)) sets.erase(key.str());
  }
}

/// The element numbers that the other case splits in addition to the case.
void add_refinements(toml::table& root, const Case& description, const Case& other) {
  toml::array& rules = *root.insert("refine", toml::array{}).first->second.as_array();
  for (std::size_t n = description.refinements.size(); n < other.refinements.size(); ++n) {
    toml::array numbers;
    for (const int e : other.refinements[n].numbers) numbers.push_back(e);
    rules.push_back(toml::table{{"numbers", std::move(numbers)}, {"after", other.refinements[n].after}});
  }
  if (rules.empty()) root.erase("refine");
}

/// The steps and moduli of the other case, changed in place.
void set_longer_steps(toml::table& root, const Case& description, const Case& other) {
  if (other.dynamics.body_frequency != description.dynamics.body_frequency)
    table_of(root, "dynamics").insert_or_assign("body_frequency", other.dynamics.body_frequency);
  for (std::size_t n = 0; n < other.materials.size(); ++n) {
    toml::table* const several = root["materials"][n].as_table();
    toml::table& material = several != nullptr ? *several : table_of(root, "material");
    std::visit(
        [&]<class Law>(const Law& law) {
          const Law& softer = std::get<Law>(other.materials[n].law);
          const auto set = [&](const auto& key) {
            if (softer.*key.member != law.*key.member)
              material.insert_or_assign(key.name, softer.*key.member);
          };
          std::apply([&](const auto&... key) { (set(key), ...); }, Law::parameters());
        },
        description.materials[n].law);
  }
}

/// Tables of the case about answers on its own mesh and with its own materials.
void forget_answers(toml::table& root, const Case& description) {
  set_text(table_of(root, "case"), "name", description.name + "-chosen");
  root.erase("expect");
  root.erase("published");
  root.erase("measured");
  root.erase("comparison");
  root.erase("profile");
}

}  // namespace

std::string case_text(const Case& description, const MethodChoice& choice, const Case& chosen,
                      const fs::path& place) {
  toml::table root = read_case_tables(description.file, description.variants).root;
  const fs::path folder = fs::absolute(place).parent_path();
  set_text(table_of(root, "case"), "name", description.name);
  if (const auto* file = std::get_if<MeshFile>(&description.mesh)) {
    set_text(table_of(root, "mesh"), "file", path_from(folder, file->path));
  }
  set_longer_steps(root, description, chosen);
  if (case_hash(chosen) != case_hash(description)) {
    if (const auto* generator = std::get_if<AnyGenerator>(&chosen.mesh))
      set_counts(table_of(root, "mesh"), *generator);
    add_refinements(root, description, chosen);
    forget_answers(root, description);
    keep_sets(table_of(root, "sets"), chosen);
  } else {
    set_references(root, description, folder);
  }
  root.insert_or_assign("method", method_table(choice));
  return fmt::format(
      "# Written by `sandglass choose` from {}; its comments are not kept here.\n"
      "# `sandglass run` uses [method] for this case.\n{}",
      description.file.filename().string(), toml_text(root));
}

}  // namespace sandglass
