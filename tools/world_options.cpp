#include "tools/world_options.h"

#include <fmt/format.h>

#include "tools/parse.h"

namespace weft::tools {
namespace {

Result<void> add_sphere(const std::string& text, SceneDescription& scene) {
  const auto numbers = parse_numbers(text);
  if (!numbers || numbers->size() < 4 || numbers->size() > 5) {
    return Error{fmt::format("--sphere: '{}' is not x,y,z,radius or x,y,z,radius,mass", text)};
  }
  const std::vector<double>& n = *numbers;
  if (n[3] <= 0) return Error{fmt::format("--sphere: '{}': the radius is not above 0", text)};
  const bool is_free = n.size() == 5;
  if (is_free && n[4] <= 0)
    return Error{fmt::format("--sphere: '{}': the mass is not above 0", text)};
  const auto particle = static_cast<std::uint32_t>(scene.positions.size());
  scene.radii.resize(scene.positions.size());
  scene.positions.push_back({n[0], n[1], n[2]});
  if (!scene.velocities.empty()) scene.velocities.push_back({});
  scene.masses.push_back(is_free ? n[4] : 1);
  scene.radii.push_back(n[3]);
  scene.spheres.push_back(particle);
  if (!is_free) scene.fixed.push_back(particle);
  return {};
}

}  // namespace

void add_world_options(Verb verb, WorldOptions& options) {
  verb.option("--gravity", options.gravity,
              "x,y,z in m/s^2 (default: 10 downwards, or what a .json scene has)");
  verb.repeated("--sphere", options.spheres,
                "x,y,z,radius in m: a fixed sphere; x,y,z,radius,mass: a free one of so many kg; "
                "may be repeated");
  verb.option("--damping-motion", options.damping_motion,
              "1/s: velocities fall by exp(-this t) (default: what the material or the .json scene "
              "has)");
}

Result<void> surround(const WorldOptions& options, SceneDescription& scene) {
  if (options.gravity) {
    const auto gravity = parse_vector("--gravity", *options.gravity);
    if (!gravity) return Error{gravity.error()};
    scene.gravity = gravity.value();
  }
  if (options.damping_motion) {
    if (!(*options.damping_motion >= 0)) {
      return Error{fmt::format("--damping-motion: {} is below 0", *options.damping_motion)};
    }
    scene.damping.motion = *options.damping_motion;
  }
  for (const std::string& sphere : options.spheres) {
    if (auto added = add_sphere(sphere, scene); !added) return added;
  }
  return {};
}

}  // namespace weft::tools
