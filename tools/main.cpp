/// The `weft` program. Its exit codes: exit_code.h.
#include "tools/command_line.h"
#include "tools/interrupt.h"
#include "tools/run_command.h"
#include "tools/scene_command.h"
#include "tools/studies/forms/forms_command.h"
#include "tools/studies/hard/hard_command.h"
#include "tools/studies/paper/paper_command.h"
#include "tools/studies/precision/precision_command.h"
#include "tools/text_file.h"

int main(int argc, char** argv) {
  using namespace weft::tools;
  hold_standard_streams();
  install_interrupt_handler();
  CommandLine line("weft: a cloth kernel that reports its error beside its time",
                   "weft " WEFT_VERSION);
  add_run_command(line);
  add_scene_command(line);
  add_paper_command(line);
  add_hard_command(line);
  add_precision_command(line);
  add_forms_command(line);
  return line.run(argc, argv);
}
