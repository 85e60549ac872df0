#include "io/case_variants.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "base/error.hpp"
#include "base/names.hpp"
#include "io/table_reader.hpp"

namespace sandglass {

namespace {

struct Axis {
  std::string key;
  std::vector<std::string> names;
  toml::source_position position;
};

/// A line of a text, from 1.
std::string line_of(const std::string& text, std::size_t number) {
  std::istringstream stream(text);
  std::string line;
  for (std::size_t n = 0; n < number && std::getline(stream, line); ++n) {
  }
  return line;
}

/// Whether the parser met the end of a line or of the file inside a string.
bool in_open_quote(std::string_view description) {
  return description.find(" string: ") != std::string_view::npos &&
         (description.find("control characters") != std::string_view::npos ||
          description.ends_with("end-of-file"));
}

/// A hint about a decimal comma in a line; empty if there is none.
std::string comma_hint(const std::string& line) {
  std::istringstream words(line);
  for (std::string word; words >> word;) {
    word.erase(0, word.find_last_of("[={") + 1);
    word.erase(word.find_last_not_of(",]}") + 1);
    if (auto hint = decimal_comma_hint(word); !hint.empty()) return hint;
  }
  return "";
}

/// The document of a text; messages call it `name`.
toml::table parse(const std::string& text, const std::string& name) {
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    std::size_t line = error.source().begin.line;
    std::string rule(error.description());
    if (in_open_quote(rule)) {
      if (rule.ends_with("end-of-file")) {  // the open quote is the last of three in a row
        const std::string before =
            text.substr(0, std::min(text.size(), std::max(text.rfind("\"\"\"") + 1, text.rfind("'''") + 1)));
        line = 1 + static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
      }
      rule = "a quote is open: the string has no end";
    } else {
      rule += comma_hint(line_of(text, line));
    }
    throw InputError(fmt::format("{}:{}: is not TOML: {}", name, line, rule));
  }
}

toml::table parse(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) {
    throw InputError(fmt::format("{}: no such case file", path.string()));
  }
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream) throw InputError(fmt::format("{}: cannot be read", path.string()));
  return parse(text.str(), path.string());
}

bool fits_a_file_name(const std::string& name) {
  constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-";
  return !name.empty() && name.find_first_not_of(letters) == std::string::npos;
}

std::vector<std::string> read_names(TableReader& variants, const std::string& key) {
  std::vector<std::string> names;
  for (auto& table : variants.tables(key)) {
    auto name = table.required<std::string>("name");
    if (!fits_a_file_name(name)) {
      table.fail("name", fmt::format("= '{}' must consist of letters, digits, '.', '_' and '-'", name));
    }
    if (std::find(names.begin(), names.end(), name) != names.end()) {
      table.fail("name", fmt::format("= '{}' appears twice; every variant needs its own name", name));
    }
    names.push_back(std::move(name));
  }
  return names;
}

std::vector<Axis> read_axes(const toml::table& root, const std::filesystem::path& path) {
  std::vector<Axis> axes;
  auto variants = TableReader(root, path, "").table("variants");
  if (!variants) return axes;
  for (const auto& key : variants->keys()) {
    auto names = read_names(*variants, key);
    axes.push_back({key, std::move(names), root["variants"][key][0].node()->source().begin});
  }
  std::sort(axes.begin(), axes.end(), [](const Axis& a, const Axis& b) { return a.position < b.position; });
  return axes;
}

/// Adds or replaces by moving, because copies lose their line numbers.
void merge(toml::table& into, toml::table&& from) {
  for (auto&& [key, node] : from) {
    const toml::key& name = key;  // clang up to 16 cannot capture structured bindings
    toml::table* const table = into[name.str()].as_table();
    if (table != nullptr && node.is_table()) {
      merge(*table, std::move(*node.as_table()));
    } else {
      node.visit([&](auto& value) { into.insert_or_assign(name, std::move(value)); });
    }
  }
}

/// The variant of an axis with a given name, moved out of the tables of a file.
toml::table take_variant(toml::table& variants, const std::string& axis, const std::string& name) {
  for (auto& entry : *variants[axis].as_array()) {
    toml::table& variant = *entry.as_table();
    if (variant["name"].value<std::string>() != name) continue;
    variant.erase("name");
    return std::move(variant);
  }
  return {};
}

}  // namespace

std::vector<CaseTables> read_case_tables(const std::filesystem::path& path) {
  std::vector<CaseTables> cases(1);  // filled by moving, because copies lose their line numbers
  cases[0].root = parse(path);
  const auto axes = read_axes(cases[0].root, path);
  if (axes.empty()) return cases;
  std::size_t combinations = 1;
  for (const auto& axis : axes) combinations *= axis.names.size();
  cases.clear();
  for (std::size_t number = 0; number < combinations; ++number) {
    cases.push_back({parse(path), {}});
    auto& [root, names] = cases.back();
    toml::table variants = std::move(*root["variants"].as_table());
    root.erase("variants");
    std::size_t each = combinations;  // number of combinations that share the names so far
    for (const auto& axis : axes) {
      each /= axis.names.size();
      names.push_back(axis.names[number / each % axis.names.size()]);
      merge(root, take_variant(variants, axis.key, names.back()));
    }
  }
  return cases;
}

CaseTables read_case_tables(const std::filesystem::path& path, const std::vector<std::string>& variants) {
  for (auto& tables : read_case_tables(path)) {
    if (tables.variants == variants) return std::move(tables);
  }
  throw InputError(fmt::format("{}: no longer has a variant '{}'", path.string(), fmt::join(variants, "-")));
}

CaseTables parse_case_text(const std::string& text, const std::string& name) {
  CaseTables tables{parse(text, name), {}};
  for (const char* key : {"mesh", "variants"}) {
    if (tables.root.contains(key)) {
      TableReader(tables.root, name, "")
          .fail(key, "is not allowed here: the text is one case, and its mesh is given separately");
    }
  }
  return tables;
}

}  // namespace sandglass
