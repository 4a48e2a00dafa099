#include "tools/program/options/world_options.h"

#include <fmt/format.h>

#include "tools/program/formats/body_files.h"
#include "tools/program/formats/inside_out.h"
#include "tools/program/text/parse.h"

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

Result<void> add_plane(const std::string& text, std::vector<SceneBody>& bodies) {
  const auto numbers = parse_numbers(text);
  if (!numbers || numbers->size() != 4)
    return Error{fmt::format("--plane: '{}' is not nx,ny,nz,d", text)};
  const std::vector<double>& n = *numbers;
  const Plane plane{{n[0], n[1], n[2]}, n[3]};
  if (const auto built = build_shape(plane); !built)
    return Error{fmt::format("--plane: '{}': {}", text, built.error())};
  bodies.push_back({.shape = plane});
  return {};
}

Result<void> add_meshes(const WorldOptions& options, double scale, std::vector<SceneBody>& bodies,
                        std::vector<std::string>& notes) {
  BodyFiles files{.scale = scale, .turn = options.turn_bodies};
  if (options.body_dt) {
    const auto seconds = parse_seconds("--body-dt", *options.body_dt);
    if (!seconds) return Error{seconds.error()};
    files.frame = seconds.value();
  }
  bool any_series = false;
  for (const std::string& names : options.bodies) {
    files.names = names;
    any_series = any_series || files.is_series();
    auto body = body_of_files(files, notes);
    if (!body) return Error{body.error()};
    bodies.push_back(std::move(body.value()));
  }
  if (files.frame && !any_series) return Error{"--body-dt: is for a --body with a * in its name"};
  return {};
}

/// Of the bodies that a scene has.
void look_which_way(const WorldOptions& options, std::vector<SceneBody>& bodies,
                    std::vector<std::string>& notes) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    auto* const mesh = std::get_if<TriangleMesh>(&bodies[i].shape);
    if (mesh == nullptr || mesh->two_sided || !is_inside_out(*mesh)) continue;
    notes.push_back(note_of_inside_out(fmt::format("body {}", i), options.turn_bodies));
    if (options.turn_bodies) turn(*mesh);
  }
}

Result<void> set_surfaces(const WorldOptions& options, SceneDescription& scene,
                          std::vector<SceneBody>& bodies) {
  for (const auto& [option, value] :
       {std::pair{"--friction", options.friction}, {"--thickness", options.thickness}}) {
    if (!value) continue;
    if (bodies.empty()) return Error{fmt::format("{}: only scenes with bodies have it", option)};
    if (!(*value >= 0)) return Error{fmt::format("{}: {} is below 0", option, *value)};
  }
  scene.friction = options.friction.value_or(scene.friction);
  for (SceneBody& body : bodies) {
    body.friction = options.friction.value_or(body.friction);
    body.thickness = options.thickness.value_or(body.thickness);
  }
  return {};
}

Result<void> set_self_contact(const WorldOptions& options, SceneDescription& scene) {
  if (!options.self_contact) return {};
  const std::string& given = *options.self_contact;
  if (given != "on" && given != "off")
    return Error{fmt::format("--self-contact: '{}' is not on or off", given)};
  scene.self_contact.on = given == "on";
  return {};
}

/// A scene that had no air has it on its whole surface.
Result<void> set_pressures(const WorldOptions& options, SceneDescription& scene) {
  if (options.ram) {
    if (!(*options.ram >= 0)) return Error{fmt::format("--ram: {} is below 0", *options.ram)};
    if (scene.air.triangles.empty()) scene.air.triangles = scene.surface;
    if (scene.air.triangles.empty()) return Error{"--ram: the scene has no faces"};
    scene.air.ram = *options.ram;
  }
  if (options.gas && !options.pressure) return Error{"--gas: needs --pressure"};
  if (!options.pressure) return {};
  if (scene.surface.empty()) return Error{"--pressure: the scene has no faces"};
  scene.pressures = {{.pressure = *options.pressure, .gas = options.gas}};
  return {};
}

}  // namespace

void add_world_options(Verb verb, WorldOptions& options) {
  verb.option("--gravity", options.gravity,
              "x,y,z in m/s^2 (default: 10 downwards, or what a .json scene has)");
  verb.repeated("--sphere", options.spheres,
                "x,y,z,radius in m: a fixed sphere; x,y,z,radius,mass: a free one of so many kg; "
                "may be repeated");
  verb.repeated("--plane", options.planes,
                "nx,ny,nz,d: a solid plane, free where nx x + ny y + nz z >= d; may be repeated");
  verb.repeated("--body", options.bodies,
                "FILE.obj: a solid mesh; 'FOLDER/*.obj': one that deforms, a file for each frame; "
                "may be repeated");
  verb.option("--body-dt", options.body_dt, "s, from one file of a --body to the next, as 1/30");
  verb.flag("--turn-bodies", options.turn_bodies,
            "turns the triangles of bodies that are inside out: closed meshes that face inwards");
  verb.option("--friction", options.friction,
              "Coulomb's, between the cloth and all bodies (default 0.3, or what they have)");
  verb.option("--thickness", options.thickness,
              "m, at which all bodies keep the cloth (default 0.001, or what they have)");
  verb.option("--self-contact", options.self_contact,
              "on or off: whether layers of the cloth keep the thickness of its material from each "
              "other, 0.001 without (default: what the scene has)");
  verb.option(
      "--ram", options.ram,
      "pressure coefficient of air that a piece of the cloth catches, as a canopy or a sail: "
      "about 1.2 (default: 0, or what the material or the .json scene has)");
  verb.option("--pressure", options.pressure,
              "Pa, on all faces of the cloth, out of the sides from which their corners are seen "
              "counter-clockwise; below 0: into them (default: what a .json scene has)");
  verb.flag("--gas", options.gas,
            "--pressure is that of a gas which the faces enclose: it falls as the volume grows");
  verb.option("--damping-motion", options.damping_motion,
              "1/s: velocities fall by exp(-this t) (default: what the material or the .json scene "
              "has)");
}

Result<std::vector<std::string>> surround(const WorldOptions& options, SceneDescription& scene,
                                          std::vector<SceneBody>& bodies, double scale) {
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
    if (auto added = add_sphere(sphere, scene); !added) return Error{added.error()};
  }
  std::vector<std::string> notes;
  look_which_way(options, bodies, notes);
  if (auto added = add_meshes(options, scale, bodies, notes); !added) return Error{added.error()};
  for (const std::string& plane : options.planes) {
    if (auto added = add_plane(plane, bodies); !added) return Error{added.error()};
  }
  if (auto set = set_surfaces(options, scene, bodies); !set) return Error{set.error()};
  if (auto set = set_self_contact(options, scene); !set) return Error{set.error()};
  if (auto set = set_pressures(options, scene); !set) return Error{set.error()};
  return notes;
}

}  // namespace weft::tools
