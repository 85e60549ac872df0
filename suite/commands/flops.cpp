#include "commands/flops.hpp"

#include <nlohmann/json.hpp>

#include "assembly/method_entry.hpp"
#include "counting/method_work.hpp"
#include "counting/paper_hourglass_force.hpp"
#include "material/laws.hpp"
#include "written/force_program.hpp"

namespace sandglass {

std::vector<CountedPart> count_methods() {
  using Law = NeoHookean;
  std::vector<CountedPart> rows;
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

std::vector<CountedPart> count_laws() {
  const MethodEntry& plain = method_named("tl-none");
  std::vector<CountedPart> rows;
  for_each_type(Laws{}, [&]<class Law>() {
    rows.push_back({plain.name, Law::name, "kernel", "law",
                    work_of(plain, kernel_law(Law{}), Shapes::any).operations.law});
  });
  return rows;
}

std::vector<CountedProgram> count_programs() {
  const NeoHookean law{.young_modulus = 3000.0,
                       .poisson_ratio = 0.49};  // its moduli are constants of programs
  std::vector<CountedProgram> programs;
  for (const MethodEntry& method : methods()) {
    if (!why_not_written(method.name).empty()) continue;
    const ForceProgram force = force_program(method.name, elastic_law(kernel_law(law)), false);
    programs.push_back({method.name, shape_of(force.program)});
  }
  return programs;
}

std::string to_json(const Provenance& provenance, const std::vector<CountedPart>& parts,
                    const std::vector<CountedProgram>& programs) {
  nlohmann::ordered_json document;
  for (const auto& [name, value] : provenance) document[name] = value;
  document["records"] = nlohmann::ordered_json::array();
  for (const auto& part : parts) {
    document["records"].push_back({{"method", part.method},
                                   {"law", part.law},
                                   {"form", part.form},
                                   {"part", part.part},
                                   {"add", part.operations.add},
                                   {"mul", part.operations.mul},
                                   {"div", part.operations.div},
                                   {"special", part.operations.special},
                                   {"total", part.operations.total()},
                                   {"bytes", part.bytes}});
  }
  document["programs"] = nlohmann::ordered_json::array();
  for (const auto& [method, shape] : programs) {
    document["programs"].push_back({{"method", method},
                                    {"operations", shape.operations},
                                    {"fused", shape.fused},
                                    {"instructions", shape.instructions()},
                                    {"chain", shape.chain},
                                    {"alive", shape.alive},
                                    {"peak_share", shape.peak_share()}});
  }
  return document.dump(1) + "\n";
}

}  // namespace sandglass
