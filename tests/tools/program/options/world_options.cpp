#include "tools/program/options/world_options.h"

#include <doctest/doctest.h>

#include "tests/tools/run_program.h"
#include "tests/tools/temporary_folder.h"

namespace weft::tools {
namespace {

SceneDescription two_particles() {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}};
  scene.masses = {1, 1};
  scene.constraints = {{0, 1, 1}};
  return scene;
}

TEST_CASE("without options a scene stays what it is") {
  SceneDescription scene = two_particles();
  std::vector<SceneBody> bodies;
  scene.damping.motion = 3;
  REQUIRE(surround({}, scene, bodies));
  CHECK(scene.gravity.y == -10);
  CHECK(scene.damping.motion == 3);
  CHECK(scene.positions.size() == 2);
  CHECK(scene.radii.empty());
}

TEST_CASE("gravity and the decay of motion are replaced") {
  SceneDescription scene = two_particles();
  std::vector<SceneBody> bodies;
  REQUIRE(surround({.gravity = "1,-2,3.5", .damping_motion = 0.5}, scene, bodies));
  CHECK(scene.gravity.x == 1);
  CHECK(scene.gravity.y == -2);
  CHECK(scene.gravity.z == 3.5);
  CHECK(scene.damping.motion == 0.5);
}

TEST_CASE("spheres are the last particles, fixed if they have no mass") {
  SceneDescription scene = two_particles();
  std::vector<SceneBody> bodies;
  scene.velocities = {{}, {1, 2, 3}};
  REQUIRE(surround({.spheres = {"0,-1,0,0.5", "2,-1,0,0.25,7"}}, scene, bodies));
  CHECK(scene.spheres == std::vector<std::uint32_t>{2, 3});
  CHECK(scene.radii == std::vector<double>{0, 0, 0.5, 0.25});
  CHECK(scene.fixed == std::vector<std::uint32_t>{2});
  CHECK(scene.masses[3] == 7);
  CHECK(scene.positions[3].x == 2);
  CHECK(build_model(scene));
}

TEST_CASE("planes are the last bodies, and friction and thickness are those of all") {
  SceneDescription scene = two_particles();
  std::vector<SceneBody> bodies{{.shape = Ball{.radius = 1}}};
  REQUIRE(surround({.planes = {"0,2,0,-1"}, .friction = 0.5, .thickness = 0.002}, scene, bodies));
  REQUIRE(bodies.size() == 2);
  CHECK(std::get<Plane>(bodies[1].shape).offset == -1);
  CHECK(scene.friction == 0.5);
  for (const SceneBody& body : bodies) {
    CHECK(body.friction == 0.5);
    CHECK(body.thickness == 0.002);
  }
}

TEST_CASE("self-contact is on or off, or what the scene has") {
  SceneDescription scene = two_particles();
  std::vector<SceneBody> bodies;
  REQUIRE(surround({.self_contact = "on"}, scene, bodies));
  CHECK(scene.self_contact.on);
  REQUIRE(surround({}, scene, bodies));
  CHECK(scene.self_contact.on);
  REQUIRE(surround({.self_contact = "off"}, scene, bodies));
  CHECK_FALSE(scene.self_contact.on);
}

TEST_CASE("air presses on the faces of a scene, as a ram pressure, a given one or that of a gas") {
  SceneDescription scene = two_particles();
  std::vector<SceneBody> bodies;
  scene.positions.push_back({0, 0, 1});
  scene.masses.push_back(1);
  scene.surface = {{0, 1, 2}};
  REQUIRE(surround({.ram = 1.2, .pressure = -30}, scene, bodies));
  CHECK(scene.air.ram == 1.2);
  CHECK(scene.air.triangles == scene.surface);
  REQUIRE(scene.pressures.size() == 1);
  CHECK(scene.pressures[0] == Pressure{.pressure = -30});
  REQUIRE(surround({.pressure = 40, .gas = true}, scene, bodies));
  CHECK(scene.pressures == std::vector<Pressure>{{.pressure = 40, .gas = true}});
  REQUIRE(surround({}, scene, bodies));
  CHECK(scene.pressures.size() == 1);
}

TEST_CASE("what is wrong with the surroundings is refused by option and value") {
  const auto error_of = [](const WorldOptions& options) {
    SceneDescription scene = two_particles();
    std::vector<SceneBody> bodies;
    const auto surrounded = surround(options, scene, bodies);
    REQUIRE_FALSE(surrounded);
    return surrounded.error();
  };
  CHECK(error_of({.gravity = "1,2"}) == "--gravity: '1,2' is not x,y,z");
  CHECK(error_of({.planes = {"1,2,3"}}) == "--plane: '1,2,3' is not nx,ny,nz,d");
  CHECK(error_of({.planes = {"0,0,0,1"}}) ==
        "--plane: '0,0,0,1': normal: has no direction (0, 0, 0)");
  CHECK(error_of({.friction = 1}) == "--friction: only scenes with bodies have it");
  CHECK(error_of({.planes = {"0,1,0,0"}, .thickness = -1}) == "--thickness: -1 is below 0");
  CHECK(error_of({.self_contact = "1"}) == "--self-contact: '1' is not on or off");
  CHECK(error_of({.damping_motion = -1}) == "--damping-motion: -1 is below 0");
  CHECK(error_of({.ram = -1}) == "--ram: -1 is below 0");
  CHECK(error_of({.ram = 1}) == "--ram: the scene has no faces");
  CHECK(error_of({.pressure = 1}) == "--pressure: the scene has no faces");
  CHECK(error_of({.gas = true}) == "--gas: needs --pressure");
  CHECK(error_of({.spheres = {"1,2,3"}}) ==
        "--sphere: '1,2,3' is not x,y,z,radius or x,y,z,radius,mass");
  CHECK(error_of({.spheres = {"1,2,3,x"}}).starts_with("--sphere: '1,2,3,x' is not"));
  CHECK(error_of({.spheres = {"1,2,3,0"}}) == "--sphere: '1,2,3,0': the radius is not above 0");
  CHECK(error_of({.spheres = {"1,2,3,1,0"}}) == "--sphere: '1,2,3,1,0': the mass is not above 0");
}

TEST_CASE("every kind of scene can be surrounded") {
  const TemporaryFolder folder;
  const std::string around = " --size 7 --steps 60 --gravity 0,-5,0 --damping-motion 2";
  const auto alone = report_of(folder, "hang" + around);
  const auto held = report_of(folder, "hang --sphere 0.5,-0.45,0.5,0.2" + around);
  CHECK(held["spheres"] == 1);
  CHECK(held["lowest_y"] > alone["lowest_y"]);
  const std::string file = folder.file("scene.json");
  const std::string write =
      "scene hang --size 7 --sphere 0,1,2,0.5,3 --gravity 0,0,-1 --out " + file;
  CHECK(run_program(folder, write).exit_code == 0);
  CHECK(report_of(folder, file + " --steps 2 --sphere 5,5,5,1")["spheres"] == 2);
}

}  // namespace
}  // namespace weft::tools
