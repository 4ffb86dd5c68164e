// splatcut describe man|bash: the manual page and the completion of bash, from the same table of options that
// is parsed, so that neither can be behind. The build runs it.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <memory>
#include <sstream>

#include "app/cli/commands.h"
#include "app/console/version.h"

namespace splatcut {

namespace {

std::vector<const CLI::App*> shown_commands(const CLI::App& program) {
  return program.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

// --help, which all have, is the program's alone.
std::vector<const CLI::Option*> shown_options(const CLI::App& command) {
  return command.get_options([&](const CLI::Option* option) {
    return !option->get_group().empty() && (option != command.get_help_ptr() || !command.get_parent());
  });
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

// ---- The manual page: troff with the macros of man(7).

// A line that troff prints as it stands.
std::string plain(const std::string& line) {
  std::string text;
  for (const char c : line) {
    if (c == '\\')
      text += "\\e";
    else if (c == '-')
      text += "\\-";  // else a hyphen, which cannot be copied into a shell
    else
      text += c;
  }
  const bool command = text.starts_with('.') || text.starts_with('\'');
  return command ? "\\&" + text : text;
}

std::string tagged(const std::string& tag, const std::string& text) {
  return fmt::format(".TP\n.B {}\n{}\n", plain(tag), plain(text));
}

// "--renderer {auto,gl,cpu}", "--click TEXT ...", "scene"
std::string usage_of(const CLI::Option& option) {
  if (option.get_positional()) return option.get_name(true);
  std::string names;
  for (const std::string& name : option.get_snames()) names += (names.empty() ? "-" : ", -") + name;
  for (const std::string& name : option.get_lnames()) names += (names.empty() ? "--" : ", --") + name;
  if (option.get_items_expected_max() == 0) return names;
  // CLI11 says "TEXT:{ply,rub}": of a check, what may be given is enough.
  const std::string type = option.get_type_name();
  return names + " " + type.substr(type.find(':') + 1) + (option.get_expected_max() > 1 ? " ..." : "");
}

std::string options_section(const CLI::App& command) {
  std::string text;
  for (const CLI::Option* option : shown_options(command))
    text +=
        tagged(usage_of(*option), option->get_description() + (option->get_required() ? " (required)" : ""));
  return text;
}

// Of footers: "  name   what it is" is a row of a table, any other line a paragraph.
std::string footer_section(const CLI::App& command) {
  const CLI::App* parent = command.get_parent();
  if (parent && command.get_footer() == parent->get_footer()) return {};  // handed down by CLI11
  std::string text;
  for (const std::string& line : lines_of(command.get_footer())) {
    const std::size_t gap = line.find("  ", 2);
    const bool row = line.starts_with("  ") && gap != std::string::npos;
    if (row)
      text += tagged(line.substr(2, gap - 2), line.substr(line.find_first_not_of(' ', gap)));
    else if (!line.empty())
      text += ".PP\n" + plain(line) + "\n";
  }
  return text;
}

std::string manual_page(const CLI::App& program) {
  const std::string& name = program.get_name();
  std::string text = fmt::format(".TH {} 1 \"\" \"{} {}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n", name,
                                 name, version(), name, plain(program.get_description()));
  text += fmt::format(".SH SYNOPSIS\n.B {0}\n.RI [ scene ]\n", name);
  for (const CLI::App* command : shown_commands(program))
    text += fmt::format(".br\n.B {} {}\n.RI [ options ]\n", name, command->get_name());
  text += ".SH DESCRIPTION\nWithout a command the window opens, with\n.I scene\nwhere it is given.\n";
  text += footer_section(program);
  text += ".SH OPTIONS OF EVERY COMMAND\n" + options_section(program);
  for (const CLI::App* command : shown_commands(program)) {
    text += fmt::format(".SH \"{} {}\"\n{}.\n", name, command->get_name(), plain(command->get_description()));
    text += options_section(*command) + footer_section(*command);
  }
  text += ".SH EXIT STATUS\n" + tagged("0", "Done.") +
          tagged("1", "Could not: a sentence on standard error says why.") + tagged("2", "Wrong usage.");
  text +=
      ".SH FILES\n" + tagged("~/.config/splatcut (XDG_CONFIG_HOME)", "Settings of the window.") +
      tagged("~/.local/state/splatcut (XDG_STATE_HOME)", "Work of a window that did not end well.") +
      tagged("~/.cache/splatcut (XDG_CACHE_HOME)", "What is prepared of scenes; can be removed at any time.");
  return text;
}

// ---- The completion of bash.

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

std::vector<std::string> dashed_names(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

std::string all_dashed_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : shown_options(command))
    for (const std::string& name : dashed_names(*option)) names.push_back(name);
  return joined(names);
}

// Of an option that takes one of a few words; empty for others.
std::string choices_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t open = type.find('{'), close = type.find('}');
  if (option.get_items_expected_max() == 0 || open == std::string::npos || close == std::string::npos)
    return {};
  std::string words = type.substr(open + 1, close - open - 1);
  std::ranges::replace(words, ',', ' ');
  return words;
}

// A line of a case of bash, as are the lines below.
std::string if_matches(const std::string& pattern, const std::string& words) {
  return fmt::format("    \"{}\") words=\"{}\" ;;\n", pattern, words);
}

std::string choices_lines(const CLI::App& command) {
  std::string lines;
  for (const CLI::Option* option : shown_options(command))
    if (const std::string words = choices_of(*option); !words.empty())
      for (const std::string& name : dashed_names(*option))
        lines += if_matches(command.get_name() + " " + name, words);
  return lines;
}

std::string bash_completion(const CLI::App& program) {
  std::vector<std::string> commands;
  const std::string of_all = all_dashed_names(program);
  std::string options = if_matches("", of_all), choices;
  for (const CLI::App* command : shown_commands(program)) {
    commands.push_back(command->get_name());
    options += if_matches(command->get_name(), all_dashed_names(*command) + " " + of_all);
    choices += choices_lines(*command);
  }
  std::string alternatives = joined(commands);
  std::ranges::replace(alternatives, ' ', '|');
  return fmt::format(
      R"bash(# What is not an option, a command or one of a few words is a file: bash completes that itself.
_{0}() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} command= word words=
  if [[ $current == = ]]; then
    current=
  elif [[ $before == = ]]; then
    before=${{COMP_WORDS[COMP_CWORD - 2]}}
  fi
  if [[ $COMP_CWORD -gt 1 ]]; then command=view; fi  # also of a scene without a command
  for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
    case $word in {1}) command=$word; break ;; esac
  done
  case "$command $before" in
{2}  esac
  if [[ -z $words && $current == -* ]]; then
    case "$command" in
{3}    esac
  elif [[ -z $words && -z $command ]]; then
    words="{4}"
  fi
  COMPREPLY=($(compgen -W "$words" -- "$current"))
}}
complete -o default -F _{0} {0}
)bash",
      program.get_name(), alternatives, choices, options, joined(commands));
}

}  // namespace

void add_describe_command(CLI::App& program, const CommonOptions&) {
  auto what = std::make_shared<std::string>();
  CLI::App& command = *program.add_subcommand("describe", "Write the manual page or the completion of bash");
  command.group("");
  command.add_option("what", *what, "man or bash")->required()->check(CLI::IsMember({"man", "bash"}));
  command.callback([what, &program] {
    fmt::print("{}", *what == "man" ? manual_page(program) : bash_completion(program));
  });
}

}  // namespace splatcut
