#include "forces/formula.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <numbers>

#include "base/error.hpp"

namespace sandglass {

namespace {

using Function = double (*)(double);

const std::map<std::string, Function>& functions() {
  static const std::map<std::string, Function> known{
      {"abs", std::abs},   {"acos", std::acos}, {"asin", std::asin}, {"atan", std::atan}, {"cos", std::cos},
      {"cosh", std::cosh}, {"exp", std::exp},   {"log", std::log},   {"sin", std::sin},   {"sinh", std::sinh},
      {"sqrt", std::sqrt}, {"tan", std::tan},   {"tanh", std::tanh}};
  return known;
}

double smallest(const double* values, int count) {
  return *std::min_element(values, values + count);
}

double largest(const double* values, int count) {
  return *std::max_element(values, values + count);
}

/// A parser of the language, with its variable.
struct Parser {
  std::string text;
  double t = 0.0;
  mu::Parser parser = {};
  std::mutex one_at_a_time = {};

  /// The library's own language is larger than ours, which Python must read alike.
  explicit Parser(const std::string& written) : text(written) {
    parser.ClearFun();
    parser.ClearConst();
    parser.ClearOprt();
    parser.ClearInfixOprt();
    parser.ClearPostfixOprt();
    parser.EnableBuiltInOprt(false);
    parser.DefineVar("t", &t);
    parser.DefineConst("pi", std::numbers::pi);
    parser.DefineConst("e", std::numbers::e);
    for (const auto& [name, function] : functions()) parser.DefineFun(name, function);
    parser.DefineFun("min", smallest);
    parser.DefineFun("max", largest);
    parser.DefineInfixOprt("-", [](double a) { return -a; });
    parser.DefineInfixOprt("+", [](double a) { return a; });
    parser.DefineOprt(
        "+", [](double a, double b) { return a + b; }, mu::prADD_SUB);
    parser.DefineOprt(
        "-", [](double a, double b) { return a - b; }, mu::prADD_SUB);
    parser.DefineOprt(
        "*", [](double a, double b) { return a * b; }, mu::prMUL_DIV);
    parser.DefineOprt(
        "/", [](double a, double b) { return a / b; }, mu::prMUL_DIV);
    parser.DefineOprt(
        "^", [](double a, double b) { return std::pow(a, b); }, mu::prPOW, mu::oaRIGHT);
    parser.SetExpr(text);
  }

  double at(double time) {
    const std::lock_guard lock(one_at_a_time);
    t = time;
    return parser.Eval();
  }
};

}  // namespace

std::string formula_language() {
  std::string names;
  for (const auto& [name, function] : functions()) names += name + ", ";
  return "a formula may contain the time t, numbers, + - * / ^, parentheses, pi, e and the functions " +
         names + "max, min";
}

std::function<double(double)> parse_formula(const std::string& text, const std::string& name) {
  const std::string given = fmt::format("{} = '{}'", name, text);
  const auto refuse = [&](const std::string& what, std::size_t position) {
    throw InputError(fmt::format("{}: {} at position {}; {}", given, what, position + 1, formula_language()));
  };
  const std::size_t power = text.find("**");
  if (power != std::string::npos) refuse("a power is written ^, not '**'", power);
  const std::size_t strange =
      text.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.+-*/^(), ");
  if (strange != std::string::npos) refuse(fmt::format("'{}'", text[strange]), strange);
  const auto formula = std::make_shared<Parser>(text);
  const auto value_at = [formula, given](double time) {
    const double value = formula->at(time);
    if (std::isfinite(value)) return value;
    throw InputError(fmt::format("{} is {} at t = {}; it must be finite", given,
                                 std::isnan(value) ? "not a number" : "infinite", time));
  };
  try {
    value_at(0.0);
  } catch (const mu::Parser::exception_type& error) {
    if (error.GetCode() == mu::ecEMPTY_EXPRESSION) refuse("nothing", 0);
    if (error.GetCode() == mu::ecMISSING_PARENS) refuse("a missing ')'", text.size());
    if (error.GetCode() == mu::ecUNEXPECTED_EOF) refuse("an unexpected end", text.size());
    if (error.GetCode() == mu::ecTOO_FEW_PARAMS || error.GetCode() == mu::ecTOO_MANY_PARAMS)
      refuse(fmt::format("a wrong number of arguments for '{}'", error.GetToken()),
             text.find(error.GetToken()));
    refuse(fmt::format("wrong '{}'", error.GetToken()), static_cast<std::size_t>(error.GetPos()));
  }
  if (formula->parser.GetNumResults() != 1) refuse("a ',' outside of a function", text.find(','));
  return value_at;
}

}  // namespace sandglass
