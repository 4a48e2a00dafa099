/// The mannequin, whose body is triangle meshes of its capsules, 24 triangles around each.
#include <variant>

#include "tools/scenes/body_meshes.h"
#include "tools/scenes/built_in.h"
#include "tools/scenes/wearer.h"

namespace weft::scenes::built_in {
namespace {

Result<Layout> mannequin_mesh_layout(const Options& options) {
  constexpr int kAround = 24;
  auto layout = dressed_wearer(options);
  if (!layout) return layout;
  for (tools::SceneBody& part : layout.value().bodies)
    part.shape = capsule_mesh(std::get<Capsule>(part.shape), kAround);
  return layout;
}

}  // namespace

BuiltIn mannequin_mesh() {
  return {.summary = "the same on a body of triangle meshes",
          .is_fabric = true,
          .smallest_size = 20,
          .make = cloth<mannequin_mesh_layout>};
}

}  // namespace weft::scenes::built_in
