/// (i, j) at (i L, 0, j L); its four corners are fixed, as far apart as in the sheet.
#include "tools/scenes/built_in.h"
#include "tools/scenes/sheet.h"

namespace weft::scenes::built_in {
namespace {

Layout four_pins_layout(const Options& options) {
  Layout layout = level_sheet(options.size);
  const Grid grid = *layout.grid;
  const int last = grid.size - 1;
  layout.pins = {grid.number(0, 0), grid.number(0, last), grid.number(last, 0),
                 grid.number(last, last)};
  return layout;
}

}  // namespace

BuiltIn four_pins() {
  return {.summary = "a level sheet sinks between its four fixed corners",
          .smallest_size = 3,
          .make = cloth<four_pins_layout>};
}

}  // namespace weft::scenes::built_in
