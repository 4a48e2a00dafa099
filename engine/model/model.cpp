#include "engine/model/model.h"

#include <algorithm>
#include <cmath>

#include "engine/model/nearest.h"
#include "engine/model/pressures.h"
#include "engine/model/validate.h"
#include "kernels/reference/relax.h"

namespace weft {
namespace {

/// Those whose pin is fixed, and their particle is not; and those of tether_slack behind them.
std::vector<Tether> acting_tethers(const SceneDescription& d) {
  std::vector<Tether> acting;
  if (d.tethers.empty() && std::isinf(d.tether_slack)) return acting;
  std::vector<bool> is_fixed(d.positions.size()), is_held(is_fixed.size());
  for (const std::uint32_t pin : d.fixed) is_fixed[pin] = is_held[pin] = true;
  for (const Anchor& anchor : d.anchors) is_held[anchor.particle] = true;
  for (const Tether& tether : d.tethers) {
    if (!is_fixed[tether.pin] || is_held[tether.particle]) continue;
    acting.push_back(tether);
    is_held[tether.particle] = true;
  }
  if (std::isinf(d.tether_slack)) return acting;
  const std::vector<Nearest> nearest = find_nearest_pins(d);
  for (std::uint32_t i = 0; i < nearest.size(); ++i) {
    if (nearest[i].end == kNoIndex || is_held[i]) continue;
    acting.push_back({i, nearest[i].end, (1 + d.tether_slack) * nearest[i].length});
  }
  return acting;
}

std::uint64_t pair_of(std::uint32_t a, std::uint32_t b) { return std::uint64_t{a} << 32 | b; }

/// Lists grow by doubling, and a model does not grow.
void shrink_lists(Model& m) {
  const auto fit = [](auto&... lists) { (lists.shrink_to_fit(), ...); };
  ConstraintStore& c = m.constraints;
  fit(c.a, c.b, c.rest_length, c.compliance, c.effective_mass, c.colour, c.described, c.slot);
  fit(m.membrane.slots, m.membrane.rest, m.membrane.element, m.membrane.described);
  BendingStore& b = m.bending;
  fit(b.slots, b.weights, b.rest, b.compliance, b.fold, b.yielding, b.described);
  fit(m.surface, m.air.triangles, m.holds);
}

}  // namespace

/// The known parts of the description, by its numbers, while the model is built.
struct Model::Draft {
  const SceneDescription& description;
  std::vector<std::uint8_t> fixed, held, hub;   // per particle; held: fixed, or attached
  std::vector<std::uint8_t> knot;               // hub of its distances, too (ConstraintStore)
  std::vector<std::uint32_t> described_link{};  // link -> constraint

