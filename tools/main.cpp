/// The `weft` program. Its exit codes: exit_code.h.
#include "tools/program/commands/completion_command.h"
#include "tools/program/commands/replay_command.h"
#include "tools/program/commands/run_command.h"
#include "tools/program/commands/scene_command.h"
#include "tools/program/commands/scenes_command.h"
#include "tools/program/commands/view_command.h"
#include "tools/program/files/text_file.h"
#include "tools/program/terminal/command_line.h"
#include "tools/program/terminal/interrupt.h"
#ifdef WEFT_WITH_STUDIES
#include "tools/studies/forms/forms_command.h"
#include "tools/studies/hard/hard_command.h"
#include "tools/studies/paper/paper_command.h"
#include "tools/studies/precision/precision_command.h"
#endif

namespace {

constexpr weft::tools::Example kExamples[] = {
    {"weft run hang", "a sheet swings down"},
    {"weft run hang --size 100 --tolerance 0.1%", "finer, and within 0.1 %"},
    {"weft run tunic --material silk", "clothes of a material"},
    {"weft run drape --self-contact on --dt 1/60", "cloth that touches itself"},
    {"weft run flag --out flag.html", "a page that shows the run"},
    {"weft run mesh.obj --pin top --material denim", "a mesh of your own"},
    {"weft scene hang --out hang.json", "a scene to edit, and to run"},
    {"weft run hang --record run.weft", "all that it did, in a file"},
    {"weft replay run.weft", "whether it does so again"},
    {"weft scenes", "all that is built in"},
};

}  // namespace

int main(int argc, char** argv) {
  using namespace weft::tools;
  hold_standard_streams();
  install_interrupt_handler();
  CommandLine line("weft: a cloth kernel that reports its error beside its time",
                   "weft " WEFT_VERSION, kExamples);
  add_run_command(line);
  add_replay_command(line);
  add_scenes_command(line);
  add_scene_command(line);
  add_view_command(line);
#ifdef WEFT_WITH_STUDIES
  add_paper_command(line);
  add_hard_command(line);
  add_precision_command(line);
  add_forms_command(line);
#endif
  add_completion_command(line);
  return line.run(argc, argv);
}
