/// A scene that is built in, as its source in tools/scenes/built_in describes it.
#pragma once

#include <string_view>

#include "tools/scenes/cloth.h"
#include "tools/scenes/layout.h"
#include "tools/scenes/scene.h"

namespace weft::scenes {

struct BuiltIn {
  std::string_view name = {};  ///< that of its source: the sources do not repeat it
  std::string_view summary;
  bool is_fabric = false;  ///< it always has a material
  int smallest_size = 2;
  int usual_size = 20;
  /// The size is from the smallest one up; the scene itself checks its other options.
  Result<Scene> (*make)(const Options&);
};

/// A scene whose cloth is that of a layout: `Layout` or `Result<Layout> kLayout(const Options&)`.
template <auto kLayout>
Result<Scene> cloth(const Options& options) {
  const Result<Layout> layout = kLayout(options);
  if (!layout) return Error{layout.error()};
  return cloth_of(layout.value(), options);
}

/// The error that an option of a scene is out of range: "slack must be below 1, not 2".
Error refused(std::string_view option, std::string_view allowed, double value);
Error refused(std::string_view option, std::string_view allowed, int value);
/// Refuses what is not positive and finite.
Result<void> check_mass(std::string_view option, double mass);

}  // namespace weft::scenes
