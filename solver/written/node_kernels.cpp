#include "written/node_kernels.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "base/error.hpp"

namespace sandglass {

namespace {

/// Adds the forces of elements at node e; in both kernels, so that their bits are equal.
constexpr std::string_view sum_of_elements = R"(      for (int k = first[e]; k < first[e + 1]; ++k) {
        x += f[slots[k]];
        y += f[slots[k] + elements];
        z += f[slots[k] + 2 * elements];
      }
)";

constexpr std::string_view sum_body = R"(    {real} x = 0, y = 0, z = 0;
{sum}    force[4 * e] = x;
    force[4 * e + 1] = y;
    force[4 * e + 2] = z;
    force[4 * e + 3] = 0;
)";

constexpr std::string_view move_body = R"(    {real} x = 0, y = 0, z = 0;
    if (after < 0) {{
      x = force[4 * e];
      y = force[4 * e + 1];
      z = force[4 * e + 2];
    }} else {{
{sum}      if (first_load[e] < first_load[e + 1]) {{
        {real} X = 0, Y = 0, Z = 0;
        for (int k = first_load[e]; k < first_load[e + 1]; ++k) {{
          const {real} c = steps[after + load_factors[k]];
          X += c * g[load_slots[k]];
          Y += c * g[load_slots[k] + columns];
          Z += c * g[load_slots[k] + 2 * columns];
        }}
        load_work[e] += ((X + load[4 * e]) * increment[4 * e] + (Y + load[4 * e + 1]) * increment[4 * e + 1] +
                         (Z + load[4 * e + 2]) * increment[4 * e + 2]) / 2;
        load[4 * e] = X;
        load[4 * e + 1] = Y;
        load[4 * e + 2] = Z;
        x -= X;
        y -= Y;
        z -= Z;
      }}
      if (next < 0) {{
        force[4 * e] = x;
        force[4 * e + 1] = y;
        force[4 * e + 2] = z;
      }}
      for (int k = first_constraint[e]; k < first_constraint[e + 1]; ++k) {{
        const int i = components[k], m = after + angles[k];
        const {real} r = i == 0 ? x : i == 1 ? y : z;
        const {real} moved = shares[4 * k] * steps[m + 3] + shares[4 * k + 1] * steps[m + 4] +
                             shares[4 * k + 2] * steps[m + 5];
        const {real} driven = r + shares[4 * k + 3] * (shares[4 * k] * steps[m + 6] +
                              shares[4 * k + 1] * steps[m + 7] + shares[4 * k + 2] * steps[m + 8]);
        work[k] += (driving[k] + driven) * moved / 2;
        driving[k] = driven;
        reaction[k] = r;
        increment[4 * e + i] = 0;
        if (next < 0) force[4 * e + i] = 0;
      }}
    }}
    if (next >= 0) {{
      const {real} kept = steps[next], gained = steps[next + 1] * inverse_mass[e];
      x = kept * increment[4 * e] + gained * x;
      y = kept * increment[4 * e + 1] + gained * y;
      z = kept * increment[4 * e + 2] + gained * z;
      increment[4 * e] = x;
      increment[4 * e + 1] = y;
      increment[4 * e + 2] = z;
      u[4 * e] += x;
      u[4 * e + 1] += y;
      u[4 * e + 2] += z;
      for (int k = first_constraint[e]; k < first_constraint[e + 1]; ++k) {{
        const int m = next + angles[k];
        const {real} d = shares[4 * k] * steps[m] + shares[4 * k + 1] * steps[m + 1] +
                         shares[4 * k + 2] * steps[m + 2];
        increment[4 * e + components[k]] += d - u[4 * e + components[k]];
        u[4 * e + components[k]] = d;
      }}
    }}
)";

constexpr std::string_view ill_body = R"(    if (!(jacobian[e] > 0 && jacobian[e] * 0 == 0)) ill[0] = 1;
)";

}  // namespace

