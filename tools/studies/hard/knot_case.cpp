/// A reef knot of two ribbons that is pulled tight.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "tools/scenes/cloth.h"
#include "tools/scenes/sheet.h"
#include "tools/studies/hard/body_trial.h"
#include "tools/studies/hard/suite.h"

namespace weft::tools::hard {
namespace {

constexpr double kUnit = 0.15, kOver = 0.008;  // m; m, of a ribbon over the middle

/// The bight from the left, in units along x and y and in kOver along z: over the end of the other
/// bight, under its strand, over both its strands, and back likewise. The other bight is this one,
/// half a turn about y.
constexpr std::array<Vec3, 13> kBight{{{-4, 0.5, 0},
                                       {-2, 0.45, 0.5},
                                       {-1, 0.45, 1},
                                       {0, 0.75, -1},
                                       {0.6, 0.95, 0},
                                       {1, 0.45, 1},
                                       {1.15, 0, 1},
                                       {1, -0.45, 1},
                                       {0.6, -0.95, 0},
                                       {0, -0.75, -1},
                                       {-1, -0.45, 1},
                                       {-2, -0.45, 0.5},
                                       {-4, -0.5, 0}}};

Vec3 scaled(Vec3 p) { return {kUnit * p.x, kUnit * p.y, kOver * p.z}; }

/// A smooth curve through all points (Catmull and Rom), densely.
std::vector<Vec3> smooth_bight() {
  constexpr int kParts = 100;
  std::vector<Vec3> curve;
  const auto at = [](std::size_t i) { return scaled(kBight[std::min(i, kBight.size() - 1)]); };
  for (std::size_t i = 0; i + 1 < kBight.size(); ++i) {
    const Vec3 a = at(i > 0 ? i - 1 : 0), b = at(i), c = at(i + 1), d = at(i + 2);
    for (int part = 0; part < kParts; ++part) {
      const double t = static_cast<double>(part) / kParts;
      curve.push_back(0.5 * (2 * b + t * (c - a) + t * t * (2 * a - 5 * b + 4 * c - d) +
                             t * t * t * (3 * b - a - 3 * c + d)));
    }
  }
  curve.push_back(at(kBight.size() - 1));
  return curve;
}

/// Points along a curve, each so far from the one before, as many as there is room for.
std::vector<Vec3> stepped(const std::vector<Vec3>& curve, double step) {
  std::vector<Vec3> points{curve.front()};
  double left = step;
  for (std::size_t i = 0; i + 1 < curve.size(); ++i) {
    Vec3 from = curve[i];
    for (double way = length(curve[i + 1] - from); way >= left; way = length(curve[i + 1] - from)) {
      from = from + (left / way) * (curve[i + 1] - from);
      points.push_back(from);
      left = step;
    }
    left -= length(curve[i + 1] - from);
  }
  return points;
}

/// A ribbon that stands on its edge along the middle line.
void add_ribbon(const std::vector<Vec3>& middle, double width, int columns, double turned,
                scenes::Layout& layout) {
  const double cell = width / (columns - 1);
  const auto rows = static_cast<int>(middle.size());
  const auto first = static_cast<std::uint32_t>(layout.start.size());
  const auto place = [&](int i, int j) {
    const auto row = static_cast<std::size_t>(i);
    const Vec3 way = middle[std::min(row + 1, middle.size() - 1)] - middle[row > 0 ? row - 1 : 0];
    const Vec3 across = Vec3{0, 0, 1} - (way.z / dot(way, way)) * way;
    const Vec3 p = middle[row] + ((cell * j - width / 2) / length(across)) * across;
    return Vec3{turned * p.x, p.y, turned * p.z};
  };
  scenes::add_sheet(rows, columns, place, layout);
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j)
      layout.rest.push_back({length(middle[1] - middle[0]) * i, turned, cell * j});
  }
  for (const int row : {0, rows - 1}) {
    for (int j = 0; j < columns; ++j)
      layout.pins.push_back(first + static_cast<std::uint32_t>(row * columns + j));
  }
}

/// Both ends of each ribbon are drawn away from those of the other.
Outcome run_reef_knot(const Setup& setup) {
  constexpr double kWidth = 0.008, kWay = 0.25, kSpeed = 0.25;  // m, m, m/s
  const double step = setup.quick ? 0.008 : 0.004;
  const std::vector<Vec3> middle = stepped(smooth_bight(), step);
  scenes::Layout layout;
  for (const double turned : {1., -1.})
    add_ribbon(middle, kWidth, setup.quick ? 2 : 3, turned, layout);
  auto made = scenes::cloth_of(layout, {.material = find_material("cotton").value()});
  SceneDescription scene = std::move(made.value().description);
  scene.self_contact.on = true;
  scene.gravity = {};
  Trial trial = trial_of(setup, scene, {});
  trial.before_step = [=](Cloth& cloth, int frame) {
    const double way = std::min(kWay, kSpeed * (frame + 1) / 60);
    for (const std::uint32_t pin : scene.fixed) {
      const Vec3 from = scene.positions[pin];
      (void)cloth.move_fixed(pin, {from.x + std::copysign(way, from.x), from.y, from.z});
    }
  };
  trial.steps = setup.steps(90, 45);
  const Observed o = observe(trial);
  Outcome result = honesty_outcome(o, kAnyEnergy);
  result.figure = static_cast<double>(o.crossings);
  return result;
}

}  // namespace

std::vector<Case> knot_cases() {
  const auto by_itself = [](const Method& method) { return label(method) == "auto"; };
  return {{"layers_of_a_reef_knot", "pairs of triangles that cross", 0, run_reef_knot, by_itself}};
}

}  // namespace weft::tools::hard
