/// The `weft` program. Its exit codes: exit_code.h.
#include <CLI/CLI.hpp>
#include <new>

#include "tools/exit_code.h"
#include "tools/hard_command.h"
#include "tools/interrupt.h"
#include "tools/paper_command.h"
#include "tools/precision_command.h"
#include "tools/run_command.h"
#include "tools/scene_command.h"

int main(int argc, char** argv) {
  using weft::tools::refuse;
  weft::tools::install_interrupt_handler();
  CLI::App app("weft: a cloth kernel that reports its error beside its time");
  app.require_subcommand(0, 1);  // none is refused below, in words that name the cure
  int exit_code = weft::tools::kDone;
  weft::tools::add_run_command(app, exit_code);
  weft::tools::add_scene_command(app, exit_code);
  weft::tools::add_paper_command(app, exit_code);
  weft::tools::add_hard_command(app, exit_code);
  weft::tools::add_precision_command(app, exit_code);
  try {
    app.parse(argc, argv);
    if (app.get_subcommands().empty())
      return refuse("a verb is missing: run, scene, paper, hard or precision");
  } catch (const CLI::ParseError& error) {
    return error.get_exit_code() == 0 ? app.exit(error) : refuse(error.what());
  } catch (const std::bad_alloc&) {
    return refuse("not enough memory for this scene");
  } catch (const std::exception& error) {
    return refuse(error.what());
  }
  return exit_code;
}
