#include "engine/model/change.h"

#include <algorithm>
#include <utility>

#include "engine/model/validate.h"
#include "engine/public_vectors.h"
#include "engine/validation.h"

namespace weft {
namespace {

using kernels::Vector;

class Describer {
 public:
  explicit Describer(const Model& model) : model_(model) {}

  SceneDescription description() && {
    describe_particles();
    describe_constraints();
    describe_membrane();
    describe_bending();
    for (const auto& [a, b, c] : model_.surface)
      description_.surface.push_back({particle(a), particle(b), particle(c)});
    describe_air();
    description_.pressures = model_.pressures;
    description_.anchors = model_.anchors.described;
    description_.tethers = model_.tethers;
    description_.tether_slack = model_.tether_slack;
    describe_seams();
    describe_sliders();
    description_.damping = model_.damping;
    description_.friction = model_.friction;
    description_.self_contact = model_.self_contact;
    description_.gravity = to_public(model_.gravity);
    return std::move(description_);
  }

 private:
  std::uint32_t particle(std::uint32_t slot) const { return model_.ordering.particle_at[slot]; }
  std::vector<std::uint32_t> particles(const std::vector<std::uint32_t>& slots) const {
    std::vector<std::uint32_t> list;
    for (const std::uint32_t slot : slots) list.push_back(particle(slot));
    return list;
  }

  void describe_particles() {
    for (const std::uint32_t slot : model_.ordering.slot_of) {
      description_.positions.push_back(to_public(model_.initial_position[slot]));
      description_.velocities.push_back(to_public(model_.initial_velocity[slot]));
      description_.masses.push_back(model_.mass[slot]);
      if (model_.has_spheres()) description_.radii.push_back(model_.radius[slot]);
    }
    description_.fixed = particles(model_.pins);
    description_.spheres = particles(model_.spheres);
  }

  void describe_constraints() {
    const ConstraintStore& s = model_.constraints;
    const InertStore& inert = model_.inert;
    description_.constraints.resize(s.size() + inert.constraints.size());
    for (std::uint32_t c = 0; c < s.size(); ++c) {
      Constraint& to = description_.constraints[s.described[c]];
      to = {.a = particle(s.a[c]),
            .b = particle(s.b[c]),
            .rest_length = s.rest_length[c],
            .kind = c < s.bilateral ? ConstraintKind::distance : ConstraintKind::rope,
            .compliance = s.has_springs() ? s.compliance[c] : 0};
      if (!s.strength.empty()) to.strength = s.strength[c];
      if (s.turned[c]) std::swap(to.a, to.b);
    }
    for (const auto& [described, c] : inert.constraints) description_.constraints[described] = c;
  }

  void describe_membrane() {
    const MembraneStore& s = model_.membrane;
    const InertStore& inert = model_.inert;
    description_.membrane.resize(s.size() + inert.membrane.size());
    for (std::uint32_t i = 0; i < s.size(); ++i) {
      MembraneElement& to = description_.membrane[s.described[i]];
      for (std::size_t k = 0; k < 3; ++k) to.particles[k] = particle(s.slots[i][k]);
      to.rest = s.rest[i];
      const auto& [warp, weft, shear] = s.element[i].stiffness;
      to.warp = warp;
      to.weft = weft;
      to.shear = shear;
      to.kind = s.element[i].is_rope ? ConstraintKind::rope : ConstraintKind::distance;
      if (!s.strength.empty()) to.strength = s.strength[i];
    }
    for (const auto& [described, e] : inert.membrane) description_.membrane[described] = e;
  }

  BendingElement element(std::size_t i) const {
    const BendingStore& s = model_.bending;
    BendingElement element{.weights = s.weights[i],
                           .rest = s.rest[i],
                           .compliance = s.compliance[i],
                           .fold = s.fold[i]};
    if (s.may_yield()) {
      element.yield = s.yielding[i].yield;
      element.hardening = s.yielding[i].hardening;
      element.arm = s.yielding[i].arm;
    }
    const bool has_three = s.slots[i][3] == s.slots[i][2];
    for (std::size_t k = 0; k < 4; ++k) {
      element.particles[k] = k == 3 && has_three ? kNoIndex : particle(s.slots[i][k]);
    }
    return element;
  }
  void describe_bending() {
    const auto& inert = model_.inert.bending;
    auto next = inert.begin();
    std::size_t active = 0;
    for (std::uint32_t i = 0; i < model_.bending.size() + inert.size(); ++i) {
      const bool is_inert = next != inert.end() && next->described == i;
      description_.bending.push_back(is_inert ? (next++)->entry : element(active++));
    }
  }

  void describe_seams() {
    const SeamStore& s = model_.seams;
    for (std::size_t i = 0; i < s.size(); ++i) {
      description_.seams.push_back(
          {particle(s.a[i]), particle(s.b[i]), s.time[i], s.force[i], s.strength[i]});
    }
  }

  void describe_sliders() {
    const SliderStore& s = model_.sliders;
    for (std::size_t i = 0; i < s.size(); ++i)
      description_.sliders.push_back({particle(s.slot[i]), s.first[i], s.last[i], s.friction[i]});
    description_.rail_particles = particles(s.rail);
  }

  void describe_air() {
    const AirStore& air = model_.air;
    Air& to = description_.air;
    for (const auto& [a, b, c] : air.triangles) {
      to.triangles.push_back({particle(a), particle(b), particle(c)});
    }
    to.density = air.density;
    to.drag = air.drag;
    to.lift = air.lift;
    to.ram = air.ram;
    to.wind = to_public(air.wind);
  }

