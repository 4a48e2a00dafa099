/// Small steps: one relaxed sweep over all constraints in each of many substeps, and then passes
/// over only those that are out of tolerance. This is their interface for a frame
/// (engine/step/small_step.cpp); small_steps.cpp has their order.
#pragma once

#include <weft/weft.h>

#include <cstdint>
#include <memory>
#include <span>

#include "engine/contact/interval.h"
#include "engine/parallel/team.h"
#include "engine/saving/archive.h"
#include "engine/solvers/small_steps/body_report.h"
#include "engine/solvers/small_steps/carried.h"
#include "engine/solvers/small_steps/creases.h"
#include "engine/solvers/small_steps/frame_to_do.h"
#include "engine/solvers/small_steps/local_passes.h"
#include "engine/solvers/small_steps/seams.h"
#include "engine/solvers/small_steps/sliders.h"
#include "engine/solvers/small_steps/substep_formula.h"
#include "engine/spheres/sphere_contacts.h"
#include "engine/turn.h"
#include "kernels/vectors.h"

namespace weft {

class FreeBodies;
class Model;
namespace simd {
struct Table;
}

class SmallSteps {
 public:
  virtual ~SmallSteps() = default;

  /// A frame from x, with velocities v.
  virtual void begin(kernels::VectorsView x, kernels::VectorsView v, kernels::Vector gravity,
                     kernels::VectorsView force, const FramePlan& plan, Team& team) = 0;
  /// Between two substeps: what acts from now on.
  virtual void accelerate(kernels::Vector gravity, kernels::VectorsView force) = 0;
  /// s^2, over the mass: by so much a force moves a particle in the present substep.
  virtual double give_of_force() const = 0;
  /// After a sweep: of a force that this substep did not know of.
  virtual void shift(std::uint32_t slot, kernels::Vector by) = 0;
  /// The stages of a substep.
  virtual void advance(Team& team) = 0;
  virtual void sweep(Team& team) = 0;
  /// Another sweep, which takes what is out of tolerance to the share `to` of it and leaves the
  /// rest. Springs and triangles of fabric are swept as before. So what is mended in each substep,
  /// to tuning::kMended, is a force that grows with the error, and comes to rest; a whole sweep
  /// more (to = 0) would release what other constraints hold.
  virtual void mend(double to, Team& team) = 0;
  /// After the sweeps of a substep, before anything is mended: adds up what elements carry.
  virtual void weigh() = 0;
  /// Loads in a frame that has ended, of a model that may tear.
  virtual const Carried& carried() const = 0;
  /// After a sweep: finds the springs and triangles of fabric that are out of tolerance, and rigid
  /// constraints beside springs. Where all are rigid a sweep has found them.
  virtual void judge(Team& team) = 0;
  /// Constraints that were found out of tolerance.
  virtual std::int64_t count_out() const = 0;
  /// The largest error of those of them that are laws; a strain.
  virtual double law_error_of_out() = 0;
  virtual LocalWork repair(const SphereContacts& contacts, std::int64_t most_visits,
                           Team& team) = 0;
  /// After each substep's repair: which seams it has closed.
  virtual void end_seams() = 0;
  /// Likewise of hinges that yield, where bending was solved in it, in substeps of `give` as
  /// bending_energy() has it. Returns the energy that was lost, J.
  virtual double yield(double give) = 0;
  /// Their state after the frame, and their work (J).
  virtual const SeamThreads& seams() const = 0;
  virtual const SliderThreads& sliders() const = 0;
  virtual const CreaseThreads& creases() const = 0;
  /// The effects of contacts with bodies in the frame.
  virtual void report_bodies(BodyReport& report) = 0;
  /// Bodies that move by themselves, where the frame has ended.
  virtual FreeBodies& free_bodies() = 0;
  /// m, by which a particle is under the surface of a body.
  virtual double deepest_in_body(Team& team) = 0;
  /// After the last substep: verifies contacts with meshes. Returns whether particles had to be
  /// moved.
  virtual bool end_contacts(Team& team) = 0;
  virtual void read_contacts(std::vector<BodyTouch>& contacts) = 0;
  /// After the last: local passes that look at all constraints.
  virtual LocalWork repair_everywhere(const SphereContacts& contacts, std::int64_t most_visits,
                                      Team& team) = 0;
  /// Whether the motion of the frame goes on from that of the one before (begin()).
  virtual bool has_past() const = 0;
  /// The largest error of the laws of all constraints, over rest_length, with springs only; and of
  /// those of triangles of fabric.
  virtual double law_error() = 0;
  /// Where the particles are; x: where they were when the frame began.
  virtual void read_positions(kernels::VectorsView x, Team& team) const = 0;
  /// Where these slots alone are.
  virtual void read_positions_of(std::span<const std::uint32_t> slots,
                                 kernels::VectorsView x) const = 0;
  /// Where the particles were when the present substep began.
  virtual void read_starts(kernels::VectorsView x, Team& team) const = 0;
  /// m; since the present substep began no particle has moved farther.
  virtual double largest_move(Team& team) = 0;
  /// J, of the bending elements, where the particles are (BendingFrame::resolved()); give 0: all of
  /// it.
  virtual double bending_energy(double give, Team& team) = 0;
  /// J, of the energy of bending at x that substeps of `give` can turn into motion. A swing of the
  /// angular frequency w gives 1 / (1 + f w^2) of its own, f = 1 / BendingFrame::resolved(give):
  /// all of it where a substep resolves it, and that of the softest that it does not resolve else.
  /// bending_energy() holds each element to that by itself, and counts too little of a bend that
  /// many stiff elements share. After the last substep.
  virtual double releasable_bending_energy(kernels::VectorsView x, double give, Team& team) = 0;
  /// The error of the law of bending that the solutions of the frame have left (StepReport).
  virtual double bending_error() const = 0;
  /// After the last substep.
  virtual void settle(Team& team) = 0;
  virtual void read_velocities(kernels::VectorsView v, Team& team) const = 0;
  /// m/s, the largest local error of each substep of the frame, over its length: their mean with a
  /// motion_tolerance, without one that of the last substep. (The largest component of an error
  /// stands for its length.)
  virtual double motion_error() const = 0;
  /// m/s, how much of that rounding alone may make of substeps of h.
  virtual double rounding_error(double h) const = 0;
  /// The frame becomes the past of the next one. Without this the one before stays.
  virtual void keep(Team& team) = 0;
  /// Goes on where another one of the same kind is.
  virtual void take_past(const SmallSteps& from) = 0;
  /// The same from one of another model of the same particles. Those that only one model has fixed
  /// begin with a past of their own: a free flight that leads to v, or rest.
  virtual void go_on_from(const SmallSteps& from, kernels::VectorsView v,
                          kernels::Vector gravity) = 0;
  virtual void forget_past() = 0;
  virtual void save_past(ArchiveWriter& archive) const = 0;
  /// Goes on where the saved one was. Returns whether it was one of the same kind and model; if
  /// not, nothing is changed.
  virtual bool load_past(ArchiveReader& archive) = 0;
  /// The past happened in other directions. Positions are new ones.
  virtual void turn(const Turn& by) = 0;
  virtual std::size_t bytes() const = 0;
  /// Visits of contacts with meshes, since this was last asked (SurfaceContacts).
  virtual double take_contact_visits() = 0;
  /// Since this was last asked. Reports add it up.
  virtual ContactMs take_contact_ms() = 0;
};

/// On the backend of the settings.
std::unique_ptr<SmallSteps> make_small_steps(const Model& model, const Settings& settings,
                                             const simd::Table& table);

}  // namespace weft
