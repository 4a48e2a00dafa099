#include "tools/program/commands/completion_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <weft/mesh.h>

#include "tools/program/files/text_file.h"
#include "tools/program/terminal/exit_code.h"
#include "tools/program/text/enumerators.h"
#include "tools/scenes/scenes.h"

namespace weft::tools {
namespace {

std::string names_of(const auto& list, auto name) {
  std::string names;
  for (const auto& one : list) names += fmt::format("{}{}", names.empty() ? "" : " ", name(one));
  return names;
}

template <class Enum>
std::string names_of_all() {
  return names_of(enumerators<Enum>(), [](Enum one) { return name(one); });
}

/// The words that may stand after each option that has a few.
std::string values() {
  const auto case_of = [](std::string_view option, const std::string& words) {
    return fmt::format("    {}) words=\"{}\" ;;\n", option, words);
  };
  return case_of("--material", names_of(materials(), [](const auto& one) { return one.name; })) +
         case_of("--solver", names_of_all<Solver>()) + case_of("--scheme", names_of_all<Scheme>()) +
         case_of("--backend", names_of_all<Backend>()) + case_of("--isa", names_of_all<Isa>()) +
         case_of("--self-contact|--sleep|--skip|--velocity-correction", "on off");
}

/// Where a word has no match, bash offers files.
std::string script(const CommandLine& line) {
  std::string verbs, options;
  for (const VerbNames& names : line.verbs()) {
    verbs += names.verb + " ";
    options += fmt::format("    {}) words=\"{}\" ;;\n", names.verb, fmt::join(names.options, " "));
  }
  const std::string scenes =
      names_of(scenes::list(), [](const scenes::BuiltIn& scene) { return scene.name; });
  return fmt::format(R"bash(# bash completes weft after: eval "$(weft completion)"
_weft() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} verb=${{COMP_WORDS[1]}} words=
  if [ "$COMP_CWORD" = 1 ]; then
    words="{0}--help --version"
  elif [[ $word == -* ]]; then
    case $verb in
{1}    esac
  else
    case ${{COMP_WORDS[COMP_CWORD - 1]}} in
{2}    -*) ;;
    *) case $verb in run|scene) words="{3}" ;; esac ;;
    esac
  fi
  COMPREPLY=($(compgen -W "$words" -- "$word"))
}}
complete -o default -F _weft weft
)bash",
                     verbs, options, values(), scenes);
}

}  // namespace

void add_completion_command(CommandLine& line) {
  line.add_verb("completion", "Print a script by which bash completes this line", [&line] {
    const auto printed = print_text(script(line));
    return printed ? kDone : refuse(printed.error());
  });
}

}  // namespace weft::tools
