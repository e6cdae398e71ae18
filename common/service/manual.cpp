#include "common/service/manual.h"

#include <algorithm>
#include <cctype>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/base/version.h"

namespace chorus::service {
namespace {

using Options = std::vector<const CLI::Option*>;
using Commands = std::vector<const CLI::App*>;

/// Escapes text for roff, so that no line becomes a request and no minus sign a hyphen.
std::string roff(std::string_view text) {
  std::string out;
  bool begins = true;
  for (const char c : text) {
    if (begins && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      out += c;
    }
    begins = c == '\n';
  }
  return out;
}

/// Allows a line break after each comma of a list of choices.
std::string breakable(const std::string& list) {
  std::string out;
  for (const char c : list) {
    out += c;
    if (c == ',') out += "\\:";
  }
  return out;
}

std::string first_line(std::string_view text) {
  return std::string(text.substr(0, text.find('\n')));
}

Options shown_options(const CLI::App& app) {
  return app.get_options([](const CLI::Option* option) { return !option->get_group().empty(); });
}

Commands commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

/// How an option is spelt: "-h,--help", "--config TEXT" or, for an argument, its name.
std::string spelling(const CLI::Option& option) {
  std::string out = "\\fB" + roff(option.get_name(option.get_positional(), true)) + "\\fR";
  if (option.get_items_expected_max() > 0 && !option.get_type_name().empty())
    out += " \\fI" + breakable(roff(option.get_type_name())) + "\\fR";
  return out;
}

std::string options_of(const CLI::App& app) {
  std::string out;
  for (const CLI::Option* option : shown_options(app)) {
    out += ".TP\n" + spelling(*option) + "\n" + roff(option->get_description()) + "\n";
  }
  return out;
}

/// Text whose line breaks are kept; examples would be unreadable if roff filled them.
std::string as_it_is(std::string_view text) {
  return text.empty() ? "" : ".PP\n.nf\n" + roff(text) + "\n.fi\n";
}

/// The commands of a program, and their subcommands.
std::string commands_text(const CLI::App& app, const std::string& name) {
  std::string out;
  for (const CLI::App* command : commands_of(app)) {
    const std::string whole = name + " " + command->get_name();
    out += ".SS \"" + roff(whole) + "\"\n" + roff(command->get_description()) + "\n" +
           options_of(*command) + as_it_is(command->get_footer()) + commands_text(*command, whole);
  }
  return out;
}

std::string files_text(std::string_view files) {
  std::string out;
  while (!files.empty()) {
    const std::string line = first_line(files);
    files.remove_prefix(std::min(files.size(), line.size() + 1));
    const std::size_t space = std::min(line.find(' '), line.size());
    out += ".TP\n.I " + roff(line.substr(0, space)) + "\n" +
           roff(line.substr(std::min(space + 1, line.size()))) + "\n";
  }
  return out.empty() ? out : ".SH FILES\n" + out;
}

/// Words for compgen: the long names of all options.
std::string words_of(const CLI::App& app) {
  std::string out;
  for (const CLI::Option* option : shown_options(app)) {
    for (const std::string& name : option->get_lnames()) out += " --" + name;
  }
  return out;
}

/// words_of() a command, then for each of its own commands its name and its words.
std::string all_words_of(const CLI::App& command) {
  std::string out = words_of(command);
  for (const CLI::App* below : commands_of(command))
    out += " " + below->get_name() + all_words_of(*below);
  return out;
}

}  // namespace

std::string manual_page(const CLI::App& app, const Manual& manual) {
  const std::string name = app.get_name();
  std::string title = name;
  std::transform(title.begin(), title.end(), title.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  std::string about = app.get_description();
  if (about.starts_with(name + ": ")) about.erase(0, name.size() + 2);
  const std::string commands = commands_text(app, name);
  return ".TH " + roff(title) + " " + std::to_string(manual.section) + " \"\" \"chorus " +
         std::string(version()) + "\" \"Chorus\"\n.SH NAME\n" + roff(name) + " \\- " +
         roff(first_line(about)) + "\n.SH SYNOPSIS\n.B " + roff(name) + "\n" +
         (commands.empty() ? "[OPTIONS]" : "COMMAND [OPTIONS]") + "\n.SH DESCRIPTION\n" +
         roff(about) + "\n.SH OPTIONS\n" + options_of(app) +
         (commands.empty() ? "" : ".SH COMMANDS\n" + commands) + files_text(manual.files) +
         ".SH NOTES\n" + as_it_is(app.get_footer());
}

std::string bash_completion(const CLI::App& app) {
  const std::string name = app.get_name();
  std::string function = "_" + name;
  std::replace(function.begin(), function.end(), '-', '_');
  std::string cases;
  std::string all = words_of(app);
  for (const CLI::App* command : commands_of(app)) {
    cases += "    " + command->get_name() + ") words='" + all_words_of(*command) + "' ;;\n";
    all += " " + command->get_name();
  }
  return "# bash completion of " + name + ", made from its options.\n" + function +
         "() {\n"
         "  local current=${COMP_WORDS[COMP_CWORD]} command='' word words\n"
         "  for word in \"${COMP_WORDS[@]:1:COMP_CWORD-1}\"; do\n"
         "    [[ $word == -* ]] || { command=$word; break; }\n"
         "  done\n"
         "  case $command in\n" +
         cases + "    *) words='" + all +
         "' ;;\n"
         "  esac\n"
         "  COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
         "}\n"
         "complete -o default -F " +
         function + " " + name + "\n";
}

std::optional<std::string> printed(const CLI::App& app, const Manual& manual, int argc,
                                   const char* const* argv) {
  constexpr int kWords = 3;
  if (argc != kWords || std::string_view(argv[1]) != "--print") return std::nullopt;
  const std::string_view what = argv[2];
  if (what == "manual") return manual_page(app, manual);
  if (what == "completion") return bash_completion(app);
  return std::nullopt;
}

}  // namespace chorus::service