const std::vector<NodeKernel>& node_kernels() {
  using enum NodeKernel::Kind;
  static const std::vector<NodeKernel::Argument> gather{
      {"elements", integer, "columns of f"},
      {"first", indices, "where the slots of each node begin, and their number at the end"},
      {"slots", indices, "where in f the forces on a node are: components follow at `elements`"},
      {"f", array, "forces of elements, N"}};
  static const auto with_gather = [](std::vector<NodeKernel::Argument> before,
                                     const std::vector<NodeKernel::Argument>& after) {
    before.insert(before.end(), gather.begin(), gather.end());
    before.insert(before.end(), after.begin(), after.end());
    return before;
  };
  static const std::vector<NodeKernel> list{
      {"sum_at_nodes", "Adds the forces of elements at nodes, always in the same order.",
       with_gather({}, {{"force", results, "N, four numbers for each node"}}), sum_body},
      {"move_nodes",
       "Adds the forces after a step, unless `after` is negative, and takes the next step, unless `next` is.",
       with_gather(
           {{"after", integer, "where in `steps` the numbers of the last step are"},
            {"next", integer, "where those of the next step are"},
            {"steps", array,
             "of each step: keep, -gain, factors of loads, and for each angle three terms of paths, their "
             "changes, their accelerations"}},
           {{"columns", integer, "of g"},
            {"first_load", indices, "where the loads of each node begin, and their number at the end"},
            {"load_slots", indices, "where in g a load is: components follow at `columns`"},
            {"load_factors", indices, "where its factor is among the numbers of a step"},
            {"g", array, "loads at the factor one, N"},
            {"first_constraint", indices, "where the constraints of each node begin, and their number"},
            {"components", indices, "of each constraint, 0 to 2"},
            {"angles", indices, "where the terms of its path are among the numbers of a step"},
            {"shares", array, "of each constraint: three shares (m) of its path, and the mass, kg"},
            {"inverse_mass", array, "1/kg"},
            {"u", results, "displacements, m, four numbers for each node"},
            {"increment", results, "their last change, m"},
            {"force", results, "N, internal minus loads; set only if no step is taken"},
            {"load", results, "N, of the last evaluation"},
            {"load_work", results, "J, of the loads on each node"},
            {"reaction", results, "N, of each constraint"},
            {"driving", results, "N, reaction and inertia of each constraint"},
            {"work", results, "J, of each constraint"}}),
       move_body},
      {"find_ill",
       "Sets `ill` if the smallest det F of an element is not positive or not finite.",
       {{"jacobian", array, "smallest det F of each element"}, {"ill", results, "one number"}},
       ill_body}};
  return list;
}

const NodeKernel& node_kernel(std::string_view name) {
  return *std::ranges::find(node_kernels(), name, &NodeKernel::name);
}

template <class Real>
std::string node_kernel_text(const NodeKernel& kernel, const Dialect& dialect) {
  if (dialect.integer.empty()) {
    throw InputError(
        fmt::format("--dialect = '{}' has no kernels of nodes; allowed: c, opencl, cuda", dialect.name));
  }
  const auto filled = [&](std::string_view format, const auto&... arguments) {
    return fmt::format(fmt::runtime(format),
                       fmt::arg("real", std::is_same_v<Real, float> ? "float" : "double"), arguments...);
  };
  std::string text = fmt::format("// {}\n", kernel.meaning);
  std::vector<std::string> arguments;
  for (const auto& [name, kind, meaning] : kernel.arguments) {
    const std::array<std::string_view, 4> formats{dialect.integer, dialect.indices, dialect.array,
                                                  dialect.results};
    arguments.push_back(filled(formats[static_cast<std::size_t>(kind)], fmt::arg("name", name),
                               fmt::arg("number", arguments.size())));
    text += fmt::format("//   {}: {}\n", name, meaning);
  }
  return text +
         filled(dialect.kernel, fmt::arg("name", kernel.name),
                fmt::arg("arguments", fmt::to_string(fmt::join(arguments, dialect.between)))) +
         filled(kernel.body, fmt::arg("sum", sum_of_elements)) + std::string(dialect.end);
}

template std::string node_kernel_text<double>(const NodeKernel&, const Dialect&);
template std::string node_kernel_text<float>(const NodeKernel&, const Dialect&);

}  // namespace sandglass
