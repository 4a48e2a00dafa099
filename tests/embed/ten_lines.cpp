#include <weft/mesh.h>

#include <cstdio>

int main() {
  weft::MeshDescription mesh;  // vertices (m) and faces, as a file has them; pins are fixed
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}};
  mesh.corners = {0, 1, 4, 3, 1, 2, 5, 4}, mesh.face_sizes = {4, 4}, mesh.pins = {0, 2};
  mesh.material = weft::find_material("cotton").value();
  const auto model = weft::build_model(weft::cloth_from_mesh(mesh).value().scene).value();
  auto cloth = weft::Cloth::create(model, {.tolerance = 0.01}).value();  // 1 %
  const auto ball = weft::build_shape(weft::Ball{{1, -1, 1}, 0.3}).value();
  (void)cloth.add_body({.shape = ball, .friction = 0.4});
  for (int frame = 0; frame < 60; ++frame) {
    const weft::StepReport report = cloth.step(1.0 / 60).value();
    if (report.status != weft::Status::converged) std::puts(name(report.status).data());
  }
  std::printf("after 1 s a free corner is at y = %g m\n", cloth.position(3).y);
}
