/// The scenes of the hard cases: what the built-in ones are made into.
#pragma once

#include <weft/weft.h>

#include <string_view>
#include <vector>

#include "tools/scenes/scenes.h"

namespace weft::tools::hard {

/// The name and the options are known to be good.
SceneDescription built_in(std::string_view name, const scenes::Options& options);
SceneDescription sheet(std::string_view name, int size);

/// 20 particles of 1 kg in a level line, 1 cm of chain between each two, the ends fixed `stretch`
/// times the chain's length apart.
SceneDescription pulled_chain(double stretch);

/// Both diagonals of every cell, as constraints, joined to a sheet of size x size particles.
void add_diagonals(SceneDescription& scene, int size);

/// `along` x `across` particles, a cell wide each, level along x, the first and the last row fixed;
/// particle (i, j) has the number i * across + j.
SceneDescription ribbon(int along, int across, double cell);

/// A level sheet held on all sides, and a sphere above it that falls with this speed.
SceneDescription held_sheet_under_sphere(double speed);

/// A free sheet that flies and turns, without gravity.
SceneDescription spinning_sheet(int size);

/// One particle joined to so many others; it is fixed.
SceneDescription hub(int spokes);

/// So many cloths of 2 x 2 particles, each with one of them fixed.
SceneDescription pieces(int count);

/// Particles in a box, joined at random, rest lengths and masses at random too.
SceneDescription random_graph(std::uint32_t seed);

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
