/// Bodies that are sharp, fast, far away or where the cloth is, and plates that leave no room.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/studies/hard/body_trial.h"
#include "tools/studies/hard/suite.h"

namespace weft::tools::hard {
namespace {

/// A ridge along z from the height -0.3 m to a point at 0, as wide as a hand below.
Hull knife() {
  Hull hull;
  for (const double z : {-1., 1.}) {
    hull.points.insert(hull.points.end(), {{0, 0, z}, {-0.01, -0.3, z}, {0.01, -0.3, z}});
  }
  return hull;
}

/// A cube of 40 cm that stands on a corner, the highest of which is at the origin.
Hull cube_on_its_corner() {
  const double a = std::atan(std::sqrt(2.)), side = 0.4;
  Hull hull;
  for (const Vec3 p : box({side, side, side}).points) {
    const Vec3 about_y{(p.x - p.z) / std::sqrt(2.), p.y, (p.x + p.z) / std::sqrt(2.)};
    hull.points.push_back({about_y.x * std::cos(a) - about_y.y * std::sin(a),
                           about_y.x * std::sin(a) + about_y.y * std::cos(a), about_y.z});
  }
  const double top = std::sqrt(3.) * side / 2;
  for (Vec3& p : hull.points) p.y -= top;
  return hull;
}

Outcome run_falls(const Setup& setup, const ShapeDescription& shape, double friction) {
  SceneDescription scene = cotton(25, 0.8, {0, 0.2, 0});
  scene.friction = friction;
  Trial trial = trial_of(setup, std::move(scene), {{shape, friction, stays()}});
  trial.steps = setup.steps(180, 40);
  return depth_outcome(observe(trial));
}

/// Two plates come nearer to a sheet that lies between them, by 1 m/s, and stop at a gap.
Outcome run_plates(const Setup& setup, double gap) {
  constexpr double kSpeed = 1, kPlate = 0.05, kFrom = 0.1;  // m/s, m
  const auto closes = [=](double side) {
    return [=](double time) {
      const double apart = std::max(gap / 2, kFrom - kSpeed * time);
      return Pose{.position = {0, side * (apart + kPlate / 2), 0}};
    };
  };
  const Hull plate = box({1, kPlate, 1});
  SceneDescription scene = cotton(20, 0.5, {});
  Trial trial =
      trial_of(setup, std::move(scene), {{plate, 0.3, closes(1)}, {plate, 0.3, closes(-1)}});
  for (TrialBody& body : trial.bodies) body.yields = std::max(0.0, kThickness - gap / 2);
  trial.steps = setup.steps(60, 20);
  const Observed o = observe(trial);
  return outcome(o.max_penetration, o, energy_allowed(o));
}

/// A wide plate comes along its normal and takes the sheet with it.
Outcome run_fast_plate(const Setup& setup) {
  constexpr double kSpeed = 100;  // m/s
  const auto flies = [](double time) { return Pose{.position = {0, -1.4 + kSpeed * time, 0}}; };
  Trial trial = trial_of(setup, cotton(20, 0.5, {}), {{box({4, 0.02, 4}), 0.3, flies}});
  trial.steps = setup.steps(20, 6);
  const Observed o = observe(trial);
  Outcome result = depth_outcome(o);
  if (o.went_through && result.failure.empty()) result.failure = "something went through the plate";
  return result;
}

/// A ball flies through a sheet, which it stretches, and takes it along.
Outcome run_fast_ball(const Setup& setup, double speed) {
  const auto flies = [=](double time) {
    return Pose{.position = {0.02, -0.4 + speed * time, 0.01}};
  };
  Trial trial = trial_of(setup, cotton(20, 0.5, {}), {{Ball{.radius = 0.2}, 0.3, flies}});
  trial.steps = setup.steps(40, 12);
  const Observed o = observe(trial);
  return outcome(o.max_penetration, o, energy_allowed(o));
}

/// A sheet falls onto a body that spins, about an axis along z.
Outcome run_spins(const Setup& setup, const ShapeDescription& shape) {
  const auto spins = [](double time) { return Pose{.rotation = turned_about_z(50 * time)}; };
  Trial trial = trial_of(setup, cotton(25, 0.8, {0, 0.25, 0}), {{shape, 0.3, spins}});
  trial.steps = setup.steps(180, 40);
  return depth_outcome(observe(trial));
}

/// A ball is suddenly there, up to 12 cm around the sheet. The figure is how deep particles are in
/// the end. What comes out stretches the sheet, and this becomes speed.
Outcome run_appears(const Setup& setup) {
  constexpr double kEnergy = 0.12;  // J: in 640 substeps it is 0.11
  SceneDescription scene = cotton(25, 0.8, {});
  scene.gravity = {};
  Trial trial =
      trial_of(setup, std::move(scene), {{Ball{.radius = 0.1}, 0.3, stays({0, 0.02, 0})}});
  trial.bodies.front().appears = 5;
  trial.steps = setup.steps(180, 60);
  const Observed o = observe(trial);
  return outcome(o.end_penetration, o, kEnergy);
}

/// A sheet falls onto a ball.
Outcome run_far_away(const Setup& setup) {
  const Vec3 there{1e4, -1e4, 1e4};
  Trial trial = trial_of(setup, cotton(25, 0.8, there + Vec3{0, 0.25, 0}),
                         {{Ball{.radius = 0.2}, 0.3, stays(there)}});
  trial.steps = setup.steps(180, 40);
  return depth_outcome(observe(trial));
}

/// A sheet falls flat onto a plane and lies on it for a minute. The figure is the speed in the end.
Outcome run_rests(const Setup& setup) {
  Trial trial = trial_of(setup, cotton(15, 0.5, {0, 0.05, 0}), {{Plane{}, 0.3, stays()}});
  trial.steps = setup.steps(3600, 300);
  const Observed o = observe(trial);
  Outcome result = depth_outcome(o);
  if (o.max_penetration > kContactTolerance && result.failure.empty())
    result.failure = fmt::format("{:.2g} m deep", o.max_penetration);
  double fastest = 0;
  for (const Vec3 v : o.end.velocities) fastest = std::max(fastest, length(v));
  result.figure = fastest;
  return result;
}

}  // namespace

std::vector<Case> body_cases() {
  const Capsule axle{{0, 0, -1}, {0, 0, 1}, 0.1, 0.1};
  const std::pair<const char*, std::function<Outcome(const Setup&)>> deep[] = {
      {"knife_edge", [](const Setup& s) { return run_falls(s, knife(), 0.3); }},
      {"box_corner", [](const Setup& s) { return run_falls(s, cube_on_its_corner(), 0.3); }},
      {"body_friction_0",
       [](const Setup& s) {
         return run_falls(s, Ball{{0, -0.2, 0}, 0.2}, 0);
       }},
      {"body_friction_10",
       [](const Setup& s) {
         return run_falls(s, Ball{{0, -0.2, 0}, 0.2}, 10);
       }},
      {"plates_close_to_the_thickness", [](const Setup& s) { return run_plates(s, 2e-3); }},
      {"plates_close_beyond", [](const Setup& s) { return run_plates(s, 1e-3); }},
      {"plate_at_100_m_s", run_fast_plate},
      {"ball_at_10_m_s", [](const Setup& s) { return run_fast_ball(s, 10); }},
      {"axle_spins", [=](const Setup& s) { return run_spins(s, axle); }},
      {"bar_spins",
       [](const Setup& s) {
         return run_spins(s, box({0.4, 0.05, 0.05}));
       }},
      {"body_10_km_away", run_far_away},
      {"body_appears_in_cloth", run_appears},
  };
  std::vector<Case> cases;
  for (const auto& [name, run] : deep)
    cases.push_back({name, "m deep in a body", kContactTolerance, run, takes_bodies});
  cases.push_back({"rests_on_a_plane", "m/s after a minute", 1e-3, run_rests, takes_bodies});
  return cases;
}

}  // namespace weft::tools::hard
