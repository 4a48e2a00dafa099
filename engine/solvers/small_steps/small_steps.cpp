/// A frame of small steps from top to bottom. The particles are in a store (particle_store.h): in
/// lanes (lane_store.h), or in double (reference_store.h), the text to read beside it.
#include "engine/solvers/small_steps/small_steps.h"

#include <algorithm>
#include <utility>

#include "engine/solvers/small_steps/body_layout.h"
#include "engine/solvers/small_steps/contact_times.h"
#include "engine/solvers/small_steps/free_bodies.h"
#include "engine/solvers/small_steps/free_host.h"
#include "engine/solvers/small_steps/lane_store.h"
#include "engine/solvers/small_steps/linkage.h"
#include "engine/solvers/small_steps/particle_store.h"
#include "engine/solvers/small_steps/reference_store.h"
#include "engine/solvers/small_steps/substep.h"

namespace weft {
namespace {

template <ParticleStore Store>
class StoredSmallSteps final : public SmallSteps {
 public:
  StoredSmallSteps(const Model& model, const Settings& settings, const simd::Table& table)
      : model_(model),
        layout_(model.small_steps()),
        now_{model, settings},
        seams_(model),
        sliders_(model),
        creases_(model, layout_.bending.creases),
        free_(model),
        carried_(model),
        linkage_(model, layout_.linkage),
        store_(now_, table) {
    now_.arrived.reserve(model.anchors.size() + linkage_.slots());
  }

  void begin(kernels::VectorsView x, kernels::VectorsView v, kernels::Vector gravity,
             kernels::VectorsView force, const FramePlan& plan, Team& team) override {
    now_.dt_substep = plan.dt_substep;
    now_.omega = plan.omega;
    now_.softest = plan.softest;
    now_.is_begun = now_.is_aside = false;
    now_.passes.forget();
    now_.touched.clear();
    now_.arrived.clear();
    now_.velocity_jumps.clear();
    now_.has_past =
        !plan.placed && plan.dt_substep <= SubstepFormula::kLargestRatio * store_.dt_of_past();
    seams_.begin(plan.seams, plan.projects() ? 0 : plan.dt_substep);
    sliders_.begin(plan.sliders, !plan.projects());
    if (model_.may_tear) carried_.begin(plan.substeps);
    departures_.begin();
    store_.begin(x, v, plan, team);
    store_.accelerate(gravity, force);
    creases_.begin(plan.creases, [&](auto... fold) { store_.set_fold(fold...); });
    store_.begin_bending(plan);
    store_.begin_past(team);
    begin_bodies(plan, team);
    begin_free_bodies(plan, gravity);
    now_.next_formula = now_.formula_after(now_.has_past ? store_.dt_of_past() : now_.dt_substep);
  }
  void accelerate(kernels::Vector gravity, kernels::VectorsView force) override {
    store_.accelerate(gravity, force);
  }

  double give_of_force() const override { return now_.formula.give(now_.dt_substep); }
  void shift(std::uint32_t slot, kernels::Vector by) override {
    store_.points(true).move(slot, by);
  }

  /// From the end of a substep to the prediction of the next, where anchors and bodies are then.
  void advance(Team& team) override {
    end_contacts(team);
    end_motions(team);
    now_.is_begun = false;
    store_.renew_base(team);
    if (now_.next_formula.left < 1) {
      settle(now_.measures_departures(), team);
      store_.decay(now_.next_formula.left, team);
    }
    add_departure(store_.predict(team));
    now_.formula = std::exchange(now_.next_formula, now_.formula_after(now_.dt_substep));
    store_.advance_anchors();
    advance_bodies(now_.formula.part, team);
    advance_free_bodies();
    if (model_.has_attached()) store_.hold_anchors(team);  // before constraints are swept
    store_.bend(team);
  }

