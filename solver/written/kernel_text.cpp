#include "written/kernel_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace sandglass {

namespace {

/// A function that dialects lack: from operations on numbers, and from its bits where it has none.
struct Function {
  Operation operation;
  std::string_view name;
  std::vector<Operation> needs;  ///< functions of this list before it
};

const std::vector<Function>& functions() {
  using enum Operation;
  static const std::vector<Function> list{{max, "larger", {}},
                                          {min, "smaller", {}},
                                          {cube_root_guess, "inverse_cube_root_guess", {}},
                                          {power_of_two, "power_of_two", {}},
                                          {binary_exponent, "binary_exponent", {}},
                                          {inverse_cube_root, "inverse_cube_root", {cube_root_guess}},
                                          {expm1, "exponential_minus_one", {power_of_two}},
                                          {log1p, "logarithm_of_one_plus", {power_of_two, binary_exponent}}};
  return list;
}

const Function* function_of(Operation operation) {
  const auto& list = functions();
  const auto found = std::find_if(list.begin(), list.end(),
                                  [&](const Function& function) { return function.operation == operation; });
  return found == list.end() ? nullptr : &*found;
}

/// The program of a function without bits, recorded from the one in C++; none for the others.
template <class Real>
Program program_of(Operation operation) {
  Tape tape;
  const Recorded x = tape.input();
  switch (operation) {
    case Operation::max:
    case Operation::min: {
      const Recorded y = tape.input();
      return tape.program({operation == Operation::max ? select(x < y, y, x) : select(y < x, y, x)});
    }
    case Operation::inverse_cube_root:
      return tape.program({refined_inverse_cube_root(x, cube_root_guess(x))});
    case Operation::expm1:
      return tape.program({detail::exponential_minus_one<Real>(x)});
    case Operation::log1p:
      return tape.program({detail::logarithm_of_one_plus<Real>(x)});
    default:
      return {};
  }
}

/// Writes in a dialect and a precision.
template <class Real>
class Writer {
 public:
  Writer(const Dialect& dialect, NodalValues nodal_values)
      : dialect_(dialect), by_places_(nodal_values == NodalValues::of_nodes) {}

  std::string text(const ForceProgram& force, const KernelTitle& title) const {
    std::string text = comment(force, title) + std::string(dialect_.begin) + filled(dialect_.bits) + "\n";
    for (const Function& function : functions()) {
      if (uses(force.program, function.operation)) text += definition(function) + "\n";
    }
    std::vector<std::string> arguments, numbers;
    const auto add = [&](std::string_view format, std::string_view name) {
      arguments.push_back(filled(format, fmt::arg("name", name), fmt::arg("number", arguments.size())));
    };
    if (by_places_) add(dialect_.indices, "places");
    for (const KernelArray& array : force.arrays) {
      add(dialect_.array, array.name);
      for (int k = 0; k < array.numbers; ++k) numbers.push_back(fmt::format("{}{}", array.name, k));
    }
    add(dialect_.results, "f");
    text += filled(dialect_.kernel, fmt::arg("name", title.name),
                   fmt::arg("arguments", fmt::to_string(fmt::join(arguments, dialect_.between))));
    const std::string indent(4, ' ');
    std::vector<bool> is_read(numbers.size(), false);
    for (const Step& step : force.program.steps) {
      if (step.operation == Operation::input) is_read[static_cast<std::size_t>(step.of[0])] = true;
    }
    const int nodes = force.arrays.front().numbers / 3;
    for (int I = 0; by_places_ && I < nodes; ++I) {
      text += indent +
              filled(dialect_.mask, fmt::arg("name", fmt::format("place{}", I)),
                     fmt::arg("value", entry("places", I))) +
              "\n";
    }
    std::size_t input = 0;
    for (const KernelArray& array : force.arrays) {
      for (int k = 0; k < array.numbers; ++k) {
        if (!is_read[input++]) continue;
        const std::string number = by_places_ && array.is_nodal
                                       ? fmt::format("{}[place{} + {}]", array.name, k / 3, k % 3)
                                       : entry(array.name, k);
        text += indent + value(fmt::format("{}{}", array.name, k), number) + "\n";
      }
    }
    const auto results = statements(force.program, numbers, indent, text);
    for (std::size_t k = 0; k < results.size(); ++k) {
      text += fmt::format("{}{} = {};\n", indent, entry("f", static_cast<int>(k)), results[k]);
    }
    return text + std::string(dialect_.end);
  }