  const Model& model_;
  SceneDescription description_;
};

void apply(const Changes& changes, SceneDescription& d) {
  for (const ChangedValue& c : changes.masses) d.masses[c.index] = c.value;
  for (const ChangedValue& c : changes.rest_lengths) d.constraints[c.index].rest_length = c.value;
  for (const ChangedValue& c : changes.compliances) d.constraints[c.index].compliance = c.value;
  for (const ChangedMembrane& c : changes.membrane) {
    MembraneElement& element = d.membrane[c.index];
    element.warp = c.warp;
    element.weft = c.weft;
    element.shear = c.shear;
  }
  for (const ChangedValue& c : changes.bending) d.bending[c.index].compliance = c.value;
  if (changes.damping) d.damping = *changes.damping;
  if (changes.air) {
    d.air.density = changes.air->density;
    d.air.drag = changes.air->drag;
    d.air.lift = changes.air->lift;
    d.air.ram = changes.air->ram;
  }
  std::vector<std::uint8_t> released(d.positions.size());
  for (const std::uint32_t i : changes.release) released[i] = 1;
  std::erase_if(d.fixed, [&](std::uint32_t i) { return released[i] != 0; });
  d.fixed.insert(d.fixed.end(), changes.fix.begin(), changes.fix.end());
}

}  // namespace

SceneDescription description_of(const Model& model) { return Describer(model).description(); }

std::shared_ptr<const Model> with_anchor_distances(const Model& model,
                                                   std::span<const AnchorLimit> limits) {
  SceneDescription description = description_of(model);
  for (std::size_t i = 0; i < limits.size(); ++i)
    description.anchors[i].max_distance = limits[i].max_distance;
  return std::make_shared<Model>(description, &model);
}

namespace {

template <class Element>
Result<void> validate_same_particles(std::string_view name, const std::vector<Element>& own,
                                     const std::vector<Element>& given) {
  if (auto r = validate_size(name, given.size(), own.size()); !r) return r;
  Result<void> result;
  for (std::size_t i = 0; i < own.size() && result; ++i) {
    for_each_element_field<Element>([&](const auto& field) {
      const bool tells =
          std::string_view(field.name).starts_with("particle") || field.values == Values::particle;
      if (!tells || own[i].*field.member == given[i].*field.member) return;
      result = refuse(element(name, i) + "." + field.name, "is not as the cloth has it",
                      "element " + std::to_string(i));
    });
  }
  return result;
}

void take_rest(const Constraint& from, double scale, Constraint& to) {
  to.rest_length = scale * from.rest_length;
  to.compliance = from.compliance;
}
void take_rest(const MembraneElement& from, double scale, MembraneElement& to) {
  to.rest = from.rest;
  for (auto& [u, v] : to.rest) u *= scale, v *= scale;
}
/// One that a tear has cut stays so.
void take_rest(const BendingElement& from, double scale, BendingElement& to) {
  if (std::ranges::all_of(to.weights, [](double weight) { return weight == 0; })) return;
  to.weights = from.weights;
  for (double& weight : to.weights) weight /= scale;
  to.rest = from.rest;
  to.fold = from.fold;
  to.yield = from.yield;
  to.hardening = from.hardening;
  to.arm = from.arm;
  to.compliance = from.compliance;
}
void take_rest(const Tether& from, double scale, Tether& to) { to.length = scale * from.length; }

}  // namespace

Result<SceneDescription> with_rest_shape(const Model& model, const SceneDescription& scene,
                                         double scale) {
  if (auto r = validate_positive("scale", scale); !r) return Error{r.error()};
  SceneDescription description = description_of(model);
  Result<void> result;
  const auto take = [&](std::string_view name, auto list) {
    if (!result) return;
    result = validate_same_particles(name, description.*list, scene.*list);
    if (!result && model.tears > 0)
      result = refuse("scene", "must be of the cloth as it has torn", result.error());
    if (!result) return;
    for (std::size_t i = 0; i < (scene.*list).size(); ++i)
      take_rest((scene.*list)[i], scale, (description.*list)[i]);
  };
  take("constraints", &SceneDescription::constraints);
  take("membrane", &SceneDescription::membrane);
  take("bending", &SceneDescription::bending);
  take("tethers", &SceneDescription::tethers);
  if (result) result = validate_elements(description);
  if (!result) return Error{result.error()};
  return description;
}

std::shared_ptr<const Model> rebuilt(const Model& model, const SceneDescription& description) {
  return std::make_shared<Model>(description, &model);
}

namespace {

/// Whether nothing changes that orderings, constraints and triangles of fabric are prepared for.
bool keeps_constraints(const Changes& c) {
  return c.fix.empty() && c.release.empty() && c.masses.empty() && c.rest_lengths.empty() &&
         c.compliances.empty() && c.membrane.empty();
}

}  // namespace

std::shared_ptr<const Model> changed(const Model& model, const Changes& changes) {
  if (keeps_constraints(changes)) {
    auto other = std::make_shared<Model>(model);
    if (changes.damping) other->damping = *changes.damping;
    if (changes.air) other->set_air(*changes.air);
    if (!changes.bending.empty()) other->set_bending_compliances(changes.bending);
    return other;
  }
  SceneDescription description = description_of(model);
  apply(changes, description);
  return std::make_shared<Model>(description, &model);
}

}  // namespace weft
