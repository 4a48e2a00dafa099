/// Cloth that hangs on pins at rest gains no energy from frames that differ in length: what a long
/// substep leaves out of shape is the load of springs, and shorter substeps make those stiffer.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/random.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_frames {
namespace {

constexpr double kLongFrame = 0.033, kShortFrame = 0.004;
/// Of what a swing has, by which an energy may rise.
constexpr double kMostGain = 0.001;

/// A strip of cells of 4 cm that hangs on its first row and starts inclined by 45 degrees.
SceneDescription inclined_strip(std::uint32_t rows, std::uint32_t columns, bool is_cotton) {
  MeshDescription mesh = sheet(
      rows, columns,
      [](double i, double j) {
        return Vec3{0.04 * j, -0.04 * i * std::sqrt(0.5), 0.04 * i * std::sqrt(0.5)};
      },
      [](auto, auto) { return Cut::none; });
  for (std::uint32_t j = 0; j < columns; ++j) mesh.pins.push_back(j);
  if (is_cotton) {
    mesh.material = find_material("cotton").value();
    mesh.material->drag = mesh.material->lift = 0;
  } else {
    mesh.mass = 0.0146;
  }
  return made(mesh).scene;
}

/// J, of the fall from the start to where all hangs below its pin.
double energy_of_swing(const SceneDescription& scene) {
  double sum = 0;
  for (std::size_t i = 0; i < scene.positions.size(); ++i) {
    const Vec3 x = scene.positions[i];
    sum += scene.masses[i] * length(scene.gravity) * (std::hypot(x.y, x.z) + x.y);
  }
  return sum;
}

/// The largest energy of all steps, above that at the start, over what the swing has.
double largest_gain(const SceneDescription& scene, const Settings& settings,
                    const std::vector<double>& frames) {
  Cloth cloth = cloth_of(scene, settings);
  const auto mechanical = [&] { return energy(scene, positions(cloth), velocities(cloth)); };
  const double start = mechanical();
  double most = start;
  for (const double dt : frames) {
    step(cloth, dt);
    most = std::max(most, mechanical());
  }
  return (most - start) / energy_of_swing(scene);
}

std::vector<double> random_frames(double seconds, Random& random) {
  std::vector<double> frames;
  for (double t = 0; t < seconds; t += frames.back()) {
    frames.push_back(random.between(kShortFrame, kLongFrame));
  }
  return frames;
}

std::vector<double> frames_in_turns(double seconds) {
  std::vector<double> frames;
  for (double t = 0; t < seconds; t += kLongFrame + kShortFrame) {
    frames.push_back(kLongFrame);
    frames.push_back(kShortFrame);
  }
  return frames;
}

TEST_CASE("frames of 4 to 33 ms bring no energy into cloth by small steps") {
  const Backend backend = each_backend();
  Random random(3);
  for (const bool is_cotton : {true, false}) {
    const SceneDescription scene = inclined_strip(13, 7, is_cotton);
    for (const auto& [substeps, tolerance] :
         {std::pair{8, 0.01}, {8, 0.1}, {4, 1.0}, {1, 0.1}, {kAutomaticSubsteps, 0.01}}) {
      for (const Scheme scheme : {Scheme::bdf2, Scheme::implicit}) {
        CAPTURE(is_cotton);
        CAPTURE(substeps);
        CAPTURE(tolerance);
        CAPTURE(name(scheme));
        const Settings settings{.tolerance = tolerance,
                                .substeps = substeps,
                                .solver = Solver::small_steps,
                                .scheme = scheme,
                                .backend = backend,
                                .threads = 1};
        CHECK(largest_gain(scene, settings, random_frames(2, random)) <= kMostGain);
        CHECK(largest_gain(scene, settings, frames_in_turns(2)) <= kMostGain);
      }
    }
  }
}

TEST_CASE("frames of 4 to 33 ms bring no energy into cloth by other solvers") {
  Random random(3);
  for (const bool is_cotton : {true, false}) {
    SceneDescription scene = inclined_strip(13, 7, is_cotton);
    scene.bending.clear();
    for (const Solver solver : {Solver::gauss_seidel, Solver::yarn, Solver::direct}) {
      for (const int substeps : {4, 8}) {
        CAPTURE(is_cotton);
        CAPTURE(name(solver));
        CAPTURE(substeps);
        const Settings settings{
            .tolerance = 0.01, .substeps = substeps, .solver = solver, .threads = 1};
        CHECK(largest_gain(scene, settings, random_frames(2, random)) <= kMostGain);
        CHECK(largest_gain(scene, settings, frames_in_turns(2)) <= kMostGain);
      }
    }
  }
}

TEST_CASE("random cloth by small steps gains no energy from frames of random lengths") {
  for (std::uint32_t seed = 1; seed <= 24; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const std::uint32_t rows = 3 + random.below(10), columns = 2 + random.below(8);
    const SceneDescription scene = inclined_strip(rows, columns, random.below(3) > 0);
    const Settings settings{.tolerance = std::pow(10, -random.between(0.5, 3)),
                            .substeps = random.below(4) == 0
                                            ? kAutomaticSubsteps
                                            : 1 + static_cast<int>(random.below(20)),
                            .max_iterations = 1 + static_cast<int>(random.below(1000)),
                            .solver = Solver::small_steps,
                            .scheme = random.below(2) == 0 ? Scheme::implicit : Scheme::bdf2,
                            .backend = random.below(4) == 0 ? Backend::reference : Backend::simd,
                            .threads = 1};
    CHECK(largest_gain(scene, settings, random_frames(1.5, random)) <= kMostGain);
  }
}

TEST_CASE("frames that become shorter for good make cloth as stiff as they would from the start") {
  const SceneDescription scene = inclined_strip(13, 7, true);
  const Settings settings{
      .tolerance = 0.1, .substeps = 4, .solver = Solver::small_steps, .threads = 1};
  const auto strain_at_rest = [&](double first_dt, int first_frames) {
    SceneDescription damped = scene;
    damped.damping.motion = 10;
    Cloth cloth = cloth_of(damped, settings);
    for (int k = 0; k < first_frames; ++k) step(cloth, first_dt);
    for (int k = 0; k < 1000; ++k) step(cloth, kShortFrame);
    return cloth.strain().rms;
  };
  CHECK(strain_at_rest(kLongFrame, 60) ==
        doctest::Approx(strain_at_rest(kShortFrame, 0)).epsilon(0.01));
}

}  // namespace
}  // namespace weft::test::engine_step_frames
