#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/parameter.hpp"
#include "base/type_list.hpp"
#include "forces/formula.hpp"
#include "io/toml.hpp"

namespace sandglass {

/// One TOML table read strictly: every read is checked, and `finish` rejects the keys that nobody read.
/// All errors are InputErrors that name file, line, key, value and rule.
class TableReader {
 public:
  /// `prefix` is the table's name in messages, such as "material".
  TableReader(const toml::table& table, std::filesystem::path file, std::string prefix);

  const std::filesystem::path& file() const { return file_; }

  /// The value of a key; none if the key is absent. T: double, int, bool, std::string, a std::array or
  /// std::vector of double or int, a std::vector of std::string.
  template <class T>
  std::optional<T> optional(const std::string& key) {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    return convert<T>(*node, key);
  }

  template <class T>
  T required(const std::string& key) {
    if (auto value = optional<T>(key)) return *value;
    fail_missing(key);
  }

  /// The same for a number, or numbers, in a range.
  template <class T>
  std::optional<T> optional(const std::string& key, const Range& range) {
    auto value = optional<T>(key);
    if (value) require_in_range(key, *value, range);
    return value;
  }

  template <class T>
  T required(const std::string& key, const Range& range) {
    T value = required<T>(key);
    require_in_range(key, value, range);
    return value;
  }

  /// Whether the key exists and holds a number, or a text.
  bool holds_number(const std::string& key);
  bool holds_text(const std::string& key);

  /// One of a list of words.
  std::string required_choice(const std::string& key, const std::vector<std::string>& allowed);

  /// A table below this one; none if absent.
  std::optional<TableReader> table(const std::string& key);
  TableReader required_table(const std::string& key);

  /// The tables of an array of tables [[key]]; empty if absent.
  std::vector<TableReader> tables(const std::string& key);

  /// All keys of this table; they then count as read.
  std::vector<std::string> keys() const;

  /// The entry of a list of types that a key names, with its parameters, if any.
  template <class List>
  VariantOf<List> required_listed(const std::string& key) {
    VariantOf<List> chosen;
    with_named_type(List{}, required_choice(key, names_of(List{})), [&]<class Type>() {
      Type value{};
      if constexpr (requires { Type::parameters(); }) parameters(value);
      chosen = value;
    });
    return chosen;
  }

  /// Reads all declared parameters of an aggregate, each within its range, and checks the aggregate's rules
  /// between them. The keys of a parameter that is itself an aggregate are in this table; a list of
  /// aggregates is an array of tables.
  template <class Aggregate>
  void parameters(Aggregate& aggregate) {
    std::apply([&](const auto&... parameter) { (read(aggregate, parameter), ...); }, Aggregate::parameters());
    if constexpr (requires { Aggregate::one_of; })
      require_one_of({Aggregate::one_of.begin(), Aggregate::one_of.end()});
    if constexpr (requires { aggregate.broken_rule(); }) {
      if (const auto broken = aggregate.broken_rule()) fail(broken->parameter, broken->message);
    }
  }

  /// Accepts a key without reading it.
  void leave(const std::string& key) { asked_.insert(key); }

  /// Throws if the table has a key that was not read; suggests the closest one that was.
  void finish() const;

  /// Throws an InputError about a key: "file:line: prefix.key message".
  [[noreturn]] void fail(const std::string& key, const std::string& message) const;

 private:
  const toml::node* find(const std::string& key);
  void require_one_of(const std::vector<std::string_view>& keys) const;
  [[noreturn]] void fail_missing(const std::string& key) const;
  [[noreturn]] void fail_type(const std::string& key, const toml::node& node,
                              std::string_view expected) const;
  std::string name_of(const std::string& key) const;
  std::string place_of(const std::string& key) const;  // "file:line: prefix.key"

  template <class T>
  T convert(const toml::node& node, const std::string& key) const;

  void require_in_range(const std::string& key, double value, const Range& range) const;
  template <class Values>
  requires(!std::is_arithmetic_v<Values>) void require_in_range(const std::string& key, const Values& values,
                                                                const Range& range) const {
    for (const auto value : values) require_in_range(key, static_cast<double>(value), range);
  }

  template <class Aggregate, class Value>
  void read(Aggregate& aggregate, const Parameter<Aggregate, Value>& parameter) {
    const std::string key(parameter.name);
    Value& value = aggregate.*(parameter.member);
    if constexpr (requires { Value::parameters(); }) {
      parameters(value);
    } else if constexpr (requires { Value::value_type::parameters(); }) {
      for (TableReader& table : tables(key)) {
        table.parameters(value.emplace_back());
        table.finish();
      }
    } else if constexpr (std::is_enum_v<Value>) {
      if (!parameter.required && !optional<std::string>(key)) return;
      const auto words = words_of(value);
      const std::string word = required_choice(key, {words.begin(), words.end()});
      value = static_cast<Value>(std::find(words.begin(), words.end(), word) - words.begin());
    } else if constexpr (std::is_same_v<Value, Formula>) {
      if (const auto text = optional<std::string>(key)) value = Formula(*text, place_of(key));
    } else if (auto given = parameter.required ? required<Value>(key) : optional<Value>(key)) {
      if constexpr (!std::is_same_v<Value, bool> && !std::is_same_v<Value, std::string>)
        require_in_range(key, *given, parameter.range);
      value = std::move(*given);
    }
  }

  const toml::table& table_;
  std::filesystem::path file_;
  std::string prefix_;
  std::set<std::string> asked_;
};

}  // namespace sandglass
