/// What the page calls: one cloth, the bodies beside it, and the particle that the pointer holds.
/// Functions that may fail return 0, or 1 with a message.
#include <emscripten.h>
#include <weft/mesh.h>
#include <weft/weft.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>

namespace {

using namespace weft;

enum class Scene { sheet, skirt, drape };

struct Choices {
  Scene scene;
  unsigned side;
  std::string material;
  Settings settings;
  Vec3 wind;
  bool self_contact;
};

struct Page {
  Choices choices;
  SceneDescription scene;
  std::optional<Cloth> cloth;
  std::vector<Body> bodies;
  std::vector<std::uint32_t> triangles;
  std::vector<float> places;
  std::uint32_t held = kNoIndex;
  Vec3 held_to{};
  double time = 0;  // that bodies have moved
  StepReport report{};
};
std::unique_ptr<Page> shown;
std::string message;

/// A grid of vertices, around or across, row by row; its quads.
template <class Place>
MeshDescription grid(unsigned columns, unsigned rows, bool closes, Place place) {
  MeshDescription mesh;
  for (unsigned row = 0; row < rows; ++row) {
    for (unsigned column = 0; column < columns; ++column) {
      mesh.positions.push_back(place(column, row));
      if (row == 0 || (column == 0 && !closes)) continue;
      const unsigned at = row * columns + column, before = column > 0 ? at - 1 : at + columns - 1;
      mesh.corners.insert(mesh.corners.end(), {before - columns, at - columns, at, before});
      mesh.face_sizes.push_back(4);
    }
  }
  return mesh;
}

/// 1 m wide, upright; its front is on the side of z.
MeshDescription sheet(unsigned side) {
  const double cell = 1. / (side - 1);
  return grid(side, side, false, [=](unsigned i, unsigned j) {
    return Vec3{cell * i - 0.5, cell * j - 0.5, 0};
  });
}

MeshDescription skirt(unsigned side) {
  const unsigned around = side / 2 * 4, rows = side;
  MeshDescription mesh = grid(around, rows, true, [=](unsigned i, unsigned j) {
    const double turn = 2 * std::numbers::pi * i / around, down = j / (rows - 1.);
    const double radius = 0.15 + 0.2 * down;
    return Vec3{std::cos(turn) * radius, 1 - 0.5 * down, std::sin(turn) * radius};
  });
  for (unsigned i = 0; i < around; ++i) mesh.pins.push_back(i);
  return mesh;
}

MeshDescription mesh_of(Scene scene, unsigned side) {
  if (scene == Scene::skirt) return skirt(side);
  MeshDescription mesh = sheet(side);
  if (scene == Scene::drape) {
    for (Vec3& p : mesh.positions) p = {p.x, 0.62, -p.y};
    return mesh;
  }
  for (Vec3& p : mesh.positions) {
    p = {p.x, p.y + 0.6, 0.02 * std::sin(9 * p.x) * std::cos(7 * p.y)};
  }
  mesh.pins = {side * side - side, side * side - 1};
  return mesh;
}

Pose leg(double time, double which) {
  const double half = 0.2 * which * std::sin(4 * time);
  return {{0.075 * which, 0.9, 0}, {std::sin(half), 0, 0, std::cos(half)}};
}

Result<std::vector<Body>> bodies_of(Scene scene) {
  std::vector<Body> made;
  const auto add = [&](auto&& form, Pose pose) -> Result<void> {
    auto shape = build_shape(form);
    if (!shape) return Error{shape.error()};
    made.push_back({.shape = shape.value(), .pose = pose});
    return {};
  };
  if (scene == Scene::skirt) {
    for (const double which : {-1, 1}) {
      if (auto r = add(Capsule{{}, {0, -0.8, 0}, 0.07, 0.05}, leg(0, which)); !r)
        return Error{r.error()};
    }
  }
  if (scene == Scene::drape) {
    if (auto r = add(Ball{{0, 0.28, 0}, 0.28}, {}); !r) return Error{r.error()};
    if (auto r = add(Plane{{0, 1, 0}, 0}, {}); !r) return Error{r.error()};
  }
  return made;
}

/// Triangles to draw: each quad in two.
std::vector<std::uint32_t> triangles_of(const MeshDescription& mesh) {
  std::vector<std::uint32_t> all;
  for (std::size_t i = 0; i + 3 < mesh.corners.size(); i += 4) {
    const auto corner = [&](std::size_t k) { return mesh.corners[i + k]; };
    all.insert(all.end(), {corner(0), corner(1), corner(2), corner(0), corner(2), corner(3)});
  }
  return all;
}

void read(Page& page) {
  page.places.resize(3 * page.cloth->particle_count());
  (void)page.cloth->read_positions(FloatVectors{page.places});
}

Result<std::unique_ptr<Page>> make(Choices choices) {
  MeshDescription mesh = mesh_of(choices.scene, choices.side);
  auto material = find_material(choices.material);
  if (!material) return Error{material.error()};
  mesh.material = material.value();
  auto made = cloth_from_mesh(mesh);
  if (!made) return Error{made.error()};
  auto page = std::make_unique<Page>();
  page->scene = std::move(made.value().scene);
  page->scene.self_contact.on = choices.self_contact;
  page->scene.air.wind = choices.wind;
  page->triangles = triangles_of(mesh);
  auto model = build_model(page->scene);
  if (!model) return Error{model.error()};
  auto cloth = Cloth::create(model.value(), choices.settings);
  if (!cloth) return Error{cloth.error()};
  page->cloth.emplace(std::move(cloth).value());
  auto bodies = bodies_of(choices.scene);
  if (!bodies) return Error{bodies.error()};
  page->bodies = std::move(bodies).value();
  for (const Body& body : page->bodies) {
    if (auto r = page->cloth->add_body(body); !r) return Error{r.error()};
  }
  page->choices = std::move(choices);
  read(*page);
  return page;
}

bool is_fixed(const Page& page, std::uint32_t particle) {
  for (const std::uint32_t fixed : page.scene.fixed) {
    if (fixed == particle) return true;
  }
  return false;
}

Result<void> take_hold(Page& page, std::uint32_t particle) {
  page.held = particle;
  page.held_to = page.cloth->position(particle);
  return is_fixed(page, particle) ? Result<void>{} : page.cloth->change({.fix = {particle}});
}

/// Other choices for the same scene: the cloth goes on from where it is.
Result<void> go_on(Page& page, const Page& before) {
  if (page.places.size() != before.places.size()) return {};
  std::vector<Vec3> places(before.cloth->particle_count()), speeds(places.size());
  if (auto r = before.cloth->read_positions(places); !r) return r;
  if (auto r = before.cloth->read_velocities(speeds); !r) return r;
  if (auto r = page.cloth->write_positions(places); !r) return r;
  if (auto r = page.cloth->write_velocities(speeds); !r) return r;
  page.time = before.time;
  for (unsigned id = 0; id < page.bodies.size(); ++id) {
    page.bodies[id].pose = before.bodies[id].pose;
    if (auto r = page.cloth->place_body(id, page.bodies[id].pose); !r) return r;
  }
  read(page);
  return before.held == kNoIndex ? Result<void>{} : take_hold(page, before.held);
}

int answer(const Result<void>& result) {
  if (!result) message = result.error();
  return result ? 0 : 1;
}

Result<void> begin(Choices choices, bool goes_on) {
  auto made = make(std::move(choices));
  if (!made) return Error{made.error()};
  if (goes_on && shown) {
    if (auto r = go_on(*made.value(), *shown); !r) return r;
  }
  shown = std::move(made).value();
  return {};
}

Result<void> advance(Page& page, double dt) {
  page.time += dt;
  if (page.choices.scene == Scene::skirt) {
    for (const unsigned id : {0u, 1u}) {
      page.bodies[id].pose = leg(page.time, id == 0 ? -1 : 1);
      if (auto r = page.cloth->move_body(id, page.bodies[id].pose); !r) return r;
    }
  }
  if (page.held != kNoIndex) {
    if (auto r = page.cloth->move_fixed(page.held, page.held_to); !r) return r;
  }
  auto report = page.cloth->step(dt);
  if (!report) return Error{report.error()};
  page.report = report.value();
  read(page);
  return {};
}

}  // namespace

