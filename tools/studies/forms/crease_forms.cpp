/// What yields when it is bent, and what inner friction holds: strips without weight, at frames of
/// 30, 60 and 240 Hz. Curvatures are read in the middle half of a strip.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tools/studies/forms/form.h"
#include "tools/studies/forms/sheets.h"

namespace weft::tools::forms {
namespace creases {
namespace {

constexpr double kRates[kRefinements] = {30, 60, 240};  // Hz
constexpr double kLength = 0.04;                        // m
constexpr int kCells = 16;
constexpr double kCell = kLength / kCells;
constexpr double kFirstSwing = 3.516;  // of a clamped beam

std::string rate_of(int refinement) { return fmt::format("1/{:g} s", kRates[refinement]); }

/// Without air, and damped so that a strip comes to rest without swinging. Returns the time of a
/// swing, over 2 pi.
double still(Material& m) {
  const double swing = kFirstSwing * std::sqrt(m.bending / m.density) / (kLength * kLength);
  m.drag = m.lift = 0;
  m.damping_bending = 0;
  m.damping_motion = 2 * swing;
  return 1 / swing;
}

Sheet strip_of(Pattern pattern) {
  const double width = pattern == Pattern::quads ? kLength / 2 : kLength;
  return sheet_of(pattern, kLength, width, kCells);
}

/// Particles of a strip around a line across it, and where the line is along the strip.
class Section {
 public:
  Section(const SceneDescription& scene, double from, double to) {
    for (std::uint32_t i = 0; i < scene.positions.size(); ++i) {
      const double x = scene.positions[i].x;
      if (x < from - 1e-9 || x > to + 1e-9) continue;
      members_.push_back({i, x, scene.masses[i]});
      mass_ += scene.masses[i];
      middle_ += scene.masses[i] * x;
    }
    middle_ /= mass_;
    for (const Member& m : members_) square_ += m.mass * (m.x - middle_) * (m.x - middle_);
  }

  double middle() const { return middle_; }
  /// rad, of the strip against x.
  double slope(const Run& run) const {
    double along = 0, up = 0;
    for (const Member& m : members_) {
      const Vec3 p = run.at(m.particle);
      along += m.mass * (m.x - middle_) * p.x;
      up += m.mass * (m.x - middle_) * p.y;
    }
    return std::atan2(up, along);
  }
  /// Adds forces across the strip that make a moment, N m, and none along it.
  void turn(const Run& run, double moment, std::vector<Vec3>& forces) const {
    const double angle = slope(run);
    for (const Member& m : members_) {
      const double f = moment * m.mass * (m.x - middle_) / square_;
      forces[m.particle] = {-f * std::sin(angle), f * std::cos(angle), 0};
    }
  }

 private:
  struct Member {
    std::uint32_t particle = 0;
    double x = 0, mass = 0;
  };
  std::vector<Member> members_;
  double mass_ = 0, middle_ = 0, square_ = 0;
};

/// 1/m, in the middle half of a strip from x = `from` on.
class Curvature {
 public:
  Curvature(const SceneDescription& scene, double from)
      : first_(section(scene, from + kLength / 4)), last_(section(scene, from + 3 * kLength / 4)) {}
  double of(const Run& run) const {
    return (last_.slope(run) - first_.slope(run)) / (last_.middle() - first_.middle());
  }

 private:
  static Section section(const SceneDescription& scene, double at) {
    return {scene, at - kCell, at + kCell};
  }
  Section first_, last_;
};

/// From 0 to 1, beginning and ending slowly.
double eased(double t) { return 0.5 - 0.5 * std::cos(kPi * std::clamp(t, 0., 1.)); }

/// A clamped strip that a moment bends by its free end.
class Bent {
 public:
  Bent(Pattern pattern, Material material, int refinement)
      : swing_(still(material)),
        dt_(1 / kRates[refinement]),
        strip_(clamped_strip(pattern, material, kLength, strip_of(pattern).width, kCells)),
        run_(weightless(), {}),
        end_(strip_.scene, strip_.clamp + kLength - 2.6 * kCell, strip_.clamp + kLength),
        curvature_(strip_.scene, strip_.clamp),
        forces_(strip_.scene.positions.size()) {}

  /// To this moment per width, N, by and by. Returns the curvature that it comes to, 1/m.
  double bend(double moment) {
    const double from = std::exchange(moment_, moment);
    const int frames = static_cast<int>(std::ceil(12 * swing_ / dt_));
    for (int k = 1; k <= 2 * frames; ++k) {
      const double now = from + (moment - from) * eased(static_cast<double>(k) / frames);
      end_.turn(run_, now * strip_.sheet.width, forces_);
      run_.pull(forces_);
      run_.step(dt_);
    }
    return curvature_.of(run_);
  }
  const Run& run() const { return run_; }

 private:
  SceneDescription weightless() const {
    SceneDescription scene = strip_.scene;
    scene.gravity = {};
    return scene;
  }

  double swing_, dt_, moment_ = 0;
  Strip strip_;
  Run run_;
  Section end_;
  Curvature curvature_;
  std::vector<Vec3> forces_;
};

/// A strip that is bent to about this curvature, and let go.
Reading springs_back(Pattern pattern, const Material& material, double about, int refinement) {
  const double yield = material.bending_yield, hardening = material.bending_hardening;
  const double crease = (about - yield) / (1 + hardening);
  Bent strip(pattern, material, refinement);
  const double bent = strip.bend(material.bending * (about - crease));
  const double kept = strip.bend(0);
  return strip.run().reading(rate_of(refinement), (bent - yield) / (1 + hardening), kept);
}

/// A moment bends a clamped strip one way, the other way, and back. Without a moment friction keeps
/// it bent: by how much more after the one way than after the other is the width of the loop.
Reading loop(Pattern pattern, const Material& material, int refinement) {
  const double most = 4 * material.bending_friction;  // friction has turned before it vanishes
  Bent strip(pattern, material, refinement);
  strip.bend(most);
  const double down = strip.bend(0);
  strip.bend(-most);
  const double up = strip.bend(0);
  return strip.run().reading(rate_of(refinement), 1e3 * 2 * material.bending_friction,
                             1e3 * material.bending * (down - up));
}

}  // namespace
}  // namespace creases

std::vector<Form> crease_forms() {
  constexpr double kYield = 30, kHardening = 0.5, kRolled = 90;  // 1/m, 1, 1/m
  constexpr double kFriction = 20;                               // 1/m, times the stiffness
  std::vector<Form> forms;
  for (const char* name_of_material : {"denim", "silk"}) {
    for (const Pattern pattern : {Pattern::quads, Pattern::equilateral}) {
      Material yields = find_material(name_of_material).value(), rubs = yields;
      yields.bending_yield = kYield;
      yields.bending_hardening = kHardening;
      rubs.bending_friction = kFriction * rubs.bending;
      const std::string of = fmt::format(" of {}, {}", name_of_material, name(pattern));
      forms.push_back({"a strip springs back" + of, "(c - yield) / (1 + hardening)", "1/m",
                       [=](int r) { return creases::springs_back(pattern, yields, kRolled, r); },
                       0.03, false});
      forms.push_back({"the loop of moment and curvature" + of, "2HB", "mN",
                       [=](int r) { return creases::loop(pattern, rubs, r); }, 0.03, false});
    }
  }
  return forms;
}

}  // namespace weft::tools::forms