  void sweep(Team& team) override { sweep({now_.omega, 0}, team); }
  void mend(double to, Team& team) override {
    set_aside();
    sweep({1, to * now_.settings.tolerance}, team);
  }
  void weigh() override {
    if (model_.may_tear)
      carried_.add(store_.points(false), linkage_, seams_, now_.law_step().springs.scale);
  }
  const Carried& carried() const override { return carried_.mean(); }
  void judge(Team& team) override {
    if (model_.constraints.has_springs()) store_.judge_springs(team);
    store_.judge_membrane(team);
  }
  std::int64_t count_out() const override {
    return store_.count_out() + std::ssize(linkage_.out());
  }

  /// Cloth that shivers at rest has damping that is as large as its load in one substep and nothing
  /// in the mean; cloth that moves is damped. So it is the smaller one of the two.
  double law_error_of_out() override {
    const LawStep damped = now_.law_step();
    LawStep undamped = damped;
    undamped.springs.damping = undamped.damping_of_triangles = 0;
    const double most = law_error_of_out(damped);
    return model_.damping.stretch > 0 ? std::min(most, law_error_of_out(undamped)) : most;
  }

  /// Constraints that a sweep found out of tolerance have been relaxed since, and so have their
  /// neighbours: all of these are looked at again.
  LocalWork repair(const SphereContacts& contacts, std::int64_t most_visits, Team& team) override {
    store_.for_each_out([&](std::uint32_t item) { now_.passes.look_near(item); });
    for (const std::uint32_t c : linkage_.out()) now_.passes.look_near(c);
    return run_passes(contacts, most_visits, team);
  }
  LocalWork repair_everywhere(const SphereContacts& contacts, std::int64_t most_visits,
                              Team& team) override {
    now_.passes.look_everywhere();
    return run_passes(contacts, most_visits, team);
  }
  void end_seams() override {
    if (seams_.empty()) return;
    seams_.end_substep(store_.points(false), time_of_seams(), now_.settings.contact_tolerance,
                       [&](std::uint32_t a, std::uint32_t b) {
                         now_.touched.push_back(a);
                         now_.touched.push_back(b);
                       });
  }
  double yield(double give) override {
    if (creases_.empty() || !store_.has_bent()) return 0;
    return creases_.yield(store_.points(false), store_.resolved_bending(give),
                          [&](auto... fold) { store_.set_fold(fold...); });
  }
  /// Ends contacts with meshes, where their interval is over.
  bool end_contacts(Team& team) override {
    if (!store_.bodies().has_meshes()) return false;
    const Points points = store_.points(true);
    PointParticles particles(points);
    return contact_times_.timed(&ContactMs::verify,
                                [&] { return store_.bodies().end_interval(particles, team); });
  }
  void settle(Team& team) override {
    end_motions(team);
    settle(true, team);
  }
  void keep(Team& team) override { store_.keep(team); }

  bool has_past() const override { return now_.has_past; }
  double law_error() override {
    const Points points = store_.points(false);
    const LawStep step = now_.law_step();
    const double most = largest_violation(model_.membrane, points, step);
    if (!model_.constraints.has_springs()) return most;
    return std::max(most, largest_violation(model_.constraints, points, step));
  }
  double motion_error() const override { return departures_.mean_error(); }
  double bending_error() const override { return store_.bending_error(); }
  double rounding_error(double h) const override { return store_.rounding_error(h); }
  double bending_energy(double give, Team& team) override {
    return store_.bending_energy(give, team);
  }
  double releasable_bending_energy(kernels::VectorsView x, double give, Team& team) override {
    return store_.releasable_bending_energy(x, give, team);
  }
  double deepest_in_body(Team& team) override {
    if (store_.bodies().empty() && free_.empty()) return 0;
    return contact_times_.timed(&ContactMs::verify, [&] {
      const double in_free = free_.empty() ? 0 : free_.deepest(store_.points(false));
      return store_.bodies().empty() ? in_free : std::max(in_free, store_.deepest_in_body(team));
    });
  }
  const SeamThreads& seams() const override { return seams_; }
  const SliderThreads& sliders() const override { return sliders_; }
  const CreaseThreads& creases() const override { return creases_; }
  void report_bodies(BodyReport& report) override {
    store_.bodies().sum(report);
    if (!free_.empty()) free_.sum(report);
  }
  FreeBodies& free_bodies() override { return free_; }
  void read_contacts(std::vector<BodyTouch>& contacts) override {
    if (!free_.empty()) free_.read_contacts(store_.points(false), contacts);
    if (store_.bodies().empty()) return;
    const Points points = store_.points(true);
    store_.bodies().read_contacts(PointParticles(points), contacts);
  }

