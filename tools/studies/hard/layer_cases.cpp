/// Cloth that touches itself: thrown, laid exactly, pulled tight, inflated, dropped by the hundred,
/// dragged.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "tools/scenes/cloth.h"
#include "tools/scenes/sheet.h"
#include "tools/scenes/splitmix.h"
#include "tools/studies/hard/body_trial.h"
#include "tools/studies/hard/suite.h"

namespace weft::tools::hard {
namespace {

constexpr double kPi = std::numbers::pi;

/// Automatic, which becomes small steps: others refuse self-contact.
bool takes_layers(const Method& method) { return label(method) == "auto"; }

Material cotton_of_layers() { return find_material("cotton").value(); }

/// m, of layers.
double layer_thickness() { return cotton_of_layers().thickness; }

SceneDescription layers_of(const scenes::Layout& layout) {
  auto made = scenes::cloth_of(layout, {.material = cotton_of_layers()});
  SceneDescription scene = std::move(made.value().description);
  scene.self_contact.on = true;
  return scene;
}

/// The figure is how many pairs of triangles cross.
Outcome crossing_outcome(const Observed& o, double energy) {
  Outcome result = strain_outcome(o, energy);
  result.figure = static_cast<double>(o.crossings);
  return result;
}
/// Likewise, of cases that may miss a tolerance, and say so.
Outcome honest_crossing_outcome(const Observed& o, double energy = kAnyEnergy) {
  Outcome result = honesty_outcome(o, energy);
  result.figure = static_cast<double>(o.crossings);
  return result;
}

TrialBody floor_at(double height) { return {Plane{{0, 1, 0}, height}, 0.3, stays()}; }

// --------------------------------------------------------------------------------------- thrown

/// A folded sheet with waves flies by 10 m/s into the corner between three planes.
Outcome run_ball_into_corner(const Setup& setup) {
  constexpr double kSpeed = 10, kWave = 0.006;  // m/s; m, of layers 4 cm apart
  SceneDescription scene =
      scenes::make("fold", {.size = setup.quick ? 20 : 40, .material = cotton_of_layers()}).value();
  const double along = -kSpeed / std::sqrt(3.);
  for (Vec3& p : scene.positions) {
    p = p + kWave * Vec3{std::sin(31 * p.z), std::sin(23 * p.z + 17 * p.x), std::sin(29 * p.x)};
    p = p + Vec3{0.35, 0.05, 0.65};
    scene.velocities.push_back({along, along, along});
  }
  scene.gravity = {};
  Trial trial = trial_of(
      setup, std::move(scene),
      {{Plane{{1, 0, 0}, 0}, 0.3, stays()}, floor_at(0), {Plane{{0, 0, 1}, 0}, 0.3, stays()}});
  trial.steps = setup.steps(120, 15);
  return honest_crossing_outcome(observe(trial));
}

// ----------------------------------------------------------------------------------------- laid

/// Sheets whose vertices lie above each other, exactly at their distance, on a floor.
Outcome run_touch_exactly(const Setup& setup) {
  constexpr int kLayers = 4;
  const int size = setup.quick ? 10 : 20;
  scenes::Layout layout;
  for (int layer = 0; layer < kLayers; ++layer) {
    const auto place = [&](int i, int j) {
      return Vec3{0.02 * i, kThickness + layer * layer_thickness(), 0.02 * j};
    };
    scenes::add_sheet(size, size, place, layout);
  }
  Trial trial = trial_of(setup, layers_of(layout), {floor_at(0)});
  trial.steps = setup.steps(120, 20);
  const Observed o = observe(trial);
  return crossing_outcome(o, energy_allowed(o) + 1e-6);
}

/// Two sheets lie in one plane, and their borders at one place.
Outcome run_border_on_border(const Setup& setup) {
  const int size = setup.quick ? 8 : 16;
  scenes::Layout layout;
  for (int side = 0; side < 2; ++side) {
    const auto place = [&](int i, int j) {
      return Vec3{0.02 * (i + side * (size - 1)), kThickness, 0.02 * j};
    };
    scenes::add_sheet(size, size, place, layout);
  }
  for (std::size_t v = layout.start.size() / 2; v < layout.start.size(); ++v)
    layout.start[v].z += 1e-9;  // not one vertex, which would be welded
  Trial trial = trial_of(setup, layers_of(layout), {floor_at(0)});
  trial.steps = setup.steps(120, 20);
  return honest_crossing_outcome(observe(trial));
}

// --------------------------------------------------------------------------------------- pulled

/// A strip over a rod of 3 mm whose ends are pulled down beside each other until it is taut.
Outcome run_fold_over_edge(const Setup& setup) {
  constexpr double kHalf = 0.25, kRod = 0.003, kBend = 0.02;       // m
  constexpr double kTaut = 1.005, kApart = 0.002, kSeconds = 0.5;  // m, s
  const int across = setup.quick ? 4 : 9, along = setup.quick ? 51 : 101;
  const double cell = 2 * kHalf / (along - 1);
  scenes::Layout layout;
  const auto place = [&](int i, int j) {
    const double s = cell * i - kHalf, hangs = std::abs(s) - kPi / 2 * kBend;
    const double x = hangs > 0 ? std::copysign(kBend, s) : kBend * std::sin(s / kBend);
    const double y = hangs > 0 ? -hangs : kBend * std::cos(s / kBend);
    return Vec3{x, y, cell * j};
  };
  scenes::add_sheet(along, across, place, layout);
  for (int i = 0; i < along; ++i) {
    for (int j = 0; j < across; ++j) layout.rest.push_back({cell * i, 0, cell * j});
  }
  for (int j = 0; j < across; ++j) {
    layout.pins.push_back(static_cast<std::uint32_t>(j));
    layout.pins.push_back(static_cast<std::uint32_t>((along - 1) * across + j));
  }
  const SceneDescription scene = layers_of(layout);
  const double round = kPi / 2 * (kRod + kThickness);
  const double down = kTaut * (kHalf - round) - (kHalf - kPi / 2 * kBend);
  Trial trial =
      trial_of(setup, scene, {{Capsule{{0, 0, -1}, {0, 0, 1}, kRod, kRod}, 0.3, stays()}});
  trial.before_step = [=](Cloth& cloth, int step) {
    const double share = std::min(1.0, (step + 1) / 60. / kSeconds);
    for (const std::uint32_t pin : scene.fixed) {
      const Vec3 from = scene.positions[pin];
      const double x = from.x + share * (std::copysign(kApart / 2, from.x) - from.x);
      (void)cloth.move_fixed(pin, {x, from.y - share * down, from.z});
    }
  };
  trial.steps = setup.steps(120, 40);
  return honest_crossing_outcome(observe(trial));
}

// ------------------------------------------------------------------------------------- inflated

/// Two square sheets that are one at their borders, 2 mm apart between them.
scenes::Layout flat_bag(int size) {
  constexpr double kWidth = 0.4, kGap = 0.002;  // m
  const double cell = kWidth / (size - 1);
  scenes::Layout layout;
  for (const double side : {1., -1.}) {
    const auto place = [&](int i, int j) {
      const bool is_border = std::min(i, j) == 0 || std::max(i, j) == size - 1;
      return Vec3{cell * i, is_border ? 0 : side * kGap / 2, cell * j};
    };
    scenes::add_sheet(size, size, place, layout);
  }
  for (std::size_t f = layout.faces.size() / 2; f < layout.faces.size(); ++f)
    std::ranges::reverse(layout.faces[f]);  // outside is outside
  return layout;
}

/// N, a third of the pressure on each triangle for each corner.
std::vector<Vec3> pressed(const SceneDescription& scene, const Cloth& cloth, double pressure) {
  std::vector<Vec3> forces(scene.positions.size());
  for (const auto& [a, b, c] : scene.surface) {
    const Vec3 x = cloth.position(a);
    const Vec3 force = (pressure / 6) * cross(cloth.position(b) - x, cloth.position(c) - x);
    for (const std::uint32_t corner : {a, b, c}) forces[corner] = forces[corner] + force;
  }
  return forces;
}

/// A bag is inflated by 200 Pa, and then sucked empty by a tenth of it.
Outcome run_bag(const Setup& setup) {
  constexpr double kPressure = 200;  // Pa
  const SceneDescription scene = layers_of(flat_bag(setup.quick ? 13 : 25));
  Trial trial = trial_of(setup, scene, {floor_at(-0.1)});
  trial.steps = setup.steps(180, 40);
  const int turn = trial.steps / 2;
  trial.before_step = [=](Cloth& cloth, int step) {
    const double share = std::min(1.0, 2.0 * step / turn);
    const double pressure = step < turn ? share * kPressure : -0.1 * kPressure;
    (void)cloth.write_forces(pressed(scene, cloth, pressure));
  };
  return honest_crossing_outcome(observe(trial));
}

// -------------------------------------------------------------------------------------- dropped

/// Squares of 6 cm, turned by chance, fall into a box that is half a metre wide.
Outcome run_loose_pieces(const Setup& setup) {
  constexpr int kSize = 4, kRows = 5;
  constexpr double kPiece = 0.06, kRoom = 0.1, kCell = kPiece / (kSize - 1);  // m
  const int pieces = setup.quick ? 50 : 300;
  scenes::SplitMix random(57);
  scenes::Layout layout;
  for (int piece = 0; piece < pieces; ++piece) {
    const Vec3 middle{kRoom * (0.5 + piece % kRows), kRoom * (0.5 + piece / (kRows * kRows)),
                      kRoom * (0.5 + piece / kRows % kRows)};
    const double turn = 2 * kPi * random.unit(), lean = kPi * random.unit();
    const auto place = [&](int i, int j) {
      const double u = kCell * i - kPiece / 2, v = kCell * j - kPiece / 2;
      const double x = u * std::cos(lean), y = u * std::sin(lean);
      return middle + Vec3{x * std::cos(turn) + v * std::sin(turn), y,
                           v * std::cos(turn) - x * std::sin(turn)};
    };
    scenes::add_sheet(kSize, kSize, place, layout);
  }
  const double far = -kRoom * kRows;
  Trial trial = trial_of(setup, layers_of(layout),
                         {floor_at(0),
                          {Plane{{1, 0, 0}, 0}, 0.3, stays()},
                          {Plane{{-1, 0, 0}, far}, 0.3, stays()},
                          {Plane{{0, 0, 1}, 0}, 0.3, stays()},
                          {Plane{{0, 0, -1}, far}, 0.3, stays()}});
  trial.steps = setup.steps(180, 30);
  const Observed o = observe(trial);
  return honest_crossing_outcome(o, energy_allowed(o));
}

// -------------------------------------------------------------------------------------- dragged

/// A sheet on another one is dragged to and fro by its border, which is as fast as 5 m/s.
Outcome run_dragged(const Setup& setup, double dt) {
  constexpr double kWay = 0.2, kSpeed = 5;  // m, m/s
  const int size = setup.quick ? 10 : 20;
  const double cell = 0.4 / (size - 1);
  scenes::Layout layout;
  for (int layer = 0; layer < 3; ++layer) {
    const auto place = [&](int i, int j) {
      return Vec3{cell * i, kThickness + 1.5e-3 * layer, cell * j};
    };
    scenes::add_sheet(size, size, place, layout);
  }
  for (int layer = 0; layer < 2; ++layer) {  // the lowest stands still, that in the middle is free
    for (int j = 0; j < size; ++j)
      layout.pins.push_back(static_cast<std::uint32_t>(2 * layer * size * size + j));
  }
  const SceneDescription scene = layers_of(layout);
  Trial trial = trial_of(setup, scene, {floor_at(0)});
  trial.dt = dt;
  trial.steps = static_cast<int>(std::lround((setup.quick ? 0.3 : 1.5) / dt));
  trial.before_step = [=](Cloth& cloth, int step) {
    const double way = kWay * std::sin(kSpeed / kWay * dt * (step + 1));
    for (const std::uint32_t pin : scene.fixed) {
      const Vec3 from = scene.positions[pin];
      if (from.y > 2 * kThickness) (void)cloth.move_fixed(pin, from + Vec3{way, 0, 0});
    }
  };
  return honest_crossing_outcome(observe(trial));
}

}  // namespace

std::vector<Case> layer_cases() {
  const auto dragged = [](double dt) {
    return [=](const Setup& setup) { return run_dragged(setup, dt); };
  };
  const std::pair<const char*, std::function<Outcome(const Setup&)>> all[] = {
      {"layers_in_a_ball_into_a_corner", run_ball_into_corner},
      {"layers_that_touch_exactly", run_touch_exactly},
      {"layers_border_on_border", run_border_on_border},
      {"layers_tight_over_an_edge", run_fold_over_edge},
      {"layers_of_a_bag", run_bag},
      {"layers_of_loose_pieces", run_loose_pieces},
      {"layers_dragged_at_30_hz", dragged(1. / 30)},
      {"layers_dragged_at_240_hz", dragged(1. / 240)},
  };
  std::vector<Case> cases;
  for (const auto& [name, run] : all)
    cases.push_back({name, "pairs of triangles that cross", 0, run, takes_layers});
  return cases;
}

}  // namespace weft::tools::hard