  explicit Draft(const SceneDescription& d)
      : description(d), fixed(d.positions.size()), hub(d.positions.size()), knot(hub.size()) {
    for (const std::uint32_t i : d.fixed) fixed[i] = 1;
    held = fixed;
    for (const Anchor& anchor : d.anchors) {
      if (anchor.max_distance == 0) held[anchor.particle] = 1;
    }
    std::vector<std::uint32_t> degree(hub.size()), distances(hub.size());
    for (const Constraint& c : d.constraints) {
      if (c.strength == 0) continue;
      for (const std::uint32_t end : {c.a, c.b}) {
        ++degree[end];
        distances[end] += c.kind == ConstraintKind::distance;
      }
    }
    for (std::size_t i = 0; i < hub.size(); ++i) {
      hub[i] = degree[i] > reference::kHubDegree;
      knot[i] = held[i] ? distances[i] > reference::kHubDegree : hub[i];
    }
    for (const std::uint32_t s : d.spheres) hub[s] = knot[s] = 1;
  }
  bool is_inert(const Constraint& c) const { return (held[c.a] && held[c.b]) || c.strength == 0; }
  bool is_at_hub(const Constraint& c) const {
    const auto& of = c.kind == ConstraintKind::distance ? knot : hub;
    return of[c.a] || of[c.b];
  }
};

Model::Model(const SceneDescription& description, const Model* like)
    : particles(description.positions.size()),
      origin(like != nullptr ? like->origin : std::make_shared<const int>(0)),
      tears(like != nullptr ? like->tears : 0) {
  Draft draft(description);
  order_particles(draft, like);
  store_particles(draft);
  store_constraints(draft);
  store_membrane(description);
  store_bending(description);
  store_anchors(description);
  store_seams(description);
  store_sliders(description);
  store_surface(description);
  store_air(description);
  const auto place = [&](std::uint32_t slot) { return initial_position[slot]; };
  pressures = with_volumes(description.pressures, surface, place);
  damping = description.damping;
  friction = description.friction;
  self_contact = description.self_contact;
  find_holds();
  leave_out_compliances();
  for (const std::uint32_t s : spheres) {
    if (inverse_mass[s] > 0) heaviest_sphere = std::max(heaviest_sphere, 1 / inverse_mass[s]);
  }
  uneven = find_unevenness(inverse_mass, constraints.a, constraints.b, constraints.rest_length);
  find_joined();
  may_tear = find_strength();
  shrink_lists(*this);
}

bool Model::find_strength() const {
  const auto is_finite = [](double strength) { return std::isfinite(strength); };
  const auto may_break = [](double strength) { return strength > 0 && std::isfinite(strength); };
  return std::ranges::any_of(constraints.strength, is_finite) ||
         std::ranges::any_of(membrane.strength, is_finite) ||
         std::ranges::any_of(seams.strength, may_break) ||
         std::ranges::any_of(anchors.described, is_finite, &Anchor::strength);
}

namespace {

/// The constraints that are not at hubs, ascending.
std::vector<std::uint32_t> linked(const ConstraintStore& s) {
  std::vector<std::uint32_t> described;
  for (std::size_t c = 0; c < s.size(); ++c) {
    if (s.slot[c] != kNoIndex) described.push_back(s.described[c]);
  }
  std::ranges::sort(described);
  return described;
}

}  // namespace

/// Constraints at hubs take no part: they are solved one after the other anyway. The ordering
/// depends on positions, links and triangles of fabric alone: where the same constraints are links
/// it is the same.
void Model::order_particles(Draft& draft, const Model* like) {
  const SceneDescription& d = draft.description;
  std::vector<Link> links;
  for (std::uint32_t i = 0; i < d.constraints.size(); ++i) {
    const Constraint& c = d.constraints[i];
    if (draft.is_inert(c)) inert.constraints.push_back({i, c});
    if (draft.is_inert(c) || draft.is_at_hub(c)) continue;
    links.push_back({c.a, c.b, c.kind});
    draft.described_link.push_back(i);
  }
  const bool is_same = like != nullptr && like->particles == particles;
  if (is_same && linked(like->constraints) == draft.described_link) {
    ordering = like->ordering;
    spare_slots = like->spare_slots;
    return;
  }
  std::vector<Link> sides;
  for (const MembraneElement& element : d.membrane) {
    const auto& [a, b, c] = element.particles;
    sides.insert(sides.end(), {{a, b}, {b, c}, {c, a}});
  }
  ordering = order(d.positions, links, sides);
  spare_slots = static_cast<std::uint32_t>(ordering.slots());
  ordering.particle_at.resize(ordering.slots() + kLanes, kNoIndex);
}

void Model::store_particles(const Draft& draft) {
  const SceneDescription& d = draft.description;
  initial_position.resize(slots());
  initial_velocity.resize(slots());
  mass.resize(slots());
  inverse_mass.resize(slots());
  hub.resize(slots());
  if (!d.spheres.empty()) radius.resize(slots());
  for (std::uint32_t slot = 0; slot < slots(); ++slot) {
    const std::uint32_t i = ordering.particle_at[slot];
    if (i == kNoIndex) continue;
    initial_position.set(slot, {d.positions[i].x, d.positions[i].y, d.positions[i].z});
    if (!d.velocities.empty() && !draft.held[i]) {
      initial_velocity.set(slot, {d.velocities[i].x, d.velocities[i].y, d.velocities[i].z});
    }
    mass[slot] = d.masses[i];
    inverse_mass[slot] = draft.held[i] ? 0 : 1 / d.masses[i];
    if (!radius.empty()) radius[slot] = d.radii[i];
    if (draft.fixed[i]) pins.push_back(slot);
    hub[slot] = draft.hub[i];
    if (hub[slot]) hubs.push_back(slot);
  }
  for (const std::uint32_t s : d.spheres) spheres.push_back(ordering.slot_of[s]);
  std::ranges::sort(spheres);
  if (!spheres.empty()) is_sphere.resize(slots());
  for (const std::uint32_t s : spheres) is_sphere[s] = 1;
  gravity = {d.gravity.x, d.gravity.y, d.gravity.z};
}

void Model::store_constraints(const Draft& draft) {
  store_batches(draft, ConstraintKind::distance);
  constraints.plain = constraints.size();
  store_hubs(draft, ConstraintKind::distance);
  constraints.bilateral = constraints.size();
  store_batches(draft, ConstraintKind::rope);
  store_hubs(draft, ConstraintKind::rope);
  store_strengths(draft.description);
}

void Model::store_strengths(const SceneDescription& d) {
  const auto may_break = [](const Constraint& c) { return std::isfinite(c.strength); };
  if (std::ranges::none_of(d.constraints, may_break)) return;
  for (const std::uint32_t i : constraints.described)
    constraints.strength.push_back(d.constraints[i].strength);
}

void Model::store_membrane(const SceneDescription& d) {
  const auto may_tear = [](const MembraneElement& e) { return std::isfinite(e.strength); };
  const bool has_strength = std::ranges::any_of(d.membrane, may_tear);
  for (std::uint32_t i = 0; i < d.membrane.size(); ++i) {
    const MembraneElement& element = d.membrane[i];
    std::array<std::uint32_t, 3> slots{};
    std::array<double, 3> w{};
    for (std::size_t k = 0; k < 3; ++k) {
      slots[k] = ordering.slot_of[element.particles[k]];
      w[k] = inverse_mass[slots[k]];
    }
    if (std::ranges::all_of(w, [](double inverse) { return inverse == 0; })) {
      inert.membrane.push_back({i, element});
      continue;
    }
    const reference::MembraneShape shape = reference::shape_of(element.rest);
    membrane.slots.push_back(slots);
    membrane.rest.push_back(element.rest);
    membrane.element.push_back({.shape = shape,
                                .mobility = reference::mobility(shape, w),
                                .stiffness = {element.warp, element.weft, element.shear},
                                .is_rope = element.kind == ConstraintKind::rope});
    membrane.described.push_back(i);
    if (has_strength) membrane.strength.push_back(element.strength);
  }
}

void Model::store_bending(const SceneDescription& d) {
  const bool may_yield = std::ranges::any_of(d.bending, [](const BendingElement& e) {
    return std::isfinite(e.yield) || e.hardening > 0 || e.arm > 0;
  });
  for (std::uint32_t k = 0; k < d.bending.size(); ++k) {
    const BendingElement& element = d.bending[k];
    std::array<std::uint32_t, 4> slots{};
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint32_t particle = element.particles[i];
      slots[i] = particle == kNoIndex ? slots[2] : ordering.slot_of[particle];
    }
    const bool is_cut = std::ranges::all_of(element.weights, [](double w) { return w == 0; });
    if (is_cut ||
        std::ranges::all_of(slots, [&](std::uint32_t s) { return inverse_mass[s] == 0; })) {
      inert.bending.push_back({k, element});
      continue;
    }
    bending.slots.push_back(slots);
    bending.weights.push_back(element.weights);
    bending.rest.push_back(element.rest);
    bending.compliance.push_back(element.compliance);
    bending.fold.push_back(element.fold);
    if (!may_yield) continue;
    bending.yielding.push_back({element.yield, element.hardening, element.arm});
    bending.described.push_back(k);
  }
}

