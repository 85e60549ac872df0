#include "written/node_kernels.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <regex>

namespace sandglass {

namespace {

/// Adds the forces of elements at node e; in both kernels, so that their bits are equal.
constexpr std::string_view sum_of_elements = R"(      for ({int} k = first[e]; k < first[e + 1]; k++) {{
        x += f[slots[k]];
        y += f[slots[k] + elements];
        z += f[slots[k] + 2 * elements];
      }}
)";

constexpr std::string_view sum_body = R"(    {real} x = 0.0f;
    {real} y = 0.0f;
    {real} z = 0.0f;
{sum}    force[4 * e] = x;
    force[4 * e + 1] = y;
    force[4 * e + 2] = z;
    force[4 * e + 3] = 0;
)";

constexpr std::string_view move_body = R"(    {real} x = 0.0f;
    {real} y = 0.0f;
    {real} z = 0.0f;
    if (after < 0) {{
      x = force[4 * e];
      y = force[4 * e + 1];
      z = force[4 * e + 2];
    }} else {{
{sum}      if (first_load[e] < first_load[e + 1]) {{
        {real} X = 0.0f;
        {real} Y = 0.0f;
        {real} Z = 0.0f;
        for ({int} k = first_load[e]; k < first_load[e + 1]; k++) {{
          {const_real} c = steps[after + load_factors[k]];
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
      for ({int} k = first_constraint[e]; k < first_constraint[e + 1]; k++) {{
        {const_int} i = components[k];
        {const_int} m = after + angles[k];
        {const_real} r = {component};
        {const_real} moved = shares[4 * k] * steps[m + 3] + shares[4 * k + 1] * steps[m + 4] +
                             shares[4 * k + 2] * steps[m + 5];
        {const_real} driven = r + shares[4 * k + 3] * (shares[4 * k] * steps[m + 6] +
                              shares[4 * k + 1] * steps[m + 7] + shares[4 * k + 2] * steps[m + 8]);
        work[k] += (driving[k] + driven) * moved / 2;
        driving[k] = driven;
        reaction[k] = r;
        increment[4 * e + i] = 0;
        if (next < 0) {{
          force[4 * e + i] = 0;
        }}
      }}
    }}
    if (next >= 0) {{
      {const_real} kept = steps[next];
      {const_real} gained = steps[next + 1] * inverse_mass[e];
      x = kept * increment[4 * e] + gained * x;
      y = kept * increment[4 * e + 1] + gained * y;
      z = kept * increment[4 * e + 2] + gained * z;
      increment[4 * e] = x;
      increment[4 * e + 1] = y;
      increment[4 * e + 2] = z;
      u[4 * e] += x;
      u[4 * e + 1] += y;
      u[4 * e + 2] += z;
      for ({int} k = first_constraint[e]; k < first_constraint[e + 1]; k++) {{
        {const_int} m = next + angles[k];
        {const_real} d = shares[4 * k] * steps[m] + shares[4 * k + 1] * steps[m + 1] +
                         shares[4 * k + 2] * steps[m + 2];
        increment[4 * e + components[k]] += d - u[4 * e + components[k]];
        u[4 * e + components[k]] = d;
      }}
    }}
)";

/// Written so that it holds for NaN, too; no det F of a sound element is near 1e30.
constexpr std::string_view ill_body = R"(    if (!(jacobian[e] > 0 && jacobian[e] < 1e30f)) {{
      ill[0] = 1;
    }}
)";

/// A body in which arrays are parts of those that kernels share: `u[k]` becomes `results[u_begin + k]`.
std::string with_shared_arrays(const NodeKernel& kernel, std::string body) {
  for (const auto& [name, kind, meaning] : kernel.arguments) {
    if (kind == NodeKernel::Kind::integer) continue;
    const std::string_view shared = kind == NodeKernel::Kind::indices ? "integers"
                                    : kind == NodeKernel::Kind::array ? "numbers"
                                                                      : "results";
    body = std::regex_replace(body, std::regex(fmt::format("\\b{}\\[", name)),
                              fmt::format("{}[{}_begin + ", shared, name));
  }
  return body;
}

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
  const bool shares = !dialect.shared.empty();
  const std::string real = std::is_same_v<Real, float> ? "float" : "double";
  const auto filled = [&](std::string_view format, const auto&... arguments) {
    return fmt::format(fmt::runtime(format), arguments...);
  };
  std::string text = fmt::format("// {}\n", kernel.meaning), begins;
  std::vector<std::string> arguments;
  for (const auto& [name, kind, meaning] : kernel.arguments) {
    const std::array<std::string_view, 4> formats{dialect.integer, dialect.indices, dialect.array,
                                                  dialect.results};
    const bool is_integer = kind == NodeKernel::Kind::integer;
    arguments.push_back(filled(shares ? dialect.integer : formats[static_cast<std::size_t>(kind)],
                               fmt::arg("real", real), fmt::arg("name", name)));
    begins += filled(dialect.begin_of, fmt::arg("name", name), fmt::arg("kernel", kernel.name),
                     fmt::arg("suffix", is_integer ? "" : "_begin"));
    text += fmt::format("//   {}: {}\n", name, meaning);
  }
  const auto component = [&](std::string_view mask, std::string_view a, std::string_view b) {
    return filled(dialect.select, fmt::arg("mask", mask), fmt::arg("a", a), fmt::arg("b", b));
  };
  const auto constant = [&](const std::string& type) {
    return dialect.constant.empty() ? "const " + type : std::string(dialect.constant);
  };
  const auto variable = [&](const std::string& type) {
    return dialect.variable.empty() ? type : std::string(dialect.variable);
  };
  const auto in_dialect = [&](std::string_view format, std::string_view sum) {
    return filled(format, fmt::arg("real", variable(real)), fmt::arg("int", variable("int")),
                  fmt::arg("const_real", constant(real)), fmt::arg("const_int", constant("int")),
                  fmt::arg("component", component("i == 0", "x", component("i == 1", "y", "z"))),
                  fmt::arg("sum", sum));
  };
  const std::string body = in_dialect(kernel.body, in_dialect(sum_of_elements, ""));
  return text +
         filled(shares ? dialect.kernel_of_nodes : dialect.kernel, fmt::arg("name", kernel.name),
                fmt::arg("begins", begins),
                fmt::arg("arguments", fmt::to_string(fmt::join(arguments, dialect.between)))) +
         (shares ? with_shared_arrays(kernel, body) : body) + std::string(dialect.end);
}

template <class Real>
std::string node_kernels_text(const Dialect& dialect) {
  std::string text(dialect.shared);
  for (const NodeKernel& kernel : node_kernels())
    text += (text.empty() ? "" : "\n") + node_kernel_text<Real>(kernel, dialect);
  return text;
}

template std::string node_kernels_text<double>(const Dialect&);
template std::string node_kernels_text<float>(const Dialect&);
template std::string node_kernel_text<double>(const NodeKernel&, const Dialect&);
template std::string node_kernel_text<float>(const NodeKernel&, const Dialect&);

}  // namespace sandglass
