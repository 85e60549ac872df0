#include "io/table_reader.hpp"

#include <algorithm>
#include <limits>
#include <sstream>

#include "base/names.hpp"
#include "io/toml_text.hpp"

namespace sandglass {

namespace {

std::string written(const toml::node& node) {
  if (node.is_table()) return "a table";
  if (!node.is_string()) return value_text(node);
  std::ostringstream stream;  // with the quotes of all messages and escapes
  stream << *node.as_string();
  return stream.str();
}

template <class T>
constexpr std::string_view type_name() {
  if constexpr (std::is_same_v<T, bool>) return "true or false";
  if constexpr (std::is_same_v<T, int>) return "an integer";
  if constexpr (std::is_same_v<T, double>) return "a number";
  if constexpr (std::is_same_v<T, std::string>) return "a text";
}

/// The value of a node as T, or none if it has another type. Integers are also numbers, but not the reverse.
template <class T>
std::optional<T> scalar(const toml::node& node) {
  if constexpr (std::is_same_v<T, int>) {
    if (!node.is_integer()) return std::nullopt;
    const auto value = *node.value<std::int64_t>();
    if (value < std::numeric_limits<int>::min() || value > std::numeric_limits<int>::max())
      return std::nullopt;
    return static_cast<int>(value);
  } else if constexpr (std::is_same_v<T, double>) {
    if (!node.is_number()) return std::nullopt;
    return node.value<double>();
  } else {
    return node.value_exact<T>();
  }
}

}  // namespace

TableReader::TableReader(const toml::table& table, std::filesystem::path file, std::string prefix)
    : table_(table), file_(std::move(file)), prefix_(std::move(prefix)) {}

const toml::node* TableReader::find(const std::string& key) {
  asked_.insert(key);
  return table_.get(key);
}

std::string TableReader::name_of(const std::string& key) const {
  return prefix_.empty() ? key : prefix_ + "." + key;
}

std::string TableReader::place_of(const std::string& key) const {
  const toml::node* node = table_.get(key);
  const auto line = node != nullptr ? node->source().begin.line : table_.source().begin.line;
  return fmt::format("{}:{}: {}", file_.string(), line, name_of(key));
}

void TableReader::fail(const std::string& key, const std::string& message) const {
  throw InputError(place_of(key) + " " + message);
}

void TableReader::fail_missing(const std::string& key) const {
  // If a key is missing because it is misspelt, the message names the misspelling.
  for (const auto& given : keys()) {
    if (!asked_.contains(given) && nearest_name(given, {key}) == key) {
      fail(given, fmt::format("is not a key of this table; did you mean '{}'?", key));
    }
  }
  fail(key, "is missing; this key must be given");
}

void TableReader::require_one_of(const std::vector<std::string_view>& keys) const {
  const auto is_given = [&](std::string_view key) { return table_.contains(key); };
  if (std::any_of(keys.begin(), keys.end(), is_given)) return;
  fail(std::string(keys.front()),
       fmt::format("or {} must be given, or {}", fmt::join(keys.begin() + 1, keys.end(), ", "),
                   keys.size() > 2 ? "several" : "both"));
}

void TableReader::fail_type(const std::string& key, const toml::node& node, std::string_view expected) const {
  const auto* text = node.as_string();
  fail(key, fmt::format("= {} must be {}{}", written(node), expected,
                        text != nullptr ? decimal_comma_hint(text->get()) : ""));
}

void TableReader::require_in_range(const std::string& key, double value, const Range& range) const {
  if (!range.contains(value)) fail(key, fmt::format("= {} must be in {}", value, range.text()));
}

template <class T>
T TableReader::convert(const toml::node& node, const std::string& key) const {
  if constexpr (requires { typename T::value_type; } && !std::is_same_v<T, std::string>) {
    using Entry = typename T::value_type;
    const toml::array* array = node.as_array();
    T values{};
    constexpr bool fixed = requires {
      std::tuple_size<T>::value;
    };
    std::string expected = fmt::format("a list, each entry {}", type_name<Entry>());
    if constexpr (fixed) expected = fmt::format("a list of {}, each {}", values.size(), type_name<Entry>());
    if (array == nullptr) fail_type(key, node, expected);
    if constexpr (fixed) {
      if (array->size() == 2 * values.size()) expected += "; decimals have a point, such as 0.1";
      if (array->size() != values.size()) fail_type(key, node, expected);
    } else {
      if (array->empty()) fail(key, "= [] must have at least one entry");
      values.resize(array->size());
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto entry = scalar<Entry>(*array->get(i));
      if (!entry) fail_type(key, node, expected);
      values[i] = *entry;
    }
    return values;
  } else {
    const auto value = scalar<T>(node);
    if (!value) fail_type(key, node, type_name<T>());
    return *value;
  }
}

template double TableReader::convert<double>(const toml::node&, const std::string&) const;
template int TableReader::convert<int>(const toml::node&, const std::string&) const;
template bool TableReader::convert<bool>(const toml::node&, const std::string&) const;
template std::string TableReader::convert<std::string>(const toml::node&, const std::string&) const;
template std::array<double, 2> TableReader::convert<std::array<double, 2>>(const toml::node&,
                                                                           const std::string&) const;
template std::array<double, 3> TableReader::convert<std::array<double, 3>>(const toml::node&,
                                                                           const std::string&) const;
template std::array<int, 3> TableReader::convert<std::array<int, 3>>(const toml::node&,
                                                                     const std::string&) const;
template std::vector<double> TableReader::convert<std::vector<double>>(const toml::node&,
                                                                       const std::string&) const;
template std::vector<int> TableReader::convert<std::vector<int>>(const toml::node&, const std::string&) const;
template std::vector<std::string> TableReader::convert<std::vector<std::string>>(const toml::node&,
                                                                                 const std::string&) const;

bool TableReader::holds_number(const std::string& key) {
  const toml::node* node = find(key);
  return node != nullptr && node->is_number();
}

bool TableReader::holds_text(const std::string& key) {
  const toml::node* node = find(key);
  return node != nullptr && node->is_string();
}

std::string TableReader::required_choice(const std::string& key, const std::vector<std::string>& allowed) {
  auto value = required<std::string>(key);
  if (std::find(allowed.begin(), allowed.end(), value) == allowed.end()) {
    fail(key, fmt::format("= '{}' is not known; {}", value, suggestion(value, allowed)));
  }
  return value;
}

std::optional<TableReader> TableReader::table(const std::string& key) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_table()) fail_type(key, *node, "a table");
  return TableReader(*node->as_table(), file_, name_of(key));
}

TableReader TableReader::required_table(const std::string& key) {
  if (auto found = table(key)) return *found;
  fail_missing(key);
}

std::vector<TableReader> TableReader::tables(const std::string& key) {
  std::vector<TableReader> readers;
  const toml::node* node = find(key);
  if (node == nullptr) return readers;
  if (!node->is_array_of_tables())
    fail_type(key, *node, fmt::format("an array of tables, [[{}]]", name_of(key)));
  for (const auto& entry : *node->as_array()) readers.emplace_back(*entry.as_table(), file_, name_of(key));
  return readers;
}

std::vector<std::string> TableReader::keys() const {
  std::vector<std::string> names;
  for (const auto& [key, node] : table_) names.emplace_back(key.str());
  return names;
}

void TableReader::finish() const {
  for (const auto& [key, node] : table_) {
    const std::string name(key.str());
    if (asked_.contains(name)) continue;
    fail(name,
         fmt::format("is not a key of this table; {}", suggestion(name, {asked_.begin(), asked_.end()})));
  }
}

}  // namespace sandglass
