#include "app/usage.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/Formatter.hpp>
#include <algorithm>

#include "app/wrapped_text.hpp"
#include "base/names.hpp"

namespace sandglass {

namespace {

/// Breaks descriptions into lines, and shows only the first line of subcommands.
class HelpLayout final : public CLI::Formatter {
 public:
  std::string make_option_desc(const CLI::Option* option) const override {
    return wrapped(option->get_description(), 0, columns_of_text - get_column_width());
  }
  std::string make_description(const CLI::App* app) const override {
    std::string text = app->get_description();
    const std::size_t first = std::min(text.find('\n'), text.size() - 1);
    std::replace(text.begin() + static_cast<std::ptrdiff_t>(first) + 1, text.end(), '\n', ' ');
    return wrapped(text, 0) + "\n";
  }
  std::string make_subcommand(const CLI::App* command) const override {
    return fmt::format("  {:<{}}{}\n", command->get_name(), get_column_width() - 2,
                       wrapped(summary_of(*command), get_column_width()));
  }
};

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (auto& name : names_of(*option)) names.push_back(std::move(name));
  }
  return names;
}

/// What is wrong with a word that no command or option accepts.
std::string unexpected(const CLI::App& command, const std::string& word) {
  if (word.size() > 1 && word.front() == '-') {
    const std::string name = word.substr(0, word.find('='));
    return fmt::format("'{}' is not an option{}", name, did_you_mean(name, option_names(command)));
  }
  if (command.get_parent() == nullptr) {
    return fmt::format("'{}' is not a command; {}", word, suggestion(word, command_names(command)));
  }
  return fmt::format("'{}' is one argument too many", word);
}

/// What is wrong with a value of the wrong type, from the parser's message "Could not convert: --threads =
/// x"; any other message is returned unchanged.
std::string not_converted(const CLI::App& command, const std::string& message) {
  const std::size_t name = message.find(": "), value = message.find(" = ");
  if (name == std::string::npos || value == std::string::npos) return message;
  const std::string text = message.substr(value + 3);
  const CLI::Option* option = command.get_option_no_throw(message.substr(name + 2, value - name - 2));
  const bool whole = option != nullptr && option->get_type_name().starts_with("INT");
  return fmt::format("{} must be {}{}", message.substr(name + 2), whole ? "an integer" : "a number",
                     whole ? "" : decimal_comma_hint(text));
}

}  // namespace

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const auto& name : option.get_snames()) names.push_back("-" + name);
  for (const auto& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

bool takes_value(const CLI::Option& option) {
  return !option.get_positional() && option.get_expected_max() > 0;
}

std::string summary_of(const CLI::App& command) {
  const std::string text = command.get_description();
  const std::string first = text.substr(0, text.find('\n'));
  return first.ends_with('.') && !first.ends_with("..") ? first.substr(0, first.size() - 1) : first;
}

std::shared_ptr<CLI::FormatterBase> help_layout() {
  return std::make_shared<HelpLayout>();
}

std::string usage_error(const CLI::App* app, const CLI::Error& error) {
  const auto parsed = app->get_subcommands();
  const CLI::App& command = parsed.empty() ? *app : *parsed.front();
  std::string rule = error.what();
  // If something is missing, a misspelt word may be the reason.
  if (const auto words = command.remaining(); !words.empty()) {
    rule = unexpected(command, words.front());
  } else if (parsed.empty() && error.get_name() == "RequiredError") {
    rule = fmt::format("a command is missing; known: {}", fmt::join(command_names(*app), ", "));
  } else if (error.get_name() == "ConversionError") {
    rule = not_converted(command, rule);
  } else if (error.get_name() == "ArgumentMismatch" && rule.ends_with(" missing")) {
    rule = rule.substr(0, rule.find(':')) + " needs a value";
  }
  const std::string name = parsed.empty() ? "" : command.get_name();
  return fmt::format("error: {}{}\nsandglass {}{}--help lists what is allowed\n",
                     name.empty() ? "" : name + ": ", rule, name, name.empty() ? "" : " ");
}

}  // namespace sandglass