  void read_positions(kernels::VectorsView x, Team& team) const override {
    store_.read_positions(x, team);
  }
  void read_positions_of(std::span<const std::uint32_t> slots,
                         kernels::VectorsView x) const override {
    store_.read_positions_of(slots, x);
  }
  void read_starts(kernels::VectorsView x, Team& team) const override {
    store_.read_starts(x, team);
  }
  void read_velocities(kernels::VectorsView v, Team& team) const override {
    store_.read_velocities(v, team);
  }
  double largest_move(Team& team) override { return store_.largest_move(team); }

  void take_past(const SmallSteps& from) override { store_.take_past(store_of(from)); }
  void go_on_from(const SmallSteps& from, kernels::VectorsView v,
                  kernels::Vector gravity) override {
    store_.go_on_from(store_of(from), v, gravity);
  }
  void forget_past() override { store_.forget_past(); }
  void save_past(ArchiveWriter& archive) const override { store_.save_past(archive); }
  bool load_past(ArchiveReader& archive) override { return store_.load_past(archive); }
  void turn(const Turn& by) override { store_.turn(by); }
  double take_contact_visits() override { return store_.bodies().take_visits(); }
  ContactMs take_contact_ms() override { return contact_times_.take(); }
  std::size_t bytes() const override {
    return now_.bytes() + seams_.bytes() + sliders_.bytes() + creases_.bytes() + free_.bytes() +
           bytes_of(far_) + carried_.bytes() + linkage_.bytes() + store_.bytes();
  }

 private:
  using Points = typename Store::Points;
  static const Store& store_of(const SmallSteps& steps) {
    return static_cast<const StoredSmallSteps&>(steps).store_;
  }

