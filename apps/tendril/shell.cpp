#include "shell.hpp"

#include <fmt/format.h>

#include <map>
#include <vector>

#include "console.hpp"
#include "init.hpp"
#include "tendril/io/keys.hpp"
#include "tendril/reproduce/system.hpp"

namespace tendril::app {
namespace {

/// What the positional argument of a command may be; a command that is not there takes files.
using Words = std::map<std::string, std::vector<std::string>>;

Words known_words() {
  Words words{{"init", starters()}, {"completion", {"bash", "zsh", "fish"}}, {"reproduce", {"all"}}};
  for (const auto& system : tendril::reproduce::systems()) words["reproduce"].push_back(system.name);
  for (const io::Key& key : io::keys()) words["explain"].push_back(key.path);
  return words;
}

std::vector<const CLI::App*> commands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

/// "--json", "-q", ...: every way to write the options of a command.
std::vector<std::string> spellings(const CLI::App& command) {
  std::vector<std::string> out;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) out.push_back("--" + name);
    for (const std::string& name : option->get_snames()) out.push_back("-" + name);
  }
  return out;
}

std::string joined(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, " ")); }

/// For single quotes of the shells.
std::string quoted(std::string text) {
  for (std::size_t at = 0; (at = text.find('\'', at)) != std::string::npos; at += 4) text.replace(at, 1, "'\\''");
  return "'" + text + "'";
}

std::string bash(const CLI::App& app, const Words& words) {
  std::vector<std::string> names;
  for (const CLI::App* command : commands(app)) names.push_back(command->get_name());
  std::string out = fmt::format(
      "# bash completion of tendril: source it, or put it into ~/.local/share/bash-completion/completions/tendril\n"
      "_tendril() {{\n"
      "  local word=${{COMP_WORDS[COMP_CWORD]}} options= words=\n"
      "  COMPREPLY=()\n"
      "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
      "    COMPREPLY=($(compgen -W \"{} {}\" -- \"$word\"))\n"
      "    return\n"
      "  fi\n"
      "  case ${{COMP_WORDS[1]}} in\n",
      joined(names), joined(spellings(app)));
  for (const CLI::App* command : commands(app)) {
    const auto known = words.find(command->get_name());
    out += fmt::format("    {}) options=\"{}\" words=\"{}\" ;;\n", command->get_name(), joined(spellings(*command)),
                       known == words.end() ? "" : joined(known->second));
  }
  return out +
         "  esac\n"
         "  case $word in\n"
         "    -*) COMPREPLY=($(compgen -W \"$options\" -- \"$word\")) ;;\n"
         "    *) [ -z \"$words\" ] || COMPREPLY=($(compgen -W \"$words\" -- \"$word\")) ;;\n"
         "  esac\n"
         "}\n"
         "complete -o default -F _tendril tendril  # files where there is nothing better\n";
}

/// "name:description" for _describe.
std::string described(const std::string& name, std::string text) {
  for (std::size_t at = 0; (at = text.find(':', at)) != std::string::npos; at += 2) text.replace(at, 1, "\\:");
  return quoted(name + ":" + text);
}

std::string zsh(const CLI::App& app, const Words& words) {
  std::string out =
      "#compdef tendril\n"
      "# zsh completion of tendril: put it as _tendril into a directory of $fpath\n"
      "_tendril() {\n"
      "  local -a entries\n"
      "  if (( CURRENT == 2 )); then\n"
      "    entries=(\n";
  for (const CLI::App* command : commands(app))
    out += "      " + described(command->get_name(), command->get_description()) + "\n";
  out +=
      "    )\n"
      "    _describe command entries\n"
      "    return\n"
      "  fi\n"
      "  case $words[2] in\n";
  for (const CLI::App* command : commands(app)) {
    out += "    " + command->get_name() + ")\n      if [[ $PREFIX == -* ]]; then\n        entries=(\n";
    for (const CLI::Option* option : command->get_options()) {
      for (const std::string& name : option->get_lnames())
        out += "          " + described("--" + name, option->get_description()) + "\n";
    }
    out += "        )\n        _describe option entries\n      else\n";
    if (const auto known = words.find(command->get_name()); known != words.end()) {
      out += "        entries=(" + joined(known->second) + ")\n        _describe word entries\n";
    } else {
      out += "        _files\n";
    }
    out += "      fi ;;\n";
  }
  return out + "  esac\n}\n_tendril \"$@\"\n";
}

