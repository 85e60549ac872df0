#include "comparison/program_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <map>
#include <set>

namespace sandglass {

namespace {

constexpr std::size_t column_width = 10;

/// Orders meshes by their elements per side; names that are not numbers come last.
struct IsCoarser {
  static double size(const std::string& mesh) {
    const double elements = std::strtod(mesh.c_str(), nullptr);
    return elements > 0.0 ? elements : std::numeric_limits<double>::infinity();
  }
  bool operator()(const std::string& a, const std::string& b) const {
    return std::pair(size(a), a) < std::pair(size(b), b);
  }
};

/// The texts of the cells.
class Cells {
 public:
  void add(const std::string& row, const std::string& mesh, const std::string& text) {
    if (std::find(rows_.begin(), rows_.end(), row) == rows_.end()) rows_.push_back(row);
    meshes_.insert(mesh);
    texts_[{row, mesh}] = text;
  }

  std::string text() const {
    std::string text(label_width, ' ');
    for (const auto& mesh : meshes_) text += fmt::format("{:>{}}", mesh, column_width);
    for (const auto& row : rows_) {
      text += fmt::format("\n{:<{}}", row, label_width);
      for (const auto& mesh : meshes_) {
        const auto found = texts_.find({row, mesh});
        text += fmt::format("{:>{}}", found == texts_.end() ? "" : found->second, column_width);
      }
    }
    return text + "\n";
  }

 private:
  std::vector<std::string> rows_;
  std::set<std::string, IsCoarser> meshes_;
  std::map<std::pair<std::string, std::string>, std::string> texts_;
};

std::string mesh_of(const Verdict& verdict) {
  return verdict.variants.empty() ? "" : verdict.variants.back();
}

/// The name of the case without its mesh.
std::string subject_of(const Verdict& verdict) {
  const auto& variants = verdict.variants;
  const auto end = variants.empty() ? variants.end() : variants.end() - 1;
  std::vector<std::string> names{verdict.family};
  names.insert(names.end(), variants.begin(), end);
  return fmt::format("{}", fmt::join(names, " "));
}

/// The table of the published value with number `n`, of verdicts that differ in mesh and method.
std::string table(const std::vector<const Verdict*>& verdicts, std::size_t n) {
  const PublishedValue& published = verdicts.front()->published[n].published;
  Cells cells;
  for (const auto* verdict : verdicts) {
    const auto& computed = verdict->published[n].computed;
    const bool known = verdict->ok() && computed;
    cells.add(row_label(*verdict), mesh_of(*verdict), known ? fmt::format("{:.5g}", *computed) : "failed");
  }
  std::string sources;
  for (const auto& program : published.programs) {
    for (std::size_t i = 0; i < program.values.size(); ++i) {
      const std::string mesh = program.elements.empty() ? "other" : fmt::to_string(program.elements[i]);
      cells.add(program.program, mesh, fmt::format("{:.5g}", program.values[i]));
    }
    sources += fmt::format("{}: {}\n", program.program, program.source);
  }
  return fmt::format("\n{}: {} of {}, published {:.5g} ({})\n{}{}", subject_of(*verdicts.front()),
                     published.component, published.set, published.value, published.source, cells.text(),
                     sources);
}

}  // namespace

std::string row_label(const Verdict& verdict) {
  if (!verdict.kappa || verdict.kappa_is_auto) return verdict.method;
  return fmt::format("{} {:.4g}", verdict.method, *verdict.kappa);
}

std::string program_tables(const std::vector<const Verdict*>& family) {
  std::map<std::string, std::vector<const Verdict*>> subjects;
  for (const auto* verdict : family) subjects[subject_of(*verdict)].push_back(verdict);
  std::string text;
  for (const auto& [name, verdicts] : subjects) {
    const auto& published = verdicts.front()->published;
    for (std::size_t n = 0; n < published.size(); ++n) {
      if (!published[n].published.programs.empty()) text += table(verdicts, n);
    }
  }
  return text;
}

}  // namespace sandglass