  double law_error_of_out(const LawStep& step) {
    const Points points = store_.points(false);
    double most = 0;
    const auto look_at = [&](std::uint32_t item) {
      most = std::max(most, now_.passes.law_error(points, step, item));
    };
    store_.for_each_out(look_at);
    std::ranges::for_each(layout_.serial, look_at);
    return most;
  }
  /// Contacts come last.
  void sweep(const Relaxation& by, Team& team) {
    store_.sweep_yarns(by, team, [&] { store_.hold_anchors(team); });
    if (!linkage_.empty())
      linkage_.sweep(store_.points(false), by, now_.local_tolerance(), now_.is_begun);
    store_.sweep_edges(by, team);
    store_.sweep_membrane(team);
    if (layout_.has_single_constraints() || !layout_.has_yarns()) store_.hold_anchors(team);
    hold_joints();
    hold_bodies(team);
    hold_free_bodies();
    now_.is_begun = true;
  }
  LocalWork run_passes(const SphereContacts& contacts, std::int64_t most_visits, Team& team) {
    set_aside();
    Points points = store_.points(true);
    const LocalLimits limits{
        .tolerance = now_.local_tolerance(),
        .contact_tolerance = tuning::kLocalShare * now_.settings.contact_tolerance,
        .mended = tuning::kMended * now_.settings.tolerance,
        .most_visits = most_visits,
        .laws = now_.law_step()};
    LocalWork work = now_.passes.run(points, contacts, limits);
    hold_joints();
    hold_by_meshes(team);
    if (!free_.empty()) hold_free_bodies_between(points, contacts, limits, work);
    return work;
  }
  /// Contacts with bodies that move by themselves and constraints take turns.
  void hold_free_bodies_between(Points& points, const SphereContacts& contacts, LocalLimits limits,
                                LocalWork& work) {
    hold_free_bodies();
    for (int turn = 1; turn < tuning::kFreeTurns && work.done && now_.passes.is_asked(); ++turn) {
      limits.most_visits -= work.visits;
      const LocalWork more = now_.passes.run(points, contacts, limits);
      work = {work.visits + more.visits, work.corrections + more.corrections, more.done};
      hold_free_bodies();
    }
  }
  void begin_free_bodies(const FramePlan& plan, kernels::Vector gravity) {
    free_.begin(plan.free, {.dt_substep = plan.dt_substep,
                            .dt_of_past = store_.dt_of_past(),
                            .substeps = plan.substeps,
                            .stands = plan.projects(),
                            .has_past = now_.has_past,
                            .gravity = gravity});
    if (!free_.empty() && far_.empty()) {
      far_ = shortest_lengths(model_);
      for (double& far : far_) far *= now_.local_tolerance();
    }
  }
  void advance_free_bodies() {
    if (free_.empty()) return;
    contact_times_.timed(&ContactMs::find, [&] {
      free_.advance(now_.formula);
      if (free_.searches()) free_.search(store_.points(false));
    });
  }
  void hold_free_bodies() {
    if (free_.empty()) return;
    contact_times_.timed(&ContactMs::sweep, [&] {
      if (free_.stands()) free_.search(store_.points(false));
      FreeHost<Store> host(store_, now_, far_);
      free_.hold(host);
    });
  }
  void begin_bodies(const FramePlan& plan, Team& team) {
    if (plan.bodies.empty())
      store_.begin_bodies(plan);
    else
      contact_times_.timed(&ContactMs::find, [&] { store_.begin_bodies(plan); });
    if (plan.projects()) advance_bodies(1, team);
  }
  /// part: of a substep.
  void advance_bodies(double part, Team& team) {
    if (store_.bodies().empty()) return;
    contact_times_.timed(&ContactMs::find, [&] { store_.advance_bodies(part, team); });
  }
  void hold_bodies(Team& team) {
    if (store_.bodies().empty()) return;
    contact_times_.timed(&ContactMs::sweep, [&] { store_.hold_bodies(team); });
    hold_by_meshes(team);
  }
  void hold_by_meshes(Team& team) {
    if (!store_.bodies().has_meshes()) return;
    const Points points = store_.points(true);
    PointParticles particles(points);
    contact_times_.timed(&ContactMs::find, [&] { store_.bodies().find_standing(particles, team); });
    contact_times_.timed(&ContactMs::sweep, [&] { store_.hold_by_meshes(team); });
  }
  /// Seams that share a particle, and sliders of one rail, move what the others hold. They take
  /// turns until all hold: else cloth that hangs from a seam beside another one would sink.
  void hold_joints() {
    if (seams_.empty() && sliders_.empty()) return;
    const Points points = store_.points(false);
    seams_.draw(points, time_of_seams(), !now_.is_begun);
    double most = sliders_.hold(points, !now_.is_begun);
    for (int turn = 1; turn < tuning::kJointTurns; ++turn) {
      const double of_seams = seams_.draw_joined(points, time_of_seams());
      if (std::max(most, of_seams) <= tuning::kJointShare * now_.settings.contact_tolerance) return;
      most = sliders_.hold(points, false);
    }
  }
  double time_of_seams() const { return 1 / now_.law_step().springs.scale; }

