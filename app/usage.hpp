#pragma once

#include <CLI/App.hpp>
#include <memory>
#include <string>
#include <vector>

namespace sandglass {

/// The names of all commands, in the order of the help.
std::vector<std::string> command_names(const CLI::App& app);

/// All names of an option with their dashes: "-m", "--method". A positional one has none.
std::vector<std::string> names_of(const CLI::Option& option);

/// Whether a value follows the option's name; none follows a flag or a positional argument.
bool takes_value(const CLI::Option& option);

/// The first line of a command's description; only its own help shows the rest.
std::string summary_of(const CLI::App& command);

/// The layout of all help texts.
std::shared_ptr<CLI::FormatterBase> help_layout();

/// An error message about the arguments of `app`: the command, the word and its rule, and the closest command
/// or option if a name is unknown.
std::string usage_error(const CLI::App* app, const CLI::Error& error);

}  // namespace sandglass