std::string fish(const CLI::App& app, const Words& words) {
  std::string out = "# fish completion of tendril: put it into ~/.config/fish/completions/tendril.fish\n";
  for (const CLI::App* command : commands(app)) {
    const std::string name = command->get_name();
    out += fmt::format("complete -c tendril -f -n __fish_use_subcommand -a {} -d {}\n", name,
                       quoted(command->get_description()));
    const std::string seen = "complete -c tendril -n '__fish_seen_subcommand_from " + name + "'";
    if (const auto known = words.find(name); known != words.end())
      out += seen + " -f -a " + quoted(joined(known->second)) + "\n";
    for (const CLI::Option* option : command->get_options()) {
      if (option->get_lnames().empty()) continue;
      out += seen + " -l " + option->get_lnames().front();
      if (!option->get_snames().empty()) out += " -s " + option->get_snames().front();
      out += std::string(takes_value(*option) ? " -r" : "") + " -d " + quoted(option->get_description()) + "\n";
    }
  }
  return out;
}

/// Text for roff: what it would read as a command is escaped.
std::string roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n')) {
      out += std::string("\\&") + c;
    } else {
      out += c;
    }
  }
  return out;
}

}  // namespace

int complete(const CLI::App& app, const std::string& shell) {
  using Script = std::string (*)(const CLI::App&, const Words&);
  const std::map<std::string, Script> scripts{{"bash", bash}, {"zsh", zsh}, {"fish", fish}};
  const auto script = scripts.find(shell);
  if (script == scripts.end()) {
    message("tendril: no completion for `" + shell + "`; there are bash, zsh, fish\n");
    return kUsage;
  }
  print(script->second(app, known_words()));
  return kSolved;
}

std::string man_page(const CLI::App& app, const std::string& version) {
  std::string out = ".TH TENDRIL 1 \"\" \"tendril " + version + "\" \"User commands\"\n.SH NAME\ntendril \\- " +
                    roff("contacts and forces of slender elastic rods held inside or around tubes") +
                    "\n.SH SYNOPSIS\n.B tendril\n.I COMMAND\n[\\fIOPTIONS\\fR] ...\n.SH DESCRIPTION\n" +
                    roff(app.get_description()) + "\n.SH COMMANDS\n";
  for (const CLI::App* command : commands(app)) {
    out += ".SS \"tendril " + command->get_name();
    for (const CLI::Option* option : command->get_options([](const CLI::Option* o) { return o->get_positional(); }))
      out += (option->get_required() ? " " : " [") + option->get_name(true) + (option->get_required() ? "" : "]");
    out += "\"\n" + roff(command->get_description()) + "\n";
    for (const CLI::Option* option : command->get_options()) {
      if (option == command->get_help_ptr()) continue;
      std::string names;
      for (const std::string& name : option->get_snames()) names += (names.empty() ? "-" : ", -") + name;
      for (const std::string& name : option->get_lnames()) names += (names.empty() ? "--" : ", --") + name;
      if (names.empty())
        names = option->get_name(true);
      else if (takes_value(*option))
        names += " " + option->get_type_name();
      out += ".TP\n\\fB" + roff(names) + "\\fR\n" + roff(option->get_description()) + "\n";
    }
  }
  return out + ".SH EXAMPLES AND EXIT STATUS\n.nf\n" + roff(app.get_footer()) + "\n.fi\n";
}

}  // namespace tendril::app
