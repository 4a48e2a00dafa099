/// Closed forms: what paper says of a cloth, and what is measured of one at three meshes or steps.
#pragma once

#include <weft/mesh.h>

#include <cstdint>
#include <functional>
#include <numbers>
#include <span>
#include <string>
#include <vector>

namespace weft::tools::forms {

inline constexpr double kGravity = 10;      ///< m/s^2, of all forms
inline constexpr double kFrame = 1.0 / 60;  ///< s
inline constexpr double kPi = std::numbers::pi;

/// At one mesh or step, with what it cost.
struct Reading {
  std::string size;  ///< "32 x 4 cells", "1/120 s"
  double expected = 0;
  double measured = 0;
  double ms_per_frame = 0;  ///< of the processor, by one thread
  double substeps = 0;      ///< of a frame, the mean
  int missed = 0;           ///< frames that did not converge
  double error() const { return measured / expected - 1; }
};

inline constexpr int kRefinements = 3;
/// Errors below this are small enough wherever they come from, and need not fall.
inline constexpr double kSmall = 0.005;

struct Form {
  std::string name;
  std::string formula;
  std::string unit;
  std::function<Reading(int refinement)> measure;  ///< 0 to kRefinements - 1, the finest
  double bound = 0.02;                             ///< of the finest reading's error
  /// Whether a finer mesh is to have a smaller error. Where not, all meshes are to be within the
  /// bound.
  bool converges = true;
};

struct FormResult {
  std::string name, formula, unit;
  double bound = 0;
  bool converges = true;
  std::vector<Reading> readings;  ///< from the coarsest on

  /// Whether the finest reading is within the bound and either small or better than the coarsest,
  /// or all are within the bound where a form does not converge; and every frame converged. Without
  /// the finest mesh only the last is asked for.
  bool holds() const;
};

/// refinements: 1 to kRefinements.
FormResult measure(const Form& form, int refinements = kRefinements);
std::vector<Form> all_forms();

// One file each.
std::vector<Form> membrane_forms();
std::vector<Form> bending_forms();
std::vector<Form> fold_forms();
std::vector<Form> crease_forms();
std::vector<Form> end_forms();
std::vector<Form> annulus_forms();
std::vector<Form> fabric_forms();
std::vector<Form> film_forms();
std::vector<Form> motion_forms();
std::vector<Form> body_forms();
std::vector<Form> layer_forms();
std::vector<Form> pressure_forms();

/// The cloth of a scene on its way by one thread, timed. Throws where weft refuses the scene, the
/// settings or a step.
class Run {
 public:
  Run(const SceneDescription& scene, Settings settings);
  void step(double dt);
  void steps(int count, double dt) {
    for (int i = 0; i < count; ++i) step(dt);
  }
  Cloth& cloth() { return cloth_; }
  Vec3 at(std::uint32_t particle) const { return cloth_.position(particle); }
  double mean_y(std::span<const std::uint32_t> particles) const;
  /// N, one for each particle, until others are written.
  void pull(std::span<const Vec3> forces);
  /// Fixed particles go to where they are taken.
  void move_pins(const SceneDescription& scene, const std::function<Vec3(Vec3)>& to);
  Reading reading(std::string size, double expected, double measured) const;

 private:
  Cloth cloth_;
  double seconds_ = 0;
  int frames_ = 0, missed_ = 0;
  std::int64_t substeps_ = 0;
};

}  // namespace weft::tools::forms
