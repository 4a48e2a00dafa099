/// The scenes of the hard cases: what the built-in ones are made into.
#pragma once

#include <weft/weft.h>

#include <string_view>

#include "engine/scenes.h"

namespace weft::tools::hard {

/// The name and the options are known to be good.
SceneDescription built_in(std::string_view name, const scenes::Options& options);
SceneDescription sheet(std::string_view name, int size);

/// 20 particles of 1 kg in a level line, 1 cm of chain between each two, the ends fixed `stretch`
/// times the chain's length apart.
SceneDescription pulled_chain(double stretch);

/// Both diagonals of every cell, as constraints, joined to a sheet of size x size particles.
void add_diagonals(SceneDescription& scene, int size);

/// Moves the particles that are not fixed: place(particle's number, where it was).
template <class Place>
void replace_free(SceneDescription& scene, Place&& place) {
  std::vector<bool> fixed(scene.positions.size());
  for (const std::uint32_t particle : scene.fixed) fixed[particle] = true;
  for (std::uint32_t i = 0; i < scene.positions.size(); ++i) {
    if (!fixed[i]) scene.positions[i] = place(i, scene.positions[i]);
  }
}

}  // namespace weft::tools::hard