extern "C" {

EMSCRIPTEN_KEEPALIVE int page_begin(int scene, unsigned side, const char* material,
                                    double tolerance, int substeps, double wind, int self_contact,
                                    int goes_on) {
  return answer(begin({.scene = static_cast<Scene>(scene),
                       .side = side,
                       .material = material,
                       .settings = {.tolerance = tolerance, .substeps = substeps},
                       .wind = {wind, 0, 0.4 * wind},
                       .self_contact = self_contact != 0},
                      goes_on != 0));
}
EMSCRIPTEN_KEEPALIVE int page_advance(double dt) { return answer(advance(*shown, dt)); }
EMSCRIPTEN_KEEPALIVE int page_hold(unsigned particle) {
  return answer(take_hold(*shown, particle));
}
EMSCRIPTEN_KEEPALIVE void page_drag(double x, double y, double z) { shown->held_to = {x, y, z}; }
/// Pins of the scene stay pins.
EMSCRIPTEN_KEEPALIVE int page_let_go() {
  const std::uint32_t held = std::exchange(shown->held, kNoIndex);
  if (held == kNoIndex || is_fixed(*shown, held)) return 0;
  return answer(shown->cloth->change({.release = {held}}));
}
EMSCRIPTEN_KEEPALIVE int page_set_wind(double wind) {
  shown->choices.wind = {wind, 0, 0.4 * wind};
  return answer(shown->cloth->set_wind(shown->choices.wind));
}

EMSCRIPTEN_KEEPALIVE const char* page_message() { return message.c_str(); }
EMSCRIPTEN_KEEPALIVE const char* page_status() { return name(shown->report.status).data(); }
/// Strain, error of the laws, substeps, pairs of the cloth that touch bodies, and that touch
/// each other.
EMSCRIPTEN_KEEPALIVE double page_figure(int which) {
  const StepReport& r = shown->report;
  const double figures[] = {r.max_strain, r.max_error, static_cast<double>(r.substeps),
                            static_cast<double>(r.body_contacts),
                            static_cast<double>(r.self_contacts)};
  return figures[which];
}
EMSCRIPTEN_KEEPALIVE unsigned page_particles() { return shown->cloth->particle_count(); }
EMSCRIPTEN_KEEPALIVE const float* page_places() { return shown->places.data(); }
EMSCRIPTEN_KEEPALIVE unsigned page_corners() { return shown->triangles.size(); }
EMSCRIPTEN_KEEPALIVE const std::uint32_t* page_triangles() { return shown->triangles.data(); }
EMSCRIPTEN_KEEPALIVE unsigned page_pins() { return shown->scene.fixed.size(); }
EMSCRIPTEN_KEEPALIVE const std::uint32_t* page_pin_list() { return shown->scene.fixed.data(); }
/// x y z of the position, x y z w of the rotation, one after the other.
EMSCRIPTEN_KEEPALIVE double page_pose(unsigned body, int which) {
  const Pose& p = shown->bodies[body].pose;
  const double numbers[] = {p.position.x, p.position.y, p.position.z, p.rotation.x,
                            p.rotation.y, p.rotation.z, p.rotation.w};
  return numbers[which];
}

}  // extern "C"
