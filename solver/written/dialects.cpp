#include "written/dialects.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/error.hpp"

namespace sandglass {

const std::vector<Dialect>& dialects() {
  static const std::vector<Dialect> list{
      {.name = "c",
       .language = "C99",
       .bits_of_double = "long long",
       .bits_of_float = "int",
       .local = "static inline ",
       .begin = "#include <tgmath.h>\n\n",
       .array = "const {real}* restrict {name}",
       .results = "{real}* restrict {name}",
       .indices = "const int* restrict {name}",
       .kernel = "void {name}(long count, {arguments}) {{\n  for (long e = 0; e < count; ++e) {{\n"},
      {.name = "opencl",
       .language = "OpenCL C",
       .bits_of_double = "long",
       .bits_of_float = "int",
       .array = "__global const {real}* restrict {name}",
       .results = "__global {real}* restrict {name}",
       .indices = "__global const int* restrict {name}",
       .kernel = "__kernel void {name}(long count, {arguments}) {{\n  const long e = get_global_id(0);\n"
                 "  if (e < count) {{\n"},
      {.name = "cuda",
       .language = "CUDA C++",
       .bits_of_double = "long long",
       .bits_of_float = "int",
       .local = "__device__ ",
       .array = "const {real}* __restrict__ {name}",
       .results = "{real}* __restrict__ {name}",
       .indices = "const int* __restrict__ {name}",
       .kernel = "extern \"C\" __global__ void {name}(long long count, {arguments}) {{\n"
                 "  const long long e = blockIdx.x * (long long)blockDim.x + threadIdx.x;\n"
                 "  if (e < count) {{\n"},
      {.name = "wgsl",
       .language = "WGSL",
       .bits_of_double = "",
       .bits_of_float = "i32",
       .abs = "abs",
       .bits = "fn bits_of(x: f32) -> i32 {{\n  return bitcast<i32>(x);\n}}\n\n"
               "fn of_bits(n: i32) -> f32 {{\n  return bitcast<f32>(n);\n}}\n",
       .function = "fn {name}({arguments}) -> f32",
       .argument = "{name}: f32",
       .value = "let {name} = {value};",
       .mask = "let {name} = {value};",
       .select = "select({b}, {a}, {mask})",
       .array = "@group(0) @binding({number}) var<storage, read> {name}: array<f32>;\n",
       .results = "@group(0) @binding({number}) var<storage, read_write> {name}: array<f32>;\n",
       .indices = "@group(0) @binding({number}) var<storage, read> {name}: array<i32>;\n",
       .between = "",
       .integer = "  {name}: i32,\n",
       .kernel = "{arguments}\n@compute @workgroup_size(64) fn {name}(@builtin(global_invocation_id) id: "
                 "vec3u) {{\n  let count = arrayLength(&f) / 24;\n  let e = id.x;\n  if (e < count) {{\n",
       .keeps_sums = false,
       .shared = "@group(0) @binding(1) var<storage, read> integers: array<i32>;\n"
                 "@group(0) @binding(2) var<storage, read> numbers: array<f32>;\n"
                 "@group(0) @binding(3) var<storage, read_write> results: array<f32>;\n",
       .kernel_of_nodes =
           "struct {name}_input {{\n  count: i32,\n{arguments}}}\n"
           "@group(0) @binding(0) var<uniform> {name}_is: {name}_input;\n\n"
           "@compute @workgroup_size(64) fn {name}(@builtin(global_invocation_id) id: vec3u) {{\n"
           "  let e = i32(id.x);\n{begins}  if (e < {name}_is.count) {{\n",
       .begin_of = "  let {name}{suffix} = {kernel}_is.{name};\n",
       .constant = "let",
       .variable = "var"}};
  return list;
}

const Dialect& dialect_named(std::string_view name) {
  const auto found = std::ranges::find(dialects(), name, &Dialect::name);
  if (found != dialects().end()) return *found;
  std::vector<std::string_view> known;
  for (const Dialect& dialect : dialects()) known.push_back(dialect.name);
  throw InputError(fmt::format("--dialect = '{}' is not known; allowed: {}", name, fmt::join(known, ", ")));
}

}  // namespace sandglass
