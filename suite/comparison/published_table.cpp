#include "comparison/published_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "comparison/program_table.hpp"

namespace sandglass {

namespace {

/// A column: a published value of a case.
struct Column {
  const Verdict* verdict;  // the first of its case
  std::size_t value;       // among those of the case
};

using Ratio = std::optional<double> (PublishedResult::*)() const;

std::vector<Column> columns_of(const std::vector<const Verdict*>& family) {
  std::vector<Column> columns;
  std::string last;
  for (const auto* verdict : family) {
    if (verdict->case_name == last) continue;
    last = verdict->case_name;
    for (std::size_t n = 0; n < verdict->published.size(); ++n) columns.push_back({verdict, n});
  }
  return columns;
}

/// The names of the variants above their columns, a line for each axis; each name is above its first column.
std::string header(const std::vector<Column>& columns, std::size_t width) {
  std::string text;
  const auto& axes = columns.front().verdict->variants;
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    std::string line(label_width, ' '), last;
    for (const auto& column : columns) {
      const auto& names = column.verdict->variants;
      const std::string group = fmt::format(
          "{}", fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(axis) + 1, " "));
      line += fmt::format("{:>{}}", group == last ? "" : names[axis], width);
      last = group;
    }
    text += line + "\n";
  }
  return text;
}

std::string cell(const Verdict& verdict, std::size_t value, Ratio ratio) {
  if (!verdict.ok()) return "failed";
  const auto number = (verdict.published[value].*ratio)();
  if (!number) return "-";
  return std::abs(*number) < 100.0 ? fmt::format("{:.4f}", *number) : fmt::format("{:.1e}", *number);
}

std::string table(const std::vector<const Verdict*>& family, const std::string& title, Ratio ratio) {
  const auto columns = columns_of(family);
  std::size_t width = 9;
  for (const auto& column : columns) {
    const auto& names = column.verdict->variants;
    if (!names.empty()) width = std::max(width, names.back().size() + 2);
  }
  std::string text = fmt::format("\n{}\n{}", title, header(columns, width));
  std::vector<std::string> rows;
  for (const auto* verdict : family) {
    const std::string name = row_label(*verdict);
    if (std::find(rows.begin(), rows.end(), name) == rows.end()) rows.push_back(name);
  }
  for (const auto& row : rows) {
    text += fmt::format("{:<{}}", row, label_width);
    for (const auto& column : columns) {
      const auto found = std::find_if(family.begin(), family.end(), [&](const Verdict* v) {
        return v->case_name == column.verdict->case_name && row_label(*v) == row;
      });
      text += fmt::format("{:>{}}", found == family.end() ? "" : cell(**found, column.value, ratio), width);
    }
    text += "\n";
  }
  return text;
}

std::string sources_of(const std::vector<Column>& columns) {
  std::vector<std::string> sources;
  for (const auto& column : columns) {
    const auto& source = column.verdict->published[column.value].published.source;
    if (std::find(sources.begin(), sources.end(), source) == sources.end()) sources.push_back(source);
  }
  return fmt::format("{}", fmt::join(sources, "; "));
}

}  // namespace

std::string published_tables(const std::vector<Verdict>& verdicts) {
  std::vector<std::string> families;
  for (const auto& verdict : verdicts) {
    if (verdict.published.empty()) continue;
    if (std::find(families.begin(), families.end(), verdict.family) == families.end())
      families.push_back(verdict.family);
  }
  std::string text;
  for (const auto& name : families) {
    std::vector<const Verdict*> family;
    for (const auto& verdict : verdicts) {
      if (verdict.family == name && !verdict.published.empty()) family.push_back(&verdict);
    }
    text += program_tables(family);
    text += table(family,
                  fmt::format("{}: computed over {} ({})", name,
                              family.front()->published.front().published.scatter ? "measured" : "published",
                              sources_of(columns_of(family))),
                  &PublishedResult::ratio);
    const bool any_truth = std::any_of(family.begin(), family.end(), [](const Verdict* v) {
      return v->published.front().truth.has_value();
    });
    if (!any_truth) continue;
    text += table(family, fmt::format("{}: computed over truth", name), &PublishedResult::ratio_to_truth);
  }
  return text;
}

}  // namespace sandglass