  /// Mending of laws is no motion: a sweep leaves some of their load as an error, and the next one
  /// would have it again.
  void set_aside() {
    if (model_.has_laws() && !std::exchange(now_.is_aside, true)) store_.set_aside();
  }
  /// A contact ends a motion, and so do a limit and a rope that becomes taut: from there a particle
  /// goes on at first order. Where mending has moved one its past is moved alike, but for those
  /// that a sphere has pushed: they begin a new one, by where they are.
  void end_motions(Team& team) {
    if (std::exchange(now_.is_aside, false)) store_.take_past_along(team);
    take_each_once(now_.touched, [&](std::uint32_t slot) {
      if (now_.is_free(slot)) store_.stop_at_contact(slot);
    });
    if (now_.is_begun && !linkage_.empty()) {
      linkage_.for_each_arrival(store_.points(false),
                                [&](std::uint32_t slot) { now_.arrived.push_back({slot}); });
    }
    if (store_.bodies().has_meshes()) {
      const Points points = store_.points(true);
      PointParticles particles(points);
      store_.bodies().end_substep(particles, team);
    }
    take_velocity_jumps(now_.velocity_jumps, [&](const VelocityJump& jump) {
      if (now_.is_free(jump.slot)) store_.jump_velocity(jump.slot, jump.by - held_by_body(jump));
    });
    take_arrivals(now_.arrived, [&](const Arrival& arrival) { begin_at_limit(arrival); });
    if (!free_.empty())
      free_.take_arrivals(now_.next_formula, [&](std::uint32_t slot) { return begin_at(slot); });
  }
  /// The same as it comes to touch a body that moves by itself.
  ChangedPast begin_at(std::uint32_t slot) {
    const kernels::Vector v = store_.velocity_before(slot);
    const kernels::Vector start = store_.points(false).position_at_start(slot);
    store_.begin_at_limit(slot);
    const auto points = store_.points(false);
    return {points.position(slot), store_.velocity_before(slot) - v,
            start - points.position_at_start(slot)};
  }
  /// The part of a jump that bodies keep out.
  kernels::Vector held_by_body(const VelocityJump& jump) {
    auto& bodies = store_.bodies();
    if (bodies.empty()) return {};
    const kernels::Vector x = store_.points(false).position(jump.slot);
    const double counts = model_.mass[jump.slot] * now_.next_formula.share_of_past();
    if (const auto [surface, normal] = bodies.meshes().touched_by(jump.slot); surface.is_there()) {
      const kernels::Vector into = std::min(0.0, dot(normal, jump.by)) * normal;
      bodies.load_of_mesh(surface, x, counts * into);
      return into;
    }
    if (!bodies.touches(jump.slot)) return {};
    const auto [surface, normal] = bodies.nearest_surface(jump.slot, x);
    if (!surface.is_there()) return {};
    const kernels::Vector into = std::min(0.0, dot(normal, jump.by)) * normal;
    bodies.arrive(surface, x, store_.velocity(jump.slot), counts * into);
    return into;
  }
  /// The velocity is that at the end of this substep, and the past a free flight that leads to it.
  void begin_at_limit(const Arrival& arrival) {
    const std::uint32_t slot = arrival.slot;
    const kernels::Vector v_before = store_.velocity_before(slot);
    store_.begin_at_limit(slot);
    if (!arrival.surface.is_there()) return;
    const double counts = model_.mass[slot] * now_.next_formula.share_of_past();
    store_.bodies().arrive(arrival.surface, store_.points(false).position(slot),
                           store_.velocity(slot),
                           counts * (v_before - store_.velocity_before(slot)));
  }
  void settle(bool measures, Team& team) {
    const std::optional<double> departure = store_.settle(measures, team);
    if (measures) add_departure(departure);
  }
  /// Nothing where velocities were settled already.
  void add_departure(std::optional<double> largest) {
    if (largest) departures_.add(*largest, now_.formula.error_share);
  }

  const Model& model_;
  const SmallStepsLayout& layout_;
  Substep now_;
  SeamThreads seams_;
  SliderThreads sliders_;
  CreaseThreads creases_;
  FreeBodies free_;
  std::vector<double> far_;  // of FreeHost; made when the first body is there
  Departures departures_;
  ContactTimes contact_times_;
  CarriedForces carried_;
  Linkage linkage_;
  Store store_;
};

}  // namespace

std::unique_ptr<SmallSteps> make_small_steps(const Model& model, const Settings& settings,
                                             const simd::Table& table) {
  if (settings.backend == Backend::reference)
    return std::make_unique<StoredSmallSteps<ReferenceStore>>(model, settings, table);
  return std::make_unique<StoredSmallSteps<LaneStore>>(model, settings, table);
}

}  // namespace weft
