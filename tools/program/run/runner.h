/// Runs a cloth for a number of frames and gathers every figure that the program reports.
/// One frame is one time step. Only the calls of Cloth::step() are timed: what the caller does with
/// a frame, and what is measured here after it, costs no reported time.
#pragma once

#include <weft/weft.h>

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/program/measure/crossings.h"
#include "tools/program/measure/fabric_measure.h"
#include "tools/program/run/run_state.h"
#include "tools/scenes/events.h"
#include "tools/scenes/pin_moves.h"
#include "tools/scenes/rest_scale.h"
#include "tools/scenes/scene_body.h"

namespace weft::tools {

struct RunPlan {
  double dt = 0.01;                     ///< s
  int steps = 200;                      ///< frames to run, those before `resume` included
  std::optional<RunState> resume = {};  ///< where the run goes on from
  /// Runs of which the fastest is reported. Above 1 an untimed run goes first, to warm up.
  int repeat = 1;
  /// A run ends once its steps have taken so much processor time (s); RunSummary::frames says how
  /// far it came.
  double seconds_limit = std::numeric_limits<double>::infinity();
  /// Asked after every frame, before its callback: true ends the run there.
  std::function<bool()> stop = {};
  /// Of fixed particles and anchors, each in one move at most. Before each frame they are sent to
  /// where they are at its end.
  std::vector<PinMove> moves = {};
  std::vector<SceneBody> bodies = {};
  std::vector<SceneEvent> events = {};
  RestScale rest_scale = {};  ///< in each frame that of its end
  /// Of the scene, for particles that an event releases at its start; empty: all at rest.
  std::vector<Vec3> velocities = {};
  /// After every frame, of `surface` (SceneDescription::surface) and bodies that are meshes, and of
  /// the surface with itself where that is asked for.
  bool check_intersections = false;
  bool touches_itself = false;
  std::vector<std::array<std::uint32_t, 3>> surface = {};
  double Vec3::*up = &Vec3::y;             ///< what RunSummary::lowest is measured along
  FabricMeasure fabric = {};               ///< what RunSummary::fabric is measured by
  std::optional<std::string> record = {};  ///< the file that the first run is recorded in
  std::string scene = {};                  ///< its name, for the recording
};

/// Called once per frame, frames counted from 1 (those before RunPlan::resume too), with the state
/// that the frame reached. With repeats it is called in the first (warm-up) run only.
using FrameCallback = std::function<void(int frame, const Cloth&, const StepReport&)>;

/// A frame that was not brought within its tolerances, and what its report names.
struct Miss {
  int frame = 0;  ///< from 1
  Status status = Status::converged;
  double max_error = 0;  ///< of the laws
  double max_strain = 0;
  double max_penetration = 0;                ///< m
  std::uint32_t constraint = kNoIndex;       ///< with max_strain
  std::uint32_t failed_particle = kNoIndex;  ///< where the numbers ended
  std::uint32_t passed_particle = kNoIndex;  ///< that went through a sphere
  std::uint32_t late_seam = kNoIndex;        ///< StepReport::worst_seam of late ones
  std::uint32_t held = kNoIndex;             ///< StepReport::worst_held
  NamedCrossing crossing{};  ///< with a body that is a mesh, the first that was left
  int crossing_frame = 0;    ///< when a frame ended: which one
  int inside = 0;            ///< particles, where nothing crosses
};

/// "frame 3: iteration_limit; constraint 7 has the largest strain, 2.1 %". Where triangles cross a
/// body it names the first in place of the strain, and where cloth is inside one it says so. Where
/// a seam is late, or held particles exclude a constraint, it names these.
std::string text(const Miss& miss);

/// A body with a mass when the run ends.
struct FreeBodyEnd {
  std::uint32_t body = 0;  ///< by its place among all bodies
  Pose pose{};
  Vec3 centre{};  ///< m, of mass
};

/// All figures of a run. Counts and seconds are sums over its frames; strains are fractions,
/// recomputed from the positions after every frame.
struct RunSummary {
  Solver solver = Solver::automatic;  ///< that was chosen
  Scheme scheme = Scheme::automatic;  ///< likewise
  Isa isa = Isa::automatic;           ///< what the kernels ran on
  int threads = 1;                    ///< that the steps could use
  int frames = 0;      ///< computed; below RunPlan::steps if stopped, not committed or out of time
  int resumed_at = 0;  ///< frames that were done before
  int last_frame() const { return resumed_at + frames; }
  bool stopped = false;  ///< RunPlan::stop said so, to this run or to a later repeat
  /// Runs that came to their end, the one to warm up included. Where a later one was stopped the
  /// figures are those of the best before it; 0: of the one that was stopped.
  int finished_runs = 0;
  std::optional<Miss> first_miss;
  int missed_frames = 0;  ///< that were not brought within their tolerances

  double step_seconds = 0;          ///< wall time in step()
  double longest_step_seconds = 0;  ///< of one frame
  double cpu_seconds = 0;           ///< processor time in step(), all threads together
  double solver_seconds = 0;  ///< of all stages but `report`, as the steps themselves measured it
  StepReport total;           ///< of all frames (add_step)
  int asleep_frames = 0;

  double max_strain = 0;               ///< over all frames and constraints
  double mean_max_strain = 0;          ///< mean over the frames of each frame's largest strain
  double rms_strain = 0;               ///< over all frames and constraints
  std::optional<FabricStrain> fabric;  ///< over all frames; none without a fabric
  /// Most pairs in one frame of a triangle of the cloth and one of a body that crossed
  /// (crossings.h); none where it was not asked for.
  std::optional<std::size_t> intersections;

  double energy_start = 0;  ///< J, before the first frame
  double energy_end = 0;    ///< J, after the last frame
  /// J, the largest over the frames of energy - energy_start - the work of moved pins until then.
  /// (By scheme paper what hangs and sinks at u seems to have m u g h / 2 too much meanwhile: its
  /// velocities are those of Cloth::velocity().)
  double energy_gain = 0;
  double mean_motion_error = 0;  ///< m/s, mean over the frames
  double lowest = 0;             ///< m along RunPlan::up, over all frames and particles

  std::uint64_t state_hash = 0;  ///< of the last frame
  std::vector<FreeBodyEnd> free_bodies;
  std::size_t bytes = 0;  ///< of the cloth and its model
  ModelInfo model;

  bool reached_tolerance() const { return !first_miss; }
  double seconds_per_frame() const { return frames > 0 ? step_seconds / frames : 0; }
  double iterations_per_step() const {
    return frames > 0 ? static_cast<double>(total.iterations) / frames : 0;
  }
};

/// Adds a frame's work, times, status and, if it is the first, its miss.
void add_frame(RunSummary& summary, const StepReport& report);

/// Every repeat starts from the model's own state, or that of RunPlan::resume. A step that commits
/// nothing ends the run. An error means that the settings, dt or a move were refused.
Result<RunSummary> run(std::shared_ptr<const Model> model, const Settings& settings,
                       const RunPlan& plan, const FrameCallback& on_frame = {});

/// The same from a description, which is validated first.
Result<RunSummary> run(const SceneDescription& scene, const Settings& settings, const RunPlan& plan,
                       const FrameCallback& on_frame = {});

}  // namespace weft::tools