void Model::store_anchors(const SceneDescription& d) {
  tethers = d.tethers;
  tether_slack = d.tether_slack;
  anchors.described = d.anchors;
  const auto add = [&](std::uint32_t particle, const reference::AnchorLimits& limits) {
    const std::uint32_t slot = ordering.slot_of[particle];
    if (anchors.at.empty()) anchors.at.assign(slots(), kNoIndex);
    anchors.at[slot] = static_cast<std::uint32_t>(anchors.size());
    anchors.slot.push_back(slot);
    anchors.limits.push_back(limits);
  };
  for (const Anchor& anchor : d.anchors) {
    const bool has_backstop = anchor.backstop_radius > 0;
    add(anchor.particle, {.most = anchor.max_distance,
                          .distance = anchor.backstop_distance,
                          .curvature = has_backstop ? 1 / anchor.backstop_radius : 0,
                          .has_backstop = has_backstop});
  }
  for (const Tether& tether : acting_tethers(d)) {
    add(tether.particle, {.most = tether.length});
    anchors.pins.push_back(ordering.slot_of[tether.pin]);
  }
}

void Model::store_seams(const SceneDescription& d) {
  for (const Seam& seam : d.seams) {
    seams.a.push_back(ordering.slot_of[seam.a]);
    seams.b.push_back(ordering.slot_of[seam.b]);
    seams.time.push_back(seam.time);
    seams.force.push_back(seam.max_force);
    seams.strength.push_back(seam.strength);
  }
}

