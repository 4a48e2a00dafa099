/// The scene hang, and a fixed sphere at (0.5, -0.6, 0.5), radius 0.25.
#include "tools/scenes/built_in.h"
#include "tools/scenes/sheet.h"

namespace weft::scenes::built_in {
namespace {

Layout hang_sphere_layout(const Options& options) {
  Layout layout = hanging_sheet(options.size);
  layout.sphere = {.centre = {0.5, -0.6, 0.5}, .radius = 0.25};
  return layout;
}

}  // namespace

BuiltIn hang_sphere() {
  return {.summary = "the same, swinging into a fixed sphere", .make = cloth<hang_sphere_layout>};
}

}  // namespace weft::scenes::built_in
