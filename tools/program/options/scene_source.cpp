#include "tools/program/options/scene_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "engine/mesh/pieces.h"
#include "tools/program/formats/obj_mesh.h"
#include "tools/program/formats/scene_file.h"
#include "tools/program/text/file_ending.h"
#include "tools/program/text/wording.h"
#include "tools/scenes/scenes.h"

namespace weft::tools {
namespace {

std::string built_in_names() {
  std::string names;
  for (const scenes::BuiltIn& scene : scenes::list()) {
    names += fmt::format("{}{}", names.empty() ? "" : ", ", scene.name);
  }
  return names;
}

/// What changes a material changes that which the scene has by itself.
MaterialOptions with_its_own(MaterialOptions options, const scenes::BuiltIn& scene) {
  if (scene.is_fabric && !options.material) options.material = scenes::kFabric;
  return options;
}

/// The kinds of scene that options belong to, for their errors.
constexpr std::string_view kBuiltIn = "built-in scenes";
constexpr std::string_view kSphereDrop = "sphere_drop";
constexpr std::string_view kChain = "chain";
constexpr std::string_view kBuiltInCloth = "built-in scenes but chain";
constexpr std::string_view kObj = ".obj meshes";
constexpr std::string_view kCloth = ".obj meshes and built-in scenes but chain";

/// Refuses what was given but belongs to another kind of scene.
Result<void> check_options(const SceneOptions& options, std::span<const std::string_view> kinds) {
  struct Given {
    std::string_view option;
    bool is_given;
    std::string_view kind;
  };
  const Given all[] = {
      {"--size", options.size.has_value(), kBuiltIn},
      {"--slack", options.slack.has_value(), kSphereDrop},
      {"--sphere-mass", options.sphere_mass.has_value(), kSphereDrop},
      {"--end-mass", options.end_mass.has_value(), kChain},
      {"--pin", options.pin.has_value(), kObj},
      {"--mass", options.mass.has_value(), kObj},
      {"--scale", options.scale && options.world.bodies.empty(), kObj},
      {"--up", options.up.has_value(), kObj},
      {"--weld", options.weld.has_value(), kObj},
      {"--seam", !options.seams.empty(), kObj},
      {"--seam-time", options.seam_time.has_value(), kObj},
      {"--seam-force", options.seam_force.has_value(), kObj},
      {"--rest", options.rest.has_value(), kObj},
      {"--warp", options.warp.has_value(), kObj},
      {"--thread-density", options.thread_density.has_value(), kObj},
      {"--ropes", options.ropes.has_value(), kCloth},
      {"--diagonals", options.diagonals, kBuiltInCloth},
      {given_option(options.material), is_given(options.material), kCloth},
  };
  for (const Given& given : all) {
    if (!given.is_given || std::ranges::find(kinds, given.kind) != kinds.end()) continue;
    return Error{
        fmt::format("{}: only for {}, not for '{}'", given.option, given.kind, options.scene)};
  }
  return {};
}

/// What --ropes says, and what it says alone.
Result<Ropes> ropes_of(const std::optional<std::string>& given, Ropes alone) {
  if (!given) return Ropes::none;
  if (given->empty()) return alone;
  if (*given == "all") return Ropes::all;
  if (*given == "diagonals") return Ropes::diagonals;
  return Error{fmt::format("--ropes: '{}' is not one of all, diagonals", *given)};
}

/// What the options say of cloth, for a mesh.
struct ClothOptions {
  Ropes ropes = Ropes::none;
  std::optional<Material> material;
  std::optional<Vec3> wind;
};
Result<ClothOptions> cloth_of(const std::optional<std::string>& given_ropes,
                              const MaterialOptions& given, Ropes alone) {
  const auto ropes = ropes_of(given_ropes, alone);
  if (!ropes) return Error{ropes.error()};
  const auto material = material_of(given);
  if (!material) return Error{material.error()};
  const auto wind = wind_of(given);
  if (!wind) return Error{wind.error()};
  return ClothOptions{ropes.value(), material.value(), wind.value()};
}

Result<void> blow(const std::optional<Vec3>& wind, SceneDescription& scene) {
  if (!wind) return {};
  if (scene.air.triangles.empty()) return Error{"--wind: only cloth of a material feels it"};
  scene.air.wind = *wind;
  return {};
}

Result<SceneSource> load_built_in(const scenes::BuiltIn& scene, const SceneOptions& options) {
  const bool is_cloth = options.scene != kChain;
  const std::string_view kinds[] = {kBuiltIn, options.scene, is_cloth ? kCloth : options.scene,
                                    is_cloth ? kBuiltInCloth : options.scene};
  if (auto checked = check_options(options, kinds); !checked) return Error{checked.error()};
  const auto cloth = cloth_of(options.ropes, with_its_own(options.material, scene), Ropes::all);
  if (!cloth) return Error{cloth.error()};
  scenes::Options values;
  values.size = options.size.value_or(scene.usual_size);
  values.slack = options.slack.value_or(values.slack);
  values.sphere_mass = options.sphere_mass.value_or(values.sphere_mass);
  values.end_mass = options.end_mass.value_or(values.end_mass);
  values.ropes = cloth.value().ropes == Ropes::all;
  values.diagonals = options.diagonals || cloth.value().ropes == Ropes::diagonals;
  values.material = cloth.value().material;
  auto made = scenes::make_scene(options.scene, values);
  if (!made) return Error{made.error()};
  auto& [description, mesh, bodies, moves] = made.value();
  if (auto blown = blow(cloth.value().wind, description); !blown) return Error{blown.error()};
  SceneSource source{options.scene, std::move(description), std::move(mesh)};
  source.bodies = std::move(bodies);
  source.moves = std::move(moves);
  return source;
}

Result<SceneSource> load_scene_file(const SceneOptions& options) {
  if (auto checked = check_options(options, {}); !checked) return Error{checked.error()};
  auto read = read_scene_file(options.scene);
  if (!read) return Error{read.error()};
  auto& [description, moves, faces, bodies, events, rest_scale] = read.value();
  Mesh mesh = face_mesh(description, std::move(faces));
  return SceneSource{options.scene,        std::move(description), std::move(mesh),
                     std::move(moves),     std::move(bodies),      std::move(events),
                     std::move(rest_scale)};
}

/// Whether edges are rigid and enclose triangles, more of them than quads.
bool locks(const MeshCounts& counts, const ObjOptions& options) {
  const std::size_t triangles = counts.triangles + 2 * counts.recognised_quads;
  const std::size_t quads = counts.quads - counts.recognised_quads;
  return !options.material && options.ropes != Ropes::all && triangles > quads;
}

/// m, the largest of the three extents.
double size_of(const SceneDescription& scene) {
  double size = 0;
  for (const auto axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
    const auto [least, most] = std::ranges::minmax(scene.positions, {}, axis);
    size = std::max(size, most.*axis - least.*axis);
  }
  return size;
}

std::vector<std::string> notes_of(const ObjScene& scene, const ObjOptions& options) {
  constexpr double kLargestCloth = 20;  // m; clothes and curtains in centimetres are larger
  std::vector<std::string> notes;
  if (locks(scene.counts, options)) {
    notes.emplace_back(
        "triangles of rigid edges lock, so that the cloth hardly folds: ask for --material, or "
        "--ropes all");
  }
  if (const double size = size_of(scene.description); size > kLargestCloth) {
    notes.push_back(fmt::format(
        "the mesh is {:.3g} m large: if its coordinates are in centimetres, ask for --scale {}",
        size, 0.01 * options.scale));
  }
  return notes;
}

Result<double Vec3::*> up_of(const std::optional<std::string>& given) {
  if (!given || *given == "y") return &Vec3::y;
  if (*given == "z") return &Vec3::z;
  return Error{fmt::format("--up: '{}' is not one of y, z", *given)};
}

Result<SceneSource> load_obj(const SceneOptions& options) {
  const std::string_view kinds[] = {kObj, kCloth};
  if (auto checked = check_options(options, kinds); !checked) return Error{checked.error()};
  ObjOptions values;
  values.pin = options.pin.value_or(values.pin);
  values.mass = options.mass.value_or(values.mass);
  values.scale = options.scale.value_or(values.scale);
  values.weld_distance = options.weld.value_or(values.weld_distance);
  values.seams = options.seams;
  values.seam_time = options.seam_time.value_or(values.seam_time);
  values.seam_force = options.seam_force;
  if (options.seam_force && !options.seam_time)
    return Error{"--seam-force: is for seams that close in a --seam-time"};
  values.rest = options.rest;
  values.warp = options.warp;
  values.thread_density = options.thread_density.value_or(values.thread_density);
  const auto up = up_of(options.up);
  if (!up) return Error{up.error()};
  values.up = up.value();
  const auto cloth = cloth_of(options.ropes, options.material, Ropes::diagonals);
  if (!cloth) return Error{cloth.error()};
  values.ropes = cloth.value().ropes;
  values.material = cloth.value().material;
  for (const auto& [option, is_given] :
       {std::pair{"--warp", options.warp.has_value()},
        {"--thread-density", options.thread_density.has_value()}}) {
    if (is_given && !values.material)
      return Error{fmt::format("{}: only cloth of a material has one", option)};
  }
  if (options.mass && values.material) return Error{"--mass: a material has a density instead"};
  auto scene = read_obj_file(options.scene, values);
  if (!scene) return Error{scene.error()};
  ObjScene& obj = scene.value();
  if (auto blown = blow(cloth.value().wind, obj.description); !blown) return Error{blown.error()};
  SceneSource source{options.scene, {}, {}};
  source.notes = notes_of(obj, values);
  if (obj.counts.thread_lines > 0 && !options.thread_density) {
    source.notes.push_back(
        fmt::format("lines are threads of {:g} g/m: --thread-density says otherwise, in kg/m",
                    1e3 * values.thread_density));
  }
  source.up = values.up;
  source.counts = obj.counts;
  source.description = std::move(obj.description);
  source.mesh = std::move(obj.mesh);
  return source;
}

bool is_held(const SceneDescription& scene) {
  const std::set<std::uint32_t> fixed(scene.fixed.begin(), scene.fixed.end());
  return !scene.positions.empty() && fixed.size() == scene.positions.size();
}

/// Where some pieces are held, those that are not fall away, which nobody may have wanted.
std::string note_of(const mesh::Pieces& pieces, const SceneSource& source) {
  if (pieces.loose() == 0 || pieces.loose() == pieces.count) return {};
  std::string note =
      fmt::format("{} of {} hang on no pin", pieces.loose(), counted(pieces.count, "piece"));
  const double weld = source.counts ? source.counts->suggested_weld : 0;
  if (weld > 0) note += fmt::format(": --weld {:g} would join what lies that near", weld);
  return note;
}

/// What whoever runs the scene should know of it.
void look_over(SceneSource& source) {
  const SceneDescription& scene = source.description;
  if (is_held(scene))
    source.notes.emplace_back("every particle is fixed, so that nothing can move");
  auto note = note_of(mesh::pieces_of(scene), source);
  if (!note.empty()) source.notes.push_back(std::move(note));
}

Result<SceneSource> load_as_it_is(const SceneOptions& options) {
  if (const auto* built_in = scenes::find(options.scene)) return load_built_in(*built_in, options);
  const std::string ending = file_ending(options.scene);
  if (ending == ".json") return load_scene_file(options);
  if (ending == ".obj") return load_obj(options);
  return Error{fmt::format("SCENE: '{}' is not one of {}, nor a .json or .obj file", options.scene,
                           built_in_names())};
}

}  // namespace

std::string SceneSource::title() const { return std::filesystem::path(name).filename().string(); }

void add_scene_options(Verb verb, SceneOptions& options) {
  verb.required("SCENE", options.scene,
                "the name of a built-in scene (`weft scenes` lists them), a .json scene or an "
                ".obj mesh");
  verb.group("Built-in scenes");
  verb.option("--size", options.size,
              "particles along a side of a built-in scene (default 20, or what a scene takes)");
  verb.option("--slack", options.slack, "sphere_drop: slack of the sheet (default 0.05)");
  verb.option("--sphere-mass", options.sphere_mass, "sphere_drop: kg (default 1)");
  verb.option("--end-mass", options.end_mass, "chain: kg of the last particle (default 1)");
  verb.group("Meshes");
  verb.option("--pin", options.pin,
              ".obj: fixed vertices; none (default), top, a comparison of the file's "
              "coordinates like 'y>0.9' or 'x<=-1', or vertex numbers from 0 like 0,5,7-9; "
              "several with and, or between: 'top and x<0.1 or 17'");
  verb.option("--mass", options.mass, ".obj: kg of the whole mesh (default 1)");
  verb.option("--scale", options.scale,
              ".obj, of the cloth and of a --body: multiplies all coordinates (default 1)");
  verb.option("--up", options.up, ".obj: y (default) or z, where top is and gravity comes from");
  verb.option("--weld", options.weld,
              ".obj: m, vertices as near as this are one (default 0: those at one place)");
  verb.repeated("--seam", options.seams,
                ".obj: vertices that are sewn together, two lists from 0 like 0-9:29-20; may be "
                "repeated");
  verb.option(
      "--seam-time", options.seam_time,
      ".obj: s, in which seams draw their vertices together, which then are held (default 0: "
      "they are one from the beginning)");
  verb.option("--seam-force", options.seam_force,
              ".obj: N, of a seam while it closes, at most (default: no limit)");
  verb.option("--rest", options.rest,
              ".obj: the shape at rest: FILE.obj with the same vertices and faces, or uv:SCALE, "
              "texture coordinates times SCALE in m (default 1)");
  verb.option("--warp", options.warp,
              ".obj with a material: where the warp runs, x,y,z for the whole mesh, or uv, along v "
              "of the texture coordinates (default: along edges of cells, else y)");
  verb.option("--thread-density", options.thread_density,
              ".obj with a material: kg/m of its lines, which are threads (default 0.001)");
  verb.group("Cloth of meshes and built-in scenes");
  verb.option_or_flag("--ropes", options.ropes, "",
                      "what only pulls, all or diagonals (of four-sided faces; without a "
                      "material only ropes join them); alone: built-in scenes all, .obj diagonals");
  verb.flag("--diagonals", options.diagonals,
            "built-in scenes but chain: the same as --ropes diagonals");
  add_material_options(verb, options.material);
  verb.group("The world around the cloth");
  add_world_options(verb, options.world);
}

Result<SceneSource> load_scene(const SceneOptions& options) {
  auto source = load_as_it_is(options);
  if (!source) return source;
  SceneSource& scene = source.value();
  const double scale = options.scale.value_or(1);
  auto notes = surround(options.world, scene.description, scene.bodies, scale);
  if (!notes) return Error{notes.error()};
  scene.notes.insert(scene.notes.end(), notes.value().begin(), notes.value().end());
  return source;
}

Result<std::shared_ptr<const Model>> model_of(SceneSource& source) {
  auto model = build_model(source.description);
  if (model) look_over(source);
  if (model || scenes::find(source.name) != nullptr) return model;
  return Error{fmt::format("{}: {}", source.name, model.error())};
}

}  // namespace weft::tools