void Model::store_sliders(const SceneDescription& d) {
  for (const Slider& slider : d.sliders) {
    sliders.slot.push_back(ordering.slot_of[slider.particle]);
    sliders.first.push_back(slider.first);
    sliders.last.push_back(slider.last);
    sliders.friction.push_back(slider.friction);
  }
  for (const std::uint32_t particle : d.rail_particles)
    sliders.rail.push_back(ordering.slot_of[particle]);
}

void Model::store_surface(const SceneDescription& d) {
  for (const auto& [a, b, c] : d.surface)
    surface.push_back({ordering.slot_of[a], ordering.slot_of[b], ordering.slot_of[c]});
}

void Model::store_air(const SceneDescription& d) {
  air.density = d.air.density;
  air.drag = d.air.drag;
  air.lift = d.air.lift;
  air.ram = d.air.ram;
  air.wind = {d.air.wind.x, d.air.wind.y, d.air.wind.z};
  for (const auto& [a, b, c] : d.air.triangles) {
    air.triangles.push_back({ordering.slot_of[a], ordering.slot_of[b], ordering.slot_of[c]});
  }
  list_air_triangles();
}

void Model::list_air_triangles() {
  if (has_ram() && air.piece.empty()) {
    AirPieces pieces = find_air_pieces(air.triangles);
    air.piece = std::move(pieces.of);
    air.is_open = std::move(pieces.is_open);
  }
  if (!has_air() || air.at.size() > 0) return;
  air.at = make_lists(slots(), [&](auto&& add) {
    for (std::uint32_t i = 0; i < air.triangles.size(); ++i) {
      for (const std::uint32_t slot : air.triangles[i]) add(slot, i);
    }
  });
}

void Model::set_air(const ChangedAir& to) {
  air.density = to.density;
  air.drag = to.drag;
  air.lift = to.lift;
  air.ram = to.ram;
  list_air_triangles();
}

/// Inert elements keep their order among all.
void Model::set_bending_compliances(std::span<const ChangedValue> compliances) {
  std::vector<std::uint32_t> active(bending.size() + inert.bending.size(), kNoIndex);
  for (const auto& [described, e] : inert.bending) active[described] = 0;
  std::uint32_t next = 0;
  for (std::uint32_t& i : active) i = i == 0 ? kNoIndex : next++;
  for (const ChangedValue& c : compliances) {
    if (active[c.index] != kNoIndex) {
      bending.compliance[active[c.index]] = c.value;
      continue;
    }
    const auto at =
        std::ranges::find(inert.bending, c.index, &InertStore::Entry<BendingElement>::described);
    at->entry.compliance = c.value;
  }
  renew_bending_layout();
}

/// Inert constraints are not in the store: another end is free. Points of anchors count by
/// themselves (engine/step/pin_work.h).
void Model::find_holds() {
  const auto is_fixed = [&](std::uint32_t s) { return inverse_mass[s] == 0 && !is_attached(s); };
  for (const auto* ends : {&constraints.a, &constraints.b}) {
    for (const std::uint32_t s : *ends) {
      if (is_fixed(s)) holds.push_back(s);
    }
  }
  for (const auto& corners : membrane.slots) {
    for (const std::uint32_t s : corners) {
      if (is_fixed(s)) holds.push_back(s);
    }
  }
}

void Model::store_batches(const Draft& draft, ConstraintKind kind) {
  for (const Batch& batch : ordering.batches) {
    if (batch.kind != kind) continue;
    for (std::uint32_t slot = batch.first; slot < batch.last; ++slot) {
      const std::uint32_t link = ordering.link_at[slot];
      if (link == kNoIndex) continue;
      const std::uint32_t described = draft.described_link[link];
      append(draft.description.constraints[described], described, ordering.a[slot],
             ordering.b[slot]);
      constraints.colour.back() = batch.colour;
      constraints.slot.back() = slot;
    }
  }
}

