#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "app/machine.hpp"
#include "assembly/method_entry.hpp"
#include "counting/method_work.hpp"
#include "counting/paper_hourglass_force.hpp"
#include "io/new_file.hpp"
#include "io/text_file.hpp"
#include "material/laws.hpp"

namespace sandglass {

namespace {

/// One line of the table.
struct Row {
  std::string_view method;
  std::string_view law;
  std::string_view form;  ///< "kernel": as it runs; "paper": as the paper writes it
  std::string_view part;
  Operations operations;
  long bytes = 0;  ///< 0 if the part reads nothing of its own
};

/// Every method with one law.
std::vector<Row> count_methods() {
  using Law = NeoHookean;
  std::vector<Row> rows;
  for (const MethodEntry& method : methods()) {
    const auto add = [&](std::string_view form, std::string_view part, const Operations& operations,
                         long bytes = 0) {
      rows.push_back({method.name, Law::name, form, part, operations, bytes});
    };
    if (method.is_condensed) {
      // Three columns for each handle, a product and a sum with each for every component of a node.
      add("update", "node", {.add = 9, .mul = 9}, 9 * sizeof(double));
    } else {
      const OperationCount count = work_of(method, kernel_law(Law{}), Shapes::any).operations;
      add("kernel", "gradient", count.gradient);
      add("kernel", "law", count.law);
      add("kernel", "force", count.force);
      if (count.hourglass.total() > 0) add("kernel", "hourglass", count.hourglass);
      add("kernel", "element", count.total, count.bytes);
      const OperationCount regular = work_of(method, kernel_law(Law{}), Shapes::parallelepipeds).operations;
      if (regular.bytes != count.bytes) add("parallelepipeds", "element", regular.total, regular.bytes);
    }
  }
  rows.push_back({"tl-perturbation", Law::name, "paper", "hourglass", count_paper_hourglass_force()});
  return rows;
}

/// Every law at one point of an element; counts do not depend on its parameters.
std::vector<Row> count_laws() {
  const MethodEntry& plain = method_named("tl-none");
  std::vector<Row> rows;
  for_each_type(Laws{}, [&]<class Law>() {
    rows.push_back({plain.name, Law::name, "kernel", "law",
                    work_of(plain, kernel_law(Law{}), Shapes::any).operations.law});
  });
  return rows;
}

/// "add mul div special total", right-aligned.
std::string columns(const Operations& n) {
  return fmt::format("{:>6}{:>6}{:>6}{:>9}{:>7}", n.add, n.mul, n.div, n.special, n.total());
}

void write_json(const std::vector<Row>& rows, const std::string& path) {
  nlohmann::ordered_json records = nlohmann::ordered_json::array();
  for (const auto& row : rows) {
    records.push_back({{"method", row.method},
                       {"law", row.law},
                       {"form", row.form},
                       {"part", row.part},
                       {"add", row.operations.add},
                       {"mul", row.operations.mul},
                       {"div", row.operations.div},
                       {"special", row.operations.special},
                       {"total", row.operations.total()},
                       {"bytes", row.bytes}});
  }
  nlohmann::ordered_json document;
  for (const auto& [name, value] : build_provenance()) document[name] = value;
  document["records"] = std::move(records);
  write_text_file(path, document.dump(1) + "\n");
}

}  // namespace

void add_flops_command(CLI::App& app) {
  auto json = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "flops", "print the operations per element and step, counted by running the kernels");
  command->add_option("--json", *json, "write every count to this file");
  command->callback([json] {
    if (!json->empty()) require_place(*json);
    auto rows = count_methods();
    fmt::print(
        "operations per element and step with the law {}; bytes: constants in double, places of nodes, "
        "history;\n"
        "of a condensed method, what an update takes per node and driven set\n"
        "{:<25}{:<16}{:<10}{:>6}{:>6}{:>6}{:>9}{:>7}{:>7}\n",
        NeoHookean::name, "method", "form", "part", "add", "mul", "div", "special", "total", "bytes");
    for (const auto& row : rows) {
      fmt::print("{:<25}{:<16}{:<10}{}{:>7}\n", row.method, row.form, row.part, columns(row.operations),
                 row.bytes > 0 ? fmt::to_string(row.bytes) : "");
    }
    const auto laws = count_laws();
    fmt::print("\noperations of the laws per point and step\n{:<43}{:>6}{:>6}{:>6}{:>9}{:>7}\n", "law", "add",
               "mul", "div", "special", "total");
    for (const auto& row : laws) fmt::print("{:<43}{}\n", row.law, columns(row.operations));
    rows.insert(rows.end(), laws.begin(), laws.end());
    if (!json->empty()) write_json(rows, *json);
  });
}

}  // namespace sandglass
