#pragma once

#include <string_view>
#include <vector>

namespace sandglass {

/// A language in which kernels are written. Its texts are templates, in which {real} and {bits} are the types
/// of numbers and of their bits, and {local} is what a function for use in the file alone begins with. The
/// defaults are those of C and its descendants.
struct Dialect {
  std::string_view name;
  std::string_view language;
  std::string_view bits_of_double;  ///< an integer as wide as a number; empty: there are no such numbers
  std::string_view bits_of_float;
  std::string_view local = {};
  std::string_view begin = {};  ///< of the file, after its comment
  std::string_view abs = "fabs";

  std::string_view bits =  ///< the functions bits_of and of_bits
      "{local}{bits} bits_of({real} x) {{\n  union {{\n    {real} number;\n    {bits} bits;\n  }} both;\n"
      "  both.number = x;\n  return both.bits;\n}}\n\n"
      "{local}{real} of_bits({bits} n) {{\n  union {{\n    {real} number;\n    {bits} bits;\n  }} both;\n"
      "  both.bits = n;\n  return both.number;\n}}\n";
  std::string_view function = "{local}{real} {name}({arguments})";  ///< the head of a function
  std::string_view argument = "{real} {name}";                      ///< a number among its arguments
  std::string_view value = "const {real} {name} = {value};";        ///< the definition of a number
  std::string_view mask = "const int {name} = {value};";            ///< the same of a comparison
  std::string_view select = "({mask} ? {a} : {b})";

  std::string_view array;                   ///< an argument of the kernel, which it reads; {number} of them
  std::string_view results;                 ///< the same, which it sets
  std::string_view indices;                 ///< the same of integers, which it reads
  std::string_view between = ", ";          ///< two of them
  std::string_view integer = "int {name}";  ///< the same of one integer
  std::string_view kernel;                  ///< from the head of the kernel to the loop over elements e
  bool keeps_sums = true;                   ///< whether its compilers keep the order of sums
  std::string_view entry = "{name}[{k} * count + e]";  ///< number k of element e in an array
  std::string_view end = "  }\n}\n";                   ///< of the kernel

  // In kernels of nodes, where a language allows a kernel few arrays, theirs are parts of three.
  std::string_view shared = {};           ///< the three, `integers`, `numbers` and `results`; empty: no limit
  std::string_view kernel_of_nodes = {};  ///< the head of such a kernel
  std::string_view begin_of = {};         ///< where the part {name} begins, or the integer {name}
  std::string_view constant = {};         ///< begins the definition of a number; empty: const and its type
  std::string_view variable = {};         ///< the same of one that changes; empty: its type
};

/// The list of dialects. A new one is an entry.
const std::vector<Dialect>& dialects();

/// The dialect of this name. Throws InputError, which lists all.
const Dialect& dialect_named(std::string_view name);

}  // namespace sandglass
