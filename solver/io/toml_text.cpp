#include "io/toml_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

namespace sandglass {

namespace {

using Entry = std::pair<std::string, const toml::node*>;

/// The entries of a table in the order of the file.
std::vector<Entry> in_order(const toml::table& table) {
  std::vector<Entry> entries;
  for (const auto& [key, node] : table) entries.emplace_back(std::string(key.str()), &node);
  std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    const auto place = [](const Entry& entry) {
      const auto begin = entry.second->source().begin;
      return std::tuple(!begin, begin.line, begin.column);
    };
    return place(a) < place(b);
  });
  return entries;
}

std::string quoted(const std::string& text) {
  std::ostringstream out;
  const toml::value<std::string> value(text);
  out << toml::toml_formatter{value, toml::format_flags::none};
  return out.str();
}

std::string key_text(const std::string& key) {
  constexpr std::string_view bare = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  const bool plain = !key.empty() && key.find_first_not_of(bare) == std::string::npos;
  return plain ? key : quoted(key);
}

/// A number as text that reads back as the same number, and not as an integer.
std::string number_text(double value) {
  std::string text = fmt::to_string(value);
  if (std::isfinite(value) && text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

}  // namespace

std::string value_text(const toml::node& node) {
  if (const auto* number = node.as_floating_point()) return number_text(number->get());
  if (const auto* text = node.as_string()) return quoted(text->get());
  std::string list;
  if (const auto* array = node.as_array()) {
    for (const auto& entry : *array) list += (list.empty() ? "" : ", ") + value_text(entry);
    return "[" + list + "]";
  }
  if (const auto* table = node.as_table()) {
    for (const auto& [key, entry] : in_order(*table)) {
      list += fmt::format("{}{} = {}", list.empty() ? "" : ", ", key_text(key), value_text(*entry));
    }
    return list.empty() ? "{}" : "{ " + list + " }";
  }
  std::ostringstream out;
  node.visit([&](const auto& value) {
    if constexpr (toml::is_value<decltype(value)>) out << value;
  });
  return out.str();
}

namespace {

std::string lines_text(const toml::table& table) {
  std::string text;
  for (const auto& [key, node] : in_order(table)) {
    text += fmt::format("{} = {}\n", key_text(key), value_text(*node));
  }
  return text;
}

bool is_list_of_tables(const toml::node& node) {
  const auto* array = node.as_array();
  return array != nullptr && !array->empty() && array->is_homogeneous(toml::node_type::table);
}

}  // namespace

std::string toml_text(const toml::table& document) {
  std::string values, tables;
  for (const auto& [key, node] : in_order(document)) {
    if (const auto* table = node->as_table()) {
      tables += fmt::format("\n[{}]\n{}", key_text(key), lines_text(*table));
    } else if (is_list_of_tables(*node)) {
      for (const auto& entry : *node->as_array()) {
        tables += fmt::format("\n[[{}]]\n{}", key_text(key), lines_text(*entry.as_table()));
      }
    } else {
      values += fmt::format("{} = {}\n", key_text(key), value_text(*node));
    }
  }
  return values + tables;
}

}  // namespace sandglass
