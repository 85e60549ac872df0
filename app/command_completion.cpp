#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>

#include "app/commands.hpp"
#include "app/usage.hpp"
#include "assembly/method_entry.hpp"
#include "commands/workspace.hpp"

namespace sandglass {

namespace {

/// The possible values of an option or argument, in bash; empty for a number or a file.
std::string words_of(const CLI::Option& option) {
  const std::string type = option.get_positional() ? option.get_name(true) : option.get_type_name();
  if (type == "METHOD") return "$methods";
  if (type == "CASE") return "$cases";
  const std::string allowed = option.get_type_name();  // "TEXT:{golden,truth}"
  const std::size_t open = allowed.find('{'), close = allowed.find('}');
  if (open == std::string::npos || close == std::string::npos) return "";
  std::string words = allowed.substr(open + 1, close - open - 1);
  std::replace(words.begin(), words.end(), ',', ' ');
  return words;
}

/// The words that may follow in a command, after an option with a value and elsewhere.
std::string branch(const CLI::App& command) {
  std::string text = fmt::format("    {})\n      case $previous in\n", command.get_name());
  std::vector<std::string> anywhere, several;
  for (const CLI::Option* option : command.get_options()) {
    const auto names = names_of(*option);
    const std::string words = words_of(*option);
    anywhere.insert(anywhere.end(), names.begin(), names.end());
    if (names.empty()) anywhere.push_back(words);
    if (!takes_value(*option)) continue;
    text += fmt::format("        {}) words=\"{}\" ;;\n", fmt::join(names, " | "), words);
    const bool takes_several = option->get_expected_max() == CLI::detail::expected_max_vector_size;
    if (takes_several && !words.empty()) several.push_back(words);
  }
  anywhere.insert(anywhere.end(), several.begin(), several.end());
  return text + fmt::format("        *) words=\"{}\" ;;\n      esac ;;\n", fmt::join(anywhere, " "));
}

/// A bash script that completes commands, options and the names of methods and cases; file names if none of
/// them fits.
std::string bash_completion(const CLI::App& app) {
  std::vector<std::string> cases, options;
  for (const auto& file : canonical_files()) cases.push_back(file.stem().string());
  for (const CLI::Option* option : app.get_options()) {
    for (auto& name : names_of(*option)) options.push_back(std::move(name));
  }
  std::string text = fmt::format(
      R"(# Completion of sandglass for bash, printed by `sandglass completion bash`.
_sandglass() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}} words
  local methods="{}"
  local cases="{}"
  # --option=value is three words.
  if [[ $current == "=" ]]; then current=; fi
  if [[ $previous == "=" ]]; then previous=${{COMP_WORDS[COMP_CWORD - 2]}}; fi
  if ((COMP_CWORD == 1)); then
    COMPREPLY=($(compgen -W "{} {}" -- "$current"))
    return
  fi
  case ${{COMP_WORDS[1]}} in
)",
      fmt::join(method_names(), " "), fmt::join(cases, " "), fmt::join(command_names(app), " "),
      fmt::join(options, " "));
  for (const CLI::App* command : app.get_subcommands({})) text += branch(*command);
  return text + R"(  esac
  COMPREPLY=($(compgen -W "$words" -- "$current"))
}
complete -o default -F _sandglass sandglass
)";
}

}  // namespace

void add_completion_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("completion",
                                         "print a script that completes commands, options and names.\n"
                                         "In bash: source <(sandglass completion bash)");
  auto shell = std::make_shared<std::string>();
  command->add_option("SHELL", *shell, "the shell")->check(CLI::IsMember({"bash"}))->required();
  command->callback([shell, &app] { fmt::print("{}", bash_completion(app)); });
}

}  // namespace sandglass
