/// The `weft` program. Its exit codes: exit_code.h.
#include "tools/program/commands/run_command.h"
#include "tools/program/commands/scene_command.h"
#include "tools/program/commands/view_command.h"
#include "tools/program/files/text_file.h"
#include "tools/program/terminal/command_line.h"
#include "tools/program/terminal/interrupt.h"
#include "tools/studies/forms/forms_command.h"
#include "tools/studies/hard/hard_command.h"
#include "tools/studies/paper/paper_command.h"
#include "tools/studies/precision/precision_command.h"

int main(int argc, char** argv) {
  using namespace weft::tools;
  hold_standard_streams();
  install_interrupt_handler();
  CommandLine line("weft: a cloth kernel that reports its error beside its time",
                   "weft " WEFT_VERSION);
  add_run_command(line);
  add_scene_command(line);
  add_view_command(line);
  add_paper_command(line);
  add_hard_command(line);
  add_precision_command(line);
  add_forms_command(line);
  return line.run(argc, argv);
}
