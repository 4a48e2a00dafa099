/// Cloth before anything joins its particles: what every built-in scene of cloth begins with.
#pragma once

#include <weft/weft.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "tools/scenes/irregular_mesh.h"
#include "tools/scenes/scene_body.h"

namespace weft::scenes {

/// Vertex (i, j) of N x N has the number i N + j; the sheet is 1 m wide and long.
struct Grid {
  int size;
  double spacing() const { return 1.0 / (size - 1); }
  /// i * spacing, but the last one is 1 exactly.
  double fraction(int i) const { return static_cast<double>(i) / (size - 1); }
  std::uint32_t number(int i, int j) const { return static_cast<std::uint32_t>(i * size + j); }
};

struct Ball {
  Vec3 centre;
  double radius = 0;  ///< m
  double mass = 1;    ///< kg
  bool is_fixed = true;
};

/// A fixed rod that vertices slide along, as rings do.
struct Rod {
  Vec3 from, to;  ///< m
  double friction = 0;
  std::vector<std::uint32_t> rings = {};  ///< vertices
};

struct Layout {
  std::vector<Vec3> start;  ///< m, where each vertex begins
  std::vector<Vec3> rest;   ///< m, where each lies in the shape at rest; empty: as `start`
  std::vector<Face> faces;  ///< vertices, in order around each
  std::vector<std::array<std::uint32_t, 2>> seams;  ///< vertices that are sewn together
  std::vector<std::uint32_t> pins;                  ///< fixed vertices
  std::optional<Grid> grid;    ///< whose vertices these are: its edges have one length
  std::optional<Ball> sphere;  ///< a particle after those of the cloth
  std::optional<Rod> rod;      ///< whose ends are particles after those of the cloth
  Vec3 wind;                   ///< m/s; only cloth of a material feels it
  std::vector<tools::SceneBody> bodies;
  std::vector<tools::PinMove> moves;  ///< of vertices in place of particles
  bool touches_itself = false;        ///< it has self-contact
  std::optional<double> yield;        ///< 1/m, of a material that would not keep a crease
};

}  // namespace weft::scenes