 private:
  static constexpr bool single = std::is_same_v<Real, float>;

  std::string comment(const ForceProgram& force, const KernelTitle& title) const {
    std::string text;
    for (const auto& line : title.comment) text += fmt::format("// {}\n", line);
    text += "// Arrays, with number k of element e at k * count + e:\n";
    for (const KernelArray& array : force.arrays) {
      text += fmt::format("//   {} ({} numbers): {}\n", array.name, array.numbers, array.meaning);
    }
    if (by_places_) {
      text += fmt::format(
          "//   places ({} numbers): component i of the element's node I is at places[I * count + e] + i "
          "of a nodal array\n",
          force.arrays.front().numbers / 3);
    }
    const auto count = [&](auto... operations) {
      return std::count_if(force.program.steps.begin(), force.program.steps.end(),
                           [&](const Step& step) { return ((step.operation == operations) || ...); });
    };
    using enum Operation;
    return text +
           fmt::format(
               "//   f ({} numbers): internal forces, N, in the order of u; set, not read\n"
               "// Per element {} additions and subtractions, {} multiplications, {} divisions, {} roots, "
               "exponentials and logarithms.\n\n",
               force.program.results.size(), count(add, subtract), count(multiply), count(divide),
               count(sqrt, inverse_cube_root, expm1, log1p));
  }

  template <class... Arguments>
  std::string filled(std::string_view format, const Arguments&... arguments) const {
    return fmt::format(fmt::runtime(format), fmt::arg("real", single ? "float" : "double"),
                       fmt::arg("bits", single ? dialect_.bits_of_float : dialect_.bits_of_double),
                       fmt::arg("local", dialect_.local), arguments...);
  }

  std::string value(std::string_view name, std::string_view value) const {
    return filled(dialect_.value, fmt::arg("name", name), fmt::arg("value", value));
  }
  std::string entry(std::string_view name, int k) const {
    return filled(dialect_.entry, fmt::arg("name", name), fmt::arg("k", k));
  }

  /// Languages differ in infinities, so that such numbers are given by their bits.
  static std::string literal(Real number) {
    if (!std::isfinite(number)) {
      return fmt::format("of_bits({})",
                         std::bit_cast<typename sandglass::detail::FloatBits<Real>::Integer>(number));
    }
    const std::string digits = fmt::format("{:#}{}", number, single ? "f" : "");
    return number < Real(0) ? "(" + digits + ")" : digits;
  }

  static bool uses(const Program& program, Operation wanted) {
    return std::any_of(program.steps.begin(), program.steps.end(), [&](const Step& step) {
      if (step.operation == wanted) return true;
      const Function* const function = function_of(step.operation);
      return function != nullptr && std::count(function->needs.begin(), function->needs.end(), wanted) > 0;
    });
  }

  std::string definition(const Function& function) const {
    const Program program = program_of<Real>(function.operation);
    std::vector<std::string> names{"x", "y"}, arguments;
    const bool two = function.operation == Operation::max || function.operation == Operation::min;
    for (std::size_t n = 0; n < (two ? 2 : 1); ++n) {
      arguments.push_back(filled(dialect_.argument, fmt::arg("name", names[n])));
    }
    std::string text = filled(dialect_.function, fmt::arg("name", function.name),
                              fmt::arg("arguments", fmt::to_string(fmt::join(arguments, ", ")))) +
                       " {\n";
    const std::string indent(2, ' ');
    const std::string result =
        program.results.empty() ? on_bits(function.operation) : statements(program, names, indent, text)[0];
    return text + fmt::format("{}return {};\n}}\n", indent, result);
  }