void Model::store_hubs(const Draft& draft, ConstraintKind kind) {
  const SceneDescription& d = draft.description;
  auto& list = kind == ConstraintKind::distance ? constraints.hub_distances : constraints.hub_ropes;
  for (std::uint32_t i = 0; i < d.constraints.size(); ++i) {
    const Constraint& c = d.constraints[i];
    if (c.kind != kind || draft.is_inert(c) || !draft.is_at_hub(c)) continue;
    list.push_back(static_cast<std::uint32_t>(constraints.size()));
    append(c, i, ordering.slot_of[c.a], ordering.slot_of[c.b]);
  }
}

/// Spheres are hubs.
void Model::find_joined() {
  if (!has_spheres()) return;
  const ConstraintStore& s = constraints;
  const auto add = [&](std::uint32_t a, std::uint32_t b) {
    if (is_sphere[a]) joined_.push_back(pair_of(a, b));
    if (is_sphere[b]) joined_.push_back(pair_of(b, a));
  };
  for (const auto* list : {&s.hub_distances, &s.hub_ropes}) {
    for (const std::uint32_t c : *list) {
      add(s.a[c], s.b[c]);
    }
  }
  membrane.for_each_side([&](std::uint32_t a, std::uint32_t b, double) { add(a, b); });
  std::ranges::sort(joined_);
}

bool Model::joined_to_sphere(std::uint32_t sphere, std::uint32_t slot) const {
  return std::ranges::binary_search(joined_, pair_of(sphere, slot));
}

bool Model::is_sphere_joined(std::uint32_t sphere) const {
  const auto next = std::ranges::lower_bound(joined_, pair_of(sphere, 0));
  return next != joined_.end() && *next < pair_of(sphere + 1, 0);
}

void Model::append(const Constraint& c, std::uint32_t described, std::uint32_t a, std::uint32_t b) {
  ConstraintStore& s = constraints;
  s.a.push_back(a);
  s.b.push_back(b);
  s.rest_length.push_back(c.rest_length);
  s.effective_mass.push_back(1 / (inverse_mass[a] + inverse_mass[b]));
  s.compliance.push_back(c.compliance);
  s.colour.push_back(kNoIndex);
  s.turned.push_back(ordering.particle_at[a] != c.a);
  s.described.push_back(described);
  s.slot.push_back(kNoIndex);
}

std::vector<Link> links_of(const ConstraintStore& store, std::size_t count) {
  std::vector<Link> links;
  links.reserve(count);
  for (std::size_t c = 0; c < count; ++c) links.push_back({store.a[c], store.b[c]});
  return links;
}

bool BendingStore::is_folded() const {
  return std::ranges::any_of(fold, [](double angle) { return angle != 0; });
}

reference::AnchorPose pose_of(Vec3 point, Vec3 normal) {
  const kernels::Vector n{normal.x, normal.y, normal.z};
  return {{point.x, point.y, point.z}, kernels::direction(n, length(n))};
}

Result<std::shared_ptr<const Model>> build_model(const SceneDescription& description) {
  if (auto valid = validate(description); !valid) return Error{valid.error()};
  return std::shared_ptr<const Model>(std::make_shared<Model>(description));
}

ModelInfo describe(const Model& model) {
  const ConstraintStore& s = model.constraints;
  return {.particles = model.particles,
          .constraints = s.size(),
          .inert_constraints = model.inert.constraints.size(),
          .ropes = s.size() - s.bilateral,
          .compliant = static_cast<std::size_t>(
              std::ranges::count_if(s.compliance, [](double c) { return c > 0; })),
          .membrane_elements = model.membrane.size(),
          .bending_elements = model.bending.size(),
          .anchors = model.anchors.described.size(),
          .seams = static_cast<std::size_t>(
              std::ranges::count_if(model.seams.strength, [](double s) { return s > 0; })),
          .surface_triangles = model.surface.size(),
          .air_triangles = model.air.triangles.size(),
          .spheres = model.spheres.size(),
          .colours = model.ordering.colours,
          .tiles = model.ordering.tiles.size(),
          .run_share = model.ordering.run_share,
          .bytes = model.bytes(),
          .tethers = model.anchors.pins.size()};
}

}  // namespace weft
