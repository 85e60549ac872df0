#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "element/methods.hpp"
#include "element/operation_count.hpp"
#include "io/text_file.hpp"
#include "material/laws.hpp"

namespace sandglass {

namespace {

/// One line of the table.
struct Row {
  std::string method;
  std::string form;  ///< "kernel": what runs; "paper": as the paper writes it
  std::string part;
  Operations operations;
  long bytes = 0;  ///< 0 where the part reads nothing of its own
};

std::vector<Row> count_all() {
  std::vector<Row> rows;
  for_each_type(Methods{}, [&]<class Method>() {
    const std::string name(Method::name);
    if constexpr (is_condensed<Method>) {
      // Three columns for each handle, a product and a sum with each for every component of a node.
      rows.push_back({name, "update", "node", {.add = 9, .mul = 9}, 9 * sizeof(double)});
      return;
    }
    const NeoHookean law{.young_modulus = 3000.0, .poisson_ratio = 0.49};
    const OperationCount count =
        count_operations<typename Method::Kinematics, typename Method::Hourglass>(law);
    rows.push_back({name, "kernel", "gradient", count.gradient});
    rows.push_back({name, "kernel", "law", count.law});
    rows.push_back({name, "kernel", "force", count.force});
    if (Method::Hourglass::active) rows.push_back({name, "kernel", "hourglass", count.hourglass});
    rows.push_back({name, "kernel", "element", count.total, count.bytes});
  });
  rows.push_back({std::string(TlPerturbation::name), "paper", "hourglass", count_paper_hourglass_force()});
  return rows;
}

void write_json(const std::vector<Row>& rows, const std::string& path) {
  nlohmann::ordered_json records = nlohmann::ordered_json::array();
  for (const auto& row : rows) {
    records.push_back({{"method", row.method},
                       {"form", row.form},
                       {"part", row.part},
                       {"add", row.operations.add},
                       {"mul", row.operations.mul},
                       {"div", row.operations.div},
                       {"special", row.operations.special},
                       {"total", row.operations.total()},
                       {"bytes", row.bytes}});
  }
  write_text_file(path, nlohmann::ordered_json{{"records", records}}.dump(1) + "\n");
}

}  // namespace

void add_flops_command(CLI::App& app) {
  auto json = std::make_shared<std::string>();
  CLI::App* command =
      app.add_subcommand("flops", "operations per element and step, counted in the kernels that run");
  command->add_option("--json", *json, "write every count to this file");
  command->callback([json] {
    const auto rows = count_all();
    fmt::print(
        "operations per element and step with the law {}; bytes: constants in double, places of nodes, "
        "history;\n"
        "of a condensed method, what an update takes per node and driven set\n"
        "{:<25}{:<8}{:<10}{:>6}{:>6}{:>6}{:>9}{:>7}{:>7}\n",
        NeoHookean::name, "method", "form", "part", "add", "mul", "div", "special", "total", "bytes");
    for (const auto& row : rows) {
      const auto& n = row.operations;
      fmt::print("{:<25}{:<8}{:<10}{:>6}{:>6}{:>6}{:>9}{:>7}{:>7}\n", row.method, row.form, row.part, n.add,
                 n.mul, n.div, n.special, n.total(), row.bytes > 0 ? fmt::to_string(row.bytes) : "");
    }
    if (!json->empty()) write_json(rows, *json);
  });
}

}  // namespace sandglass
