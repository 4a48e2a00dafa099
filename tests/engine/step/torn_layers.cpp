/// Halves of a sheet that was torn in two, laid over each other along their torn borders.
#include <doctest/doctest.h>

#include <weft/mesh.h>
#include <weft/weft.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "engine/model/change.h"
#include "tests/support/clothes.h"
#include "tests/support/crossing_triangles.h"
#include "tests/support/sheets.h"

namespace weft::test::engine_step_torn_layers {
namespace {

constexpr double kLength = 0.4, kWidth = 0.2, kThickness = 2e-3;  // m
constexpr double kRates[] = {30, 60, 240};                        // Hz

/// A level strip along x with a waist, in which it tears; pinned at both ends.
MeshCloth strip(std::uint32_t cells, Cut cut) {
  const auto place = [=](double row, double column) {
    const double u = row / (2 * cells), v = column / cells - 0.5;
    return Vec3{kLength * u, 0, kWidth * (1 - 0.4 * std::sin(std::numbers::pi * u)) * v};
  };
  MeshDescription mesh = sheet(2 * cells + 1, cells + 1, place, [=](auto i, auto j) {
    return cut != Cut::none && (i + j) % 2 == 1 ? Cut::second : cut;
  });
  mesh.material = {
      .density = 0.2, .warp = 200, .weft = 200, .shear = 40, .bending = 1e-6, .damping_motion = 3};
  mesh.material->strength = 10;
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v)
    if (mesh.positions[v].x == 0 || mesh.positions[v].x == kLength) mesh.pins.push_back(v);
  auto made = cloth_from_mesh(mesh);
  REQUIRE_MESSAGE(made, made.error());
  made.value().scene.self_contact = {.on = true, .thickness = kThickness, .friction = 0.3};
  made.value().scene.gravity = {0, -10, 0};
  return std::move(made).value();
}

class Halves {
 public:
  Halves(const MeshCloth& made, double rate)
      : start_(made.scene.positions), cloth_(cloth_of(made.scene, {})), dt_(1 / rate) {
    for (const std::uint32_t pin : made.scene.fixed) pins_.push_back(pin);
    Body floor;
    floor.shape = build_shape(Plane{.normal = {0, 1, 0}, .offset = -0.03}).value();
    REQUIRE(cloth_.add_body(floor));
  }

  Cloth& cloth() { return cloth_; }
  /// Moves the pins of the right end there, from where they began.
  StepReport put(double x, double y) {
    for (const std::uint32_t pin : pins_) {
      const Vec3 at = start_[pin];
      if (at.x > 0) REQUIRE(cloth_.move_fixed(pin, {at.x + x, at.y + y, at.z}));
    }
    const auto report = cloth_.step(dt_);
    REQUIRE_MESSAGE(report, report.error());
    CHECK(committed(report.value().status));
    return report.value();
  }
  int crossings() const {
    std::vector<Vec3> places;
    for (std::uint32_t i = 0; i < cloth_.particle_count(); ++i)
      places.push_back(cloth_.position(i));
    return count_self_crossings({places, cloth_.surface()});
  }
  bool are_parted() const {
    std::vector<std::uint32_t> first(cloth_.particle_count());
    std::iota(first.begin(), first.end(), 0u);
    const auto first_of = [&](std::uint32_t i) {
      while (first[i] != i) i = first[i] = first[first[i]];
      return i;
    };
    for (const auto& [a, b, c] : cloth_.surface()) {
      for (const std::uint32_t p : {b, c}) {
        const auto [low, high] = std::minmax({first_of(a), first_of(p)});
        first[high] = low;
      }
    }
    return first_of(pins_.front()) != first_of(pins_.back());
  }

 private:
  std::vector<Vec3> start_;
  std::vector<std::uint32_t> pins_;
  Cloth cloth_;
  double dt_;
};

TEST_CASE("halves of a torn sheet are laid over each other and do not cross") {
  for (const Cut cut : {Cut::none, Cut::first}) {
    for (const double rate : kRates) {
      CAPTURE(rate);
      Halves halves(strip(8, cut), rate);
      double x = 0;
      while (!halves.are_parted()) {
        halves.put(x += 0.2 / rate, 0);
        REQUIRE(x < 1);
      }
      while (x < 0.4) halves.put(x += 0.2 / rate, 0);
      CHECK(halves.crossings() == 0);
      const auto seams = [&] { return description_of(*halves.cloth().model()).seams.size(); };
      CHECK(seams() == 0);  // all flanks are free of each other
      // Back, with the torn borders over each other, and on over the other half.
      for (; x > -0.25; x -= 0.4 / rate) {
        const StepReport report = halves.put(x, 0.02 * std::min(1.0, (0.4 - x) / 0.1));
        CHECK(report.tangled == 0);
        CHECK(halves.crossings() == 0);
      }
      for (int i = 0; i < rate; ++i) {
        halves.put(x, 0.02);
        CHECK(halves.crossings() == 0);
      }
    }
  }
}

}  // namespace
}  // namespace weft::test::engine_step_torn_layers
