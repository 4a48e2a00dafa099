/// The world of a cloth: gravity, spheres, bodies, friction, the decay of its motion, pressures,
/// and whether it touches itself.
#pragma once

#include <weft/weft.h>

#include <optional>
#include <string>
#include <vector>

#include "tools/program/terminal/command_line.h"
#include "tools/scenes/scene_body.h"

namespace weft::tools {

struct WorldOptions {
  std::optional<std::string> gravity = {};    ///< x,y,z in m/s^2
  std::vector<std::string> spheres = {};      ///< x,y,z,radius in m, and perhaps a mass in kg
  std::optional<double> damping_motion = {};  ///< 1/s
  std::vector<std::string> planes = {};       ///< x,y,z,offset
  std::vector<std::string> bodies = {};       ///< as BodyFiles::names
  std::optional<std::string> body_dt = {};    ///< s
  bool turn_bodies = false;                   ///< those that are inside out
  std::optional<double> friction = {};
  std::optional<double> thickness = {};          ///< m
  std::optional<std::string> self_contact = {};  ///< on, off
  std::optional<double> ram = {};                ///< as Air::ram
  std::optional<double> pressure = {};           ///< Pa, on the whole surface
  bool gas = false;                              ///< whether that is of a gas
};

void add_world_options(Verb verb, WorldOptions& options);

/// Replaces gravity and the decay of motion where they are given, and adds the spheres as the last
/// particles, and meshes and then planes as the last bodies. Spheres without a mass are fixed.
/// Friction and thickness are those of all bodies, and of the cloth. `scale` is that of the files
/// of meshes. Returns notes for whoever runs it, a line each.
Result<std::vector<std::string>> surround(const WorldOptions& options, SceneDescription& scene,
                                          std::vector<SceneBody>& bodies, double scale = 1);

}  // namespace weft::tools
