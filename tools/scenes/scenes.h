/// The built-in scenes. Each has a source in tools/scenes/built_in, which defines it exactly and
/// gives it its name: CMake makes the list from the names of the sources.
///
/// SI units. N is Options::size. Where a source says nothing else, cloth is N x N particles over
/// 1 m x 1 m, particle (i, j) has the number i * N + j, spacing L = 1/(N-1), total mass 1 kg,
/// gravity (0, -10, 0); constraints join grid neighbours ("structural" edges) and, with
/// Options::diagonals, opposite corners of every cell (ropes of length sqrt(2) L); those between
/// two fixed particles are left out. All start at rest, every edge at its rest length; particles of
/// the cloth have radius 0.
///
/// With Options::material a cloth is what cloth_from_mesh makes of its faces: its edges are
/// springs, it bends, and its mass is that of its density. At rest it is flat, also where it starts
/// folded. Scenes of fabric are of cotton if no material is given.
#pragma once

#include <weft/mesh.h>

#include <span>
#include <string_view>

#include "tools/scenes/built_in.h"
#include "tools/scenes/scene.h"

namespace weft::scenes {

/// By their names.
std::span<const BuiltIn> list();
/// Null if none has this name.
const BuiltIn* find(std::string_view name);

/// An unknown name or an option out of range is an error.
Result<Scene> make_scene(std::string_view name, const Options& options);
/// Its description alone.
Result<SceneDescription> make(std::string_view name, const Options& options);

}  // namespace weft::scenes
