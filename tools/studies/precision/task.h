/// What a work-precision chart is measured on, and what one run of it cost and bought.
#pragma once

#include <weft/weft.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace weft::tools::precision {

inline constexpr double kFrame = 0.01;        ///< s, one step of a run
inline constexpr int kReferenceFrame = 40;    ///< trajectories are compared after it: at 0.4 s
inline constexpr double kEnergyBound = 1e-3;  ///< J; a run that gains more does not count

/// One scene at one size, over a number of frames.
struct Task {
  std::string scene;
  int size = 0;
  int frames = 200;
  int threads = 1;
  SceneDescription description;
  std::shared_ptr<const Model> model;
  std::vector<Vec3> reference;  ///< positions at kReferenceFrame; empty: not compared
  std::string reference_by;     ///< what computed them
  double reference_error = 0;   ///< m, how far off they are themselves, estimated

  bool is_line() const { return scene == "chain"; }
  bool has_material() const;
};

/// The cape is one of ropes or, like the flag, of a material (--material of `weft run`; empty:
/// none). Without the reference. An error too if weft refuses plain settings: WEFT_ISA names no
/// instruction set of this machine.
Result<Task> make_task(const std::string& scene, int size, const std::string& material = {});

/// Computes the reference with steps of kFrame / parts and half of that. The second is kept, and a
/// third of the difference is its error, since the order is two. Of a scene that the reference
/// solution does not know or cannot move, with ropes, springs or with yarns straight between two
/// pins, small steps compute it, 32 times as many: its error is then the whole difference, as of a
/// method of first order, since ropes become taut from step to step, and what is straight sags by
/// the root of its strain.
Result<void> add_reference(Task& task, int parts);

/// A tolerance, or a fixed number of iterations. 0 substeps: automatic.
struct Knobs {
  int substeps = 1;
  std::optional<double> tolerance;
  int iterations = 0;
};

struct Outcome {
  std::string status;  ///< weft's name of it, or out_of_time
  int frames = 0;
  double ms_per_frame = 0;     ///< one thread, and Bullet: processor time, else wall time
  double max_strain = 0;       ///< over all frames and constraints; of springs what is left of laws
  double mean_max_strain = 0;  ///< mean over the frames
  double motion_error = 0;     ///< m/s, as it is estimated, mean over the frames
  double energy_gain = 0;      ///< J
  double substeps = 0;         ///< per frame, mean
  std::optional<double> trajectory_error{};  ///< m

  bool is_complete() const { return status == "converged" || status == "fixed_iterations"; }
  /// Reached what it was to reach, and gained no energy.
  bool counts() const { return is_complete() && energy_gain <= kEnergyBound; }
};

struct Point {
  std::string solver;   ///< weft's name of it, or the peer's
  std::string scheme;   ///< empty for peers
  std::string backend;  ///< empty for peers
  Knobs knobs;
  Outcome outcome;
};

/// How long a run may take, and how often short ones are repeated; the fastest counts.
struct Effort {
  int repeat = 5;
  double seconds_limit = 4;      ///< of processor time, one run
  double enough_seconds = 0.25;  ///< runs of one point stop when they have taken this long together
};

}  // namespace weft::tools::precision
