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

/// Whether an option has a value behind its name; a flag and a positional argument have none.
bool takes_value(const CLI::Option& option);

/// What a command does, in one line; what follows it in its description is for its own help.
std::string summary_of(const CLI::App& command);

/// The layout of all help texts.
std::shared_ptr<CLI::FormatterBase> help_layout();

/// What is wrong with the arguments that `app` was given, for people: the command, the word and its rule, and
/// the nearest command or option where a name is not known.
std::string usage_error(const CLI::App* app, const CLI::Error& error);

}  // namespace sandglass
