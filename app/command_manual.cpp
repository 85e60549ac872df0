#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/build_info.hpp"
#include "app/commands.hpp"
#include "app/usage.hpp"

namespace sandglass {

namespace {

/// A text escaped for roff, so that nothing in it acts as a command.
std::string escaped(std::string_view text) {
  std::string roff;
  for (const char c : text) {
    const bool at_start = roff.empty() || roff.back() == '\n';
    if (at_start && (c == '.' || c == '\'')) roff += "\\&";
    if (c == '\\') {
      roff += "\\e";
    } else if (c == '-' || c == '\'' || c == '`' || c == '^' || c == '~') {
      roff += c == '-' ? "\\-" : c == '\'' ? "\\(aq" : c == '`' ? "\\(ga" : c == '^' ? "\\(ha" : "\\(ti";
    } else {
      roff += c;
    }
  }
  return roff;
}

/// An option or argument as a paragraph with its names as its tag.
std::string paragraph(const CLI::Option& option) {
  std::vector<std::string> names = names_of(option);
  if (names.empty()) names.push_back(option.get_name(true));
  for (auto& name : names) name = "\\fB" + escaped(name) + "\\fR";
  std::string value;
  if (takes_value(option)) {
    value = fmt::format(" \\fI{}\\fR", escaped(option.get_type_name()));
    if (option.get_expected_max() == CLI::detail::expected_max_vector_size) value += " ...";
  }
  const std::string usual = option.get_default_str();
  return fmt::format(".TP\n{}{}\n{}{}\n", fmt::join(names, ", "), value, escaped(option.get_description()),
                     usual.empty() ? "" : fmt::format("; default: {}", escaped(usual)));
}

std::string usage_of(const CLI::App& command) {
  std::string usage = "sandglass " + command.get_name() + " [OPTION]...";
  for (const CLI::Option* option :
       command.get_options([](const CLI::Option* o) { return o->get_positional(); })) {
    const bool required = option->get_required();
    usage += fmt::format(" {}{}{}", required ? "" : "[", option->get_name(true), required ? "" : "]");
  }
  return usage;
}

std::string section(const CLI::App& command) {
  std::string text =
      fmt::format(".SS {}\n{}\n", escaped(usage_of(command)), escaped(command.get_description()));
  for (const CLI::Option* option : command.get_options()) {
    if (option != command.get_help_ptr()) text += paragraph(*option);
  }
  return text;
}

/// The manual page of a program, in roff for man.
std::string manual(const CLI::App& app) {
  std::string text = fmt::format(
      ".TH SANDGLASS 1 \"\" \"sandglass {}\" \"User Commands\"\n"
      ".SH NAME\nsandglass \\- {}\n"
      ".SH SYNOPSIS\n\\fBsandglass\\fR \\fICOMMAND\\fR [\\fIOPTION\\fR]... [\\fIARGUMENT\\fR]...\n.SH "
      "OPTIONS\n",
      build_info::version, escaped(summary_of(app)));
  for (const CLI::Option* option : app.get_options()) text += paragraph(*option);
  text += ".SH COMMANDS\n";
  for (const CLI::App* command : app.get_subcommands({})) text += section(*command);
  return text + fmt::format(".SH EXIT STATUS\n{}\n", escaped(app.get_footer()));
}

}  // namespace

void add_manual_command(CLI::App& app) {
  app.add_subcommand("manual", "print the manual page: sandglass manual | man -l -")->callback([&app] {
    fmt::print("{}", manual(app));
  });
}

}  // namespace sandglass
