/// The `weft` program. Its exit codes: exit_code.h.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <new>
#include <string>
#include <string_view>

#include "tools/exit_code.h"
#include "tools/hard_command.h"
#include "tools/interrupt.h"
#include "tools/paper_command.h"
#include "tools/precision_command.h"
#include "tools/run_command.h"
#include "tools/scene_command.h"

namespace {

/// "run, scene or hard"
std::string verbs(const CLI::App& app) {
  const auto all = app.get_subcommands([](const CLI::App*) { return true; });
  std::string text;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const char* separator = i == 0 ? "" : i + 1 < all.size() ? ", " : " or ";
    text += separator + all[i]->get_name();
  }
  return text;
}

/// In words that name the cure.
std::string missing_verb(const CLI::App& app, int argc, char** argv) {
  const std::string_view first = argc > 1 ? argv[1] : "";
  if (first.empty() || first.starts_with('-')) return "a verb is missing: " + verbs(app);
  return fmt::format("'{}' is not a verb: {}", first, verbs(app));
}

}  // namespace

int main(int argc, char** argv) {
  using weft::tools::refuse;
  weft::tools::install_interrupt_handler();
  CLI::App app("weft: a cloth kernel that reports its error beside its time");
  app.require_subcommand(0, 1);  // none is refused below
  app.set_version_flag("--version", "weft " WEFT_VERSION, "Print the version and exit");
  int exit_code = weft::tools::kDone;
  weft::tools::add_run_command(app, exit_code);
  weft::tools::add_scene_command(app, exit_code);
  weft::tools::add_paper_command(app, exit_code);
  weft::tools::add_hard_command(app, exit_code);
  weft::tools::add_precision_command(app, exit_code);
  try {
    app.parse(argc, argv);
    if (app.get_subcommands().empty()) return refuse(missing_verb(app, argc, argv));
  } catch (const CLI::ExtrasError& error) {
    const bool is_verb = argc > 1 && argv[1][0] != '-' && app.get_subcommands().empty();
    return refuse(is_verb ? missing_verb(app, argc, argv) : error.what());
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) return refuse(error.what());
    app.exit(error);  // help, or the version
    return std::cout.flush() ? weft::tools::kDone : refuse("cannot write to stdout");
  } catch (const std::bad_alloc&) {
    return refuse("not enough memory for this scene");
  } catch (const std::exception& error) {
    return refuse(error.what());
  }
  return exit_code;
}