  /// As `inverse_cube_root`, `power_of_two` and `binary_exponent` of plain numbers.
  static std::string on_bits(Operation operation) {
    using Bits = sandglass::detail::FloatBits<Real>;
    using Guess = RootGuess<Real>;
    if (operation == Operation::cube_root_guess) {
      return fmt::format("of_bits(bits_of({} + {} * of_bits((bits_of(x) >> {}) | {})) << {})",
                         literal(Guess::start), literal(Guess::slope), Guess::shift, Guess::integers,
                         Guess::shift);
    }
    if (operation == Operation::power_of_two) {
      return fmt::format("of_bits(bits_of(x + {}) << {})",
                         literal(Real(1.5) * Bits::integers + Real(Bits::bias)), Bits::mantissa);
    }
    return fmt::format("of_bits((bits_of(x) >> {}) | {}) - {}", Bits::mantissa,
                       std::bit_cast<typename Bits::Integer>(Bits::integers),
                       literal(Bits::integers + Real(Bits::bias)));
  }

  /// The value of a step in terms of those before it.
  std::string expression(const Step& step, const std::vector<std::string>& known) const {
    const auto operand = [&](std::size_t n) { return known[static_cast<std::size_t>(step.of[n])]; };
    switch (step.operation) {
      case Operation::add:
        return operand(0) + " + " + operand(1);
      case Operation::subtract:
        return operand(0) + " - " + operand(1);
      case Operation::multiply:
        return operand(0) + " * " + operand(1);
      case Operation::divide:
        return operand(0) + " / " + operand(1);
      case Operation::less:
        return operand(0) + " < " + operand(1);
      case Operation::negate:
        return "-" + operand(0);
      case Operation::select:
        return filled(dialect_.select, fmt::arg("mask", operand(0)), fmt::arg("a", operand(1)),
                      fmt::arg("b", operand(2)));
      case Operation::abs:
        return fmt::format("{}({})", dialect_.abs, operand(0));
      case Operation::sqrt:
        return fmt::format("sqrt({})", operand(0));
      default: {
        const std::string second = step.of[1] < 0 ? "" : ", " + operand(1);
        return fmt::format("{}({}{})", function_of(step.operation)->name, operand(0), second);
      }
    }
  }

  /// Appends a program's statements to a text and returns its results. Values that are used once and short
  /// stand where they are used.
  std::vector<std::string> statements(const Program& program, const std::vector<std::string>& inputs,
                                      const std::string& indent, std::string& text) const {
    constexpr std::size_t longest = 60;
    std::vector<int> uses(program.steps.size(), 0);
    for (const Step& step : program.steps) {
      if (step.operation == Operation::input) continue;
      for (const int operand : step.of) {
        if (operand >= 0) ++uses[static_cast<std::size_t>(operand)];
      }
    }
    for (const int result : program.results) ++uses[static_cast<std::size_t>(result)];
    std::vector<std::string> known;
    int names = 0;
    for (std::size_t n = 0; n < program.steps.size(); ++n) {
      const Step& step = program.steps[n];
      if (step.operation == Operation::input) {
        known.push_back(inputs[static_cast<std::size_t>(step.of[0])]);
      } else if (step.operation == Operation::constant) {
        known.push_back(literal(step.value.as<Real>()));
      } else if (std::string here = expression(step, known); uses[n] == 1 && here.size() <= longest) {
        known.push_back("(" + std::move(here) + ")");
      } else {
        known.push_back(fmt::format("v{}", names++));
        const auto& format = step.operation == Operation::less ? dialect_.mask : dialect_.value;
        text += indent + filled(format, fmt::arg("name", known.back()), fmt::arg("value", here)) + "\n";
      }
    }
    std::vector<std::string> results;
    for (const int result : program.results) results.push_back(known[static_cast<std::size_t>(result)]);
    return results;
  }

  const Dialect& dialect_;
  bool by_places_;
};

}  // namespace

template <class Real>
std::string kernel_text(const ForceProgram& force, const Dialect& dialect, const KernelTitle& title,
                        NodalValues nodal_values) {
  return Writer<Real>(dialect, nodal_values).text(force, title);
}

template std::string kernel_text<double>(const ForceProgram&, const Dialect&, const KernelTitle&,
                                         NodalValues);
template std::string kernel_text<float>(const ForceProgram&, const Dialect&, const KernelTitle&, NodalValues);

}  // namespace sandglass
