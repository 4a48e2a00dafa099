// The skirt of a character who walks, comes nearer, and drops it.
#include <weft/surface.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <numbers>

template <class T>
T need(weft::Result<T> result) {
  if (!result) std::exit((std::puts(result.error().c_str()), 1));
  if constexpr (!std::is_void_v<T>) return std::move(result).value();
}

weft::Vec3 walk(weft::Vec3 p, double t) { return {p.x, p.y, p.z + 1.2 * t}; }
weft::Pose leg(double time, unsigned id) {
  const double side = id == 0 ? -1 : 1, half = 0.2 * side * std::sin(6 * time);  // of its angle
  return {walk({0.075 * side, 0.9, 0}, time), {std::sin(half), 0, 0, std::cos(half)}};
}
weft::MeshDescription skirt(unsigned around, unsigned rows) {
  weft::MeshDescription mesh;
  for (unsigned i = 0; i < around * rows; ++i) {
    const double turn = 2 * std::numbers::pi * i / around, down = i / around / (rows - 1.);
    const double x = std::cos(turn) * (0.15 + 0.2 * down), z = std::sin(turn) * (0.15 + 0.2 * down);
    mesh.positions.push_back({x, 1 - 0.5 * down, z});
    const unsigned left = (i + 1) % around > 0 ? i + 1 : i + 1 - around;
    if (i < around) mesh.pins.push_back(i);
    if (i >= around) mesh.corners.insert(mesh.corners.end(), {i - around, left - around, left, i});
  }
  mesh.face_sizes.assign(around * (rows - 1), 4);
  mesh.material = need(weft::find_material("cotton"));
  return mesh;
}
weft::Cloth dressed(const weft::MeshCloth& made) {
  weft::Cloth cloth = need(weft::Cloth::create(need(weft::build_model(made.scene)),
                                               {.max_iterations = 100, .threads = 1}));
  const auto bone = need(weft::build_shape(weft::Capsule{{}, {0, -0.8, 0}, 0.07, 0.05}));
  for (unsigned id : {0, 1}) need(cloth.add_body({.shape = bone, .pose = leg(0, id)}));
  return cloth;
}

int main() {
  const auto mesh = skirt(60, 30), far_mesh = skirt(24, 12);
  const auto made = need(cloth_from_mesh(mesh)), far_made = need(cloth_from_mesh(far_mesh));
  weft::Cloth near = dressed(made), far = dressed(far_made);
  auto drawn = need(surface_of_mesh(mesh, made));
  auto far_drawn = need(map_surface(far_mesh, far_made, mesh));
  std::vector<float> vertices(6 * mesh.positions.size());  // of both: position and normal
  const auto ms = [] { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
  double error = 0, begin = ms();
  for (int frame = 1; frame <= 360; ++frame) {  // 120 far away, 120 near, 120 while it falls
    weft::Cloth& cloth = frame <= 120 ? far : near;
    const weft::SceneDescription& start = (frame <= 120 ? far_made : made).scene;
    std::vector<weft::Vec3> waist;
    for (auto pin : start.fixed) waist.push_back(walk(start.positions[pin], frame / 60.));
    if (frame == 121) need(far_drawn.copy_shape(far, near));
    const auto put = frame == 121 ? &weft::Cloth::place_body : &weft::Cloth::move_body;
    if (frame <= 240) need(cloth.move_fixed(start.fixed, waist));
    if (frame == 241) need(near.change({.release = start.fixed}));
    for (unsigned id : {0, 1}) need((cloth.*put)(id, leg(frame / 60., id)));
    error = std::fmax(error, need(cloth.step(1 / 60.)).max_error);
    auto& surface = frame <= 120 ? far_drawn : drawn;
    need(surface.read_vertices(cloth, {vertices, 6}, {std::span(vertices).subspan(3), 6}));
    if (frame % 120 > 0) continue;
    std::printf("%zu particles: %.2f ms a frame\n", cloth.particle_count(), (ms() - begin) / 120);
    begin = ms();
  }
  return std::printf("largest error %.2f %%\n", 100 * error), error > 0.01;
}
