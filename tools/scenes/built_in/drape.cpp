/// (i, j) at (i L, 0, j L), 1 cm above a fixed sphere of radius 0.3 below the middle of the sheet.
#include "tools/scenes/built_in.h"
#include "tools/scenes/sheet.h"

namespace weft::scenes::built_in {
namespace {

Layout drape_layout(const Options& options) {
  constexpr double kRadius = 0.3, kClearance = 0.01;
  Layout layout = level_sheet(options.size);
  layout.sphere = {.centre = {0.5, -kRadius - kClearance, 0.5}, .radius = kRadius};
  return layout;
}

}  // namespace

BuiltIn drape() {
  return {.summary = "a sheet of cotton falls over a fixed sphere",
          .is_fabric = true,
          .make = cloth<drape_layout>};
}

}  // namespace weft::scenes::built_in
