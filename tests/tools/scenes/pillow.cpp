/// The pillow is closed, and swells to a volume that two flat sheets of its size can hold.
#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <map>
#include <utility>

#include "tools/scenes/body_moves.h"
#include "tools/scenes/scenes.h"

namespace weft::scenes {
namespace {

double volume(const SceneDescription& scene, const std::vector<Vec3>& x) {
  double sum = 0;
  for (const auto& [a, b, c] : scene.surface) {
    const Vec3 p = x[a], q = x[b], r = x[c];
    sum += p.x * (q.y * r.z - q.z * r.y) + p.y * (q.z * r.x - q.x * r.z) +
           p.z * (q.x * r.y - q.y * r.x);
  }
  return sum / 6;
}

TEST_CASE("each edge of the pillow has one triangle on either side") {
  const Scene pillow = make_scene("pillow", {.size = 9}).value();
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> ways;
  for (const auto& t : pillow.description.surface) {
    for (const int k : {0, 1, 2}) CHECK(++ways[{t[k], t[(k + 1) % 3]}] == 1);
  }
  for (const auto& [way, count] : ways) CHECK(ways.contains({way.second, way.first}));
}

TEST_CASE("the pillow swells, and comes to lie on its floor") {
  const auto [description, mesh, bodies, moves] = make_scene("pillow", {.size = 13}).value();
  Cloth cloth = Cloth::create(build_model(description).value(), {.threads = 1}).value();
  REQUIRE(tools::MovedBodies::add(bodies, cloth));
  for (int frame = 0; frame < 120; ++frame)
    REQUIRE(cloth.step(1. / 60).value().status == Status::converged);
  const std::vector<Vec3> now = tools::particle_positions(cloth);
  // A square sack of inextensible cloth of 1 m x 1 m holds 0.2 m^3 at most ("teabag").
  CHECK(volume(description, now) > 0.12);
  CHECK(volume(description, now) < 0.22);
  CHECK(cloth.bounds().least.y < 0.01);
  CHECK(cloth.bounds().least.y > 0);
}

}  // namespace
}  // namespace weft::scenes
