#include "engine/model.h"

#include <algorithm>

#include "engine/bytes_of.h"
#include "engine/validate.h"

namespace weft {
namespace {

template <class Layout>
std::size_t bytes_if_made(const OnDemand<Layout>& layout) {
  return layout.if_made() != nullptr ? layout.if_made()->bytes() : 0;
}

}  // namespace

Model::Model(const SceneDescription& description) : particles(description.positions.size()) {
  find_hubs(description);
  order_particles(description);
  store_particles(description);
  store_constraints(description);
}

void Model::find_hubs(const SceneDescription& d) {
  fixed_particle_.resize(particles);
  for (const std::uint32_t i : d.fixed) fixed_particle_[i] = 1;
  std::vector<std::uint32_t> degree(particles);
  for (const Constraint& c : d.constraints) {
    ++degree[c.a];
    ++degree[c.b];
  }
  hub_particle_.resize(particles);
  for (std::size_t i = 0; i < particles; ++i) {
    hub_particle_[i] = degree[i] > reference::kHubDegree;
  }
  for (const std::uint32_t s : d.spheres) hub_particle_[s] = 1;
}

/// Constraints at hubs take no part: they are solved one after the other anyway.
void Model::order_particles(const SceneDescription& d) {
  std::vector<Link> links;
  for (std::uint32_t i = 0; i < d.constraints.size(); ++i) {
    const Constraint& c = d.constraints[i];
    if (fixed_particle_[c.a] && fixed_particle_[c.b]) continue;
    if (hub_particle_[c.a] || hub_particle_[c.b]) continue;
    links.push_back({c.a, c.b, c.kind});
    described_link_.push_back(i);
  }
  ordering = order(d.positions, links);
  spare_slots = static_cast<std::uint32_t>(ordering.slots());
  ordering.particle_at.resize(ordering.slots() + kLanes, kNoIndex);
}

void Model::store_particles(const SceneDescription& d) {
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
    if (!d.velocities.empty() && !fixed_particle_[i]) {
      initial_velocity.set(slot, {d.velocities[i].x, d.velocities[i].y, d.velocities[i].z});
    }
    mass[slot] = d.masses[i];
    inverse_mass[slot] = fixed_particle_[i] ? 0 : 1 / d.masses[i];
    if (!radius.empty()) radius[slot] = d.radii[i];
    hub[slot] = hub_particle_[i];
    if (hub[slot]) hubs.push_back(slot);
  }
  for (const std::uint32_t s : d.spheres) spheres.push_back(ordering.slot_of[s]);
  gravity = {d.gravity.x, d.gravity.y, d.gravity.z};
}

void Model::store_constraints(const SceneDescription& d) {
  store_batches(d, ConstraintKind::distance);
  constraints.plain = constraints.size();
  store_hubs(d, ConstraintKind::distance);
  constraints.bilateral = constraints.size();
  store_batches(d, ConstraintKind::rope);
  store_hubs(d, ConstraintKind::rope);
  inert_constraints = d.constraints.size() - constraints.size();
}

void Model::store_batches(const SceneDescription& d, ConstraintKind kind) {
  for (const Batch& batch : ordering.batches) {
    if (batch.kind != kind) continue;
    for (std::uint32_t slot = batch.first; slot < batch.last; ++slot) {
      const std::uint32_t link = ordering.link_at[slot];
      if (link == kNoIndex) continue;
      const std::uint32_t described = described_link_[link];
      append(d.constraints[described], described, ordering.a[slot], ordering.b[slot]);
      constraints.colour.back() = batch.colour;
      constraints.slot.back() = slot;
    }
  }
}

void Model::store_hubs(const SceneDescription& d, ConstraintKind kind) {
  auto& list = kind == ConstraintKind::distance ? constraints.hub_distances : constraints.hub_ropes;
  for (std::uint32_t i = 0; i < d.constraints.size(); ++i) {
    const Constraint& c = d.constraints[i];
    if (c.kind != kind || (fixed_particle_[c.a] && fixed_particle_[c.b])) continue;
    if (!hub_particle_[c.a] && !hub_particle_[c.b]) continue;
    list.push_back(static_cast<std::uint32_t>(constraints.size()));
    append(c, i, ordering.slot_of[c.a], ordering.slot_of[c.b]);
  }
}

void Model::append(const Constraint& c, std::uint32_t described, std::uint32_t a, std::uint32_t b) {
  ConstraintStore& s = constraints;
  s.a.push_back(a);
  s.b.push_back(b);
  s.rest_length.push_back(c.rest_length);
  s.effective_mass.push_back(1 / (inverse_mass[a] + inverse_mass[b]));
  s.colour.push_back(kNoIndex);
  s.described.push_back(described);
  s.slot.push_back(kNoIndex);
}

const ReferenceLayout& Model::reference() const {
  return reference_.get([this] { return make_reference_layout(*this); });
}

const SimdLayout& Model::simd() const {
  return simd_.get([this] { return make_simd_layout(*this); });
}

const DirectLayout& Model::direct() const {
  return direct_.get([this] { return make_direct_layout(*this); });
}

const YarnLayout& Model::yarns() const {
  return yarns_.get([this] { return make_yarn_layout(*this); });
}

std::size_t Model::bytes() const {
  const ConstraintStore& s = constraints;
  const Ordering& o = ordering;
  return initial_position.bytes() + initial_velocity.bytes() + bytes_of(mass) +
         bytes_of(inverse_mass) + bytes_of(radius) + bytes_of(hub) + bytes_of(hubs) +
         bytes_of(spheres) + bytes_of(o.slot_of) + bytes_of(o.particle_at) + bytes_of(o.link_at) +
         bytes_of(o.a) + bytes_of(o.b) + bytes_of(o.runs) + bytes_of(o.batches) +
         bytes_of(o.tiles) + bytes_of(s.a) + bytes_of(s.b) + bytes_of(s.rest_length) +
         bytes_of(s.effective_mass) + bytes_of(s.colour) + bytes_of(s.described) +
         bytes_of(s.slot) + bytes_of(fixed_particle_) + bytes_of(hub_particle_) +
         bytes_of(described_link_) + bytes_if_made(reference_) + bytes_if_made(simd_) +
         bytes_if_made(direct_) + bytes_if_made(yarns_);
}

Result<std::shared_ptr<const Model>> build_model(const SceneDescription& description) {
  if (auto valid = validate(description); !valid) return Error{valid.error()};
  return std::shared_ptr<const Model>(std::make_shared<Model>(description));
}

ModelInfo describe(const Model& model) {
  const ConstraintStore& s = model.constraints;
  return {.particles = model.particles,
          .constraints = s.size(),
          .inert_constraints = model.inert_constraints,
          .ropes = s.size() - s.bilateral,
          .spheres = model.spheres.size(),
          .colours = model.ordering.colours,
          .tiles = model.ordering.tiles.size(),
          .run_share = model.ordering.run_share,
          .bytes = model.bytes()};
}

}  // namespace weft
