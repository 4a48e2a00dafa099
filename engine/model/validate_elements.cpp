/// Checks elements of a scene: the values of their fields (weft/scene_fields.h), and the rules of
/// each kind.
#include <weft/scene_fields.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "engine/hypotenuse.h"
#include "engine/model/validate.h"
#include "engine/validation.h"
#include "kernels/reference/membrane.h"

namespace weft {
namespace {

// ---------------------------------------------------------------------------------- rules of one

using Rule = Result<void>;

Rule rule_of(const FieldName& field, const Constraint& c, std::size_t) {
  return c.a != c.b ? Rule() : refuse(field, "joins a particle to itself", std::to_string(c.a));
}

Rule rule_of(const FieldName& field, const Seam& seam, std::size_t) {
  if (seam.a != seam.b) return {};
  return refuse(field, "sews a particle to itself", std::to_string(seam.a));
}

Rule rule_of(const FieldName& field, const Tether& tether, std::size_t) {
  if (tether.particle != tether.pin) return {};
  return refuse(field, "ties a particle to itself", std::to_string(tether.pin));
}

Rule rule_of(const FieldName&, const Slider&, std::size_t) { return {}; }

Rule rule_of(const FieldName& field, const Anchor& anchor, std::size_t) {
  if (anchor.backstop_radius == 0) return {};
  if (anchor.backstop_radius < kLeastSquared) {
    return refuse(field.member("backstop_radius"), "must be 0 or at least 1e-150, to be squared",
                  number(anchor.backstop_radius));
  }
  return validate_normal(field.member("normal"), anchor.normal);
}

/// Weights cancel but for their rounding.
constexpr double kLeastSum = 1e-9;

Rule rule_of_weights(const FieldName& field, const BendingElement& b) {
  double sum = 0, size = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (!std::isfinite(b.weights[i]) || std::abs(b.weights[i]) > kMostSquared)
      return refuse(field.at(i), "must be finite", number(b.weights[i]));
    sum += b.weights[i];
    size += std::abs(b.weights[i]);
  }
  if (b.particles[3] == kNoIndex && b.weights[3] != 0)
    return refuse(field.at(3), "has no particle", number(b.weights[3]));
  if (std::abs(sum) <= kLeastSum * size) return {};
  return refuse(field, "must sum to 0", number(sum));
}

Rule rule_of_yield(const FieldName& field, const BendingElement& b) {
  if (std::isinf(b.yield)) return {};
  for (const auto& [name, value] : {std::pair{"yield", b.yield}, std::pair{"arm", b.arm}}) {
    if (value >= kLeastSquared && value <= kMostSquared) continue;
    return refuse(field.member(name), "must be from 1e-150 to 1e150, to be squared", number(value));
  }
  if (std::abs(b.fold) <= (1 + kLeastSum) * 2 * b.arm) return {};
  return refuse(field.member("fold"), "is longer than both arms", number(b.fold));
}

Rule rule_of(const FieldName& field, const BendingElement& b, std::size_t particles) {
  const bool has_three = b.particles[3] == kNoIndex;
  const auto corners = std::span(b.particles).first(has_three ? 3 : 4);
  if (auto r = validate_corners(field.member("particles"), corners, particles); !r) return r;
  if (auto r = rule_of_weights(field.member("weights"), b); !r) return r;
  if (!std::isfinite(b.fold) || std::abs(b.fold) > kMostSquared)
    return refuse(field.member("fold"), "must be finite", number(b.fold));
  for (const auto& [name, value] : {std::pair{"fold", b.fold}, std::pair{"yield", b.yield}}) {
    const bool is_given = value != 0 && std::isfinite(value);
    if (!is_given) continue;
    if (has_three) return refuse(field.member(name), "three particles have no side", number(value));
    if (b.rest != 0) return refuse(field.member(name), "has a rest besides", number(value));
  }
  return rule_of_yield(field, b);
}

/// m, of a triangle of fabric: its area has a square.
constexpr double kLeastSide = 1e-75, kMostSide = 1e75;
/// The least ratio of twice the area of a triangle to two of its sides: below this it is rounding.
constexpr double kLeastSine = 1e-9;

Rule rule_of(const FieldName& element_field, const MembraneElement& e, std::size_t particles) {
  if (auto r = validate_corners(element_field.member("particles"), e.particles, particles); !r)
    return r;
  const FieldName field = element_field.member("rest");
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& [u, v] = e.rest[k];
    if (std::isfinite(u) && std::isfinite(v)) continue;
    return refuse(field.at(k), "must be finite", number(u) + ", " + number(v));
  }
  double sides[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& [u, v] = e.rest[k];
    const auto& [next_u, next_v] = e.rest[(k + 1) % 3];
    sides[k] = hypotenuse(next_u - u, next_v - v);
    if (sides[k] >= kLeastSide && sides[k] <= kMostSide) continue;
    return refuse(field.at(k), "must be from 1e-75 to 1e75 m away from the next corner",
                  number(sides[k]));
  }
  const double area = reference::shape_of(e.rest).area;
  if (area > kLeastSine * sides[0] * sides[2]) return {};
  return refuse(field, "the corners lie on a line, the area must be greater than 0", number(area));
}

// --------------------------------------------------------------------------------- rules of lists

Rule rule_of_list(const SceneDescription&, const auto&) { return {}; }

constexpr std::size_t kMostConstraints = std::size_t{1} << 26;

std::uint64_t key(const Constraint& c) {
  const auto [low, high] = std::minmax(c.a, c.b);
  return (std::uint64_t{low} << 32) | high;
}

Rule rule_of_list(const SceneDescription&, const std::vector<Constraint>& constraints) {
  if (constraints.size() > kMostConstraints) {
    return refuse("constraints", "at most " + std::to_string(kMostConstraints),
                  std::to_string(constraints.size()));
  }
  std::vector<std::uint32_t> order(constraints.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    return std::pair(key(constraints[i]), i) < std::pair(key(constraints[j]), j);
  });
  for (std::size_t k = 1; k < order.size(); ++k) {
    const Constraint& c = constraints[order[k]];
    if (key(c) != key(constraints[order[k - 1]])) continue;
    return refuse(element("constraints", order[k]),
                  "joins the same particles as " + element("constraints", order[k - 1]),
                  std::to_string(c.a) + ", " + std::to_string(c.b));
  }
  return {};
}

/// A tear takes the weights of the elements that it cuts.
Rule rule_of_list(const SceneDescription& d, const std::vector<BendingElement>& elements) {
  const auto may_break = [](const auto& e) { return std::isfinite(e.strength); };
  if (std::ranges::any_of(d.constraints, may_break) || std::ranges::any_of(d.membrane, may_break))
    return {};
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const bool is_cut = std::ranges::all_of(elements[i].weights, [](double w) { return w == 0; });
    if (is_cut) return refuse(element("bending", i) + ".weights", "must not all be 0", "0");
  }
  return {};
}

Rule rule_of_list(const SceneDescription& d, const std::vector<Anchor>& anchors) {
  if (anchors.empty()) return {};
  std::vector<bool> taken(d.positions.size()), fixed(taken.size());
  for (const std::uint32_t particle : d.fixed) fixed[particle] = true;
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    const std::uint32_t particle = anchors[i].particle;
    if (!fixed[particle] && !taken[particle]) {
      taken[particle] = true;
      continue;
    }
    return refuse(element("anchors", i) + ".particle",
                  fixed[particle] ? "is a fixed particle" : "has an anchor already",
                  std::to_string(particle));
  }
  return {};
}

Rule rule_of_list(const SceneDescription& d, const std::vector<Tether>& tethers) {
  if (tethers.empty()) return {};
  std::vector<bool> anchored(d.positions.size()), tied(anchored.size());
  for (const Anchor& anchor : d.anchors) anchored[anchor.particle] = true;
  for (std::size_t i = 0; i < tethers.size(); ++i) {
    const std::uint32_t particle = tethers[i].particle;
    if (!anchored[particle] && !tied[particle]) {
      tied[particle] = true;
      continue;
    }
    return refuse(element("tethers", i) + ".particle",
                  anchored[particle] ? "has an anchor" : "has a tether already",
                  std::to_string(particle));
  }
  return {};
}

Rule rule_of_rail(const SceneDescription& d, const FieldName& field, const Slider& slider) {
  const std::vector<std::uint32_t>& rail = d.rail_particles;
  const FieldName particles("rail_particles");
  if (slider.last >= rail.size()) {
    return refuse(field.member("last"),
                  "is not in rail_particles, which has " + std::to_string(rail.size()),
                  std::to_string(slider.last));
  }
  if (slider.first >= slider.last)
    return refuse(field.member("first"), "must be before the last", std::to_string(slider.first));
  for (std::uint32_t i = slider.first; i <= slider.last; ++i) {
    const FieldName at = particles.at(i);
    if (auto r = validate_particle(at, rail[i], d.positions.size()); !r) return r;
    if (rail[i] == slider.particle)
      return refuse(at, "slides on this rail itself", std::to_string(rail[i]));
    if (i > slider.first && rail[i] == rail[i - 1])
      return refuse(at, "follows itself", std::to_string(rail[i]));
  }
  const bool is_closed = rail[slider.first] == rail[slider.last];
  if (!is_closed || slider.last - slider.first >= 3) return {};
  return refuse(field.member("last"), "a closed rail needs three particles",
                std::to_string(slider.last));
}

Rule rule_of_list(const SceneDescription& d, const std::vector<Slider>& sliders) {
  const FieldName list("sliders"), particles("rail_particles");
  std::vector<bool> slides(sliders.empty() ? 0 : d.positions.size());
  for (std::size_t i = 0; i < sliders.size(); ++i) {
    const FieldName field = list.at(i);
    if (auto r = rule_of_rail(d, field, sliders[i]); !r) return r;
    const std::uint32_t particle = sliders[i].particle;
    if (slides[particle])
      return refuse(field.member("particle"), "slides on a rail already", std::to_string(particle));
    slides[particle] = true;
  }
  for (std::size_t i = 0; i < d.rail_particles.size(); ++i) {
    if (auto r = validate_particle(particles.at(i), d.rail_particles[i], d.positions.size()); !r)
      return r;
  }
  return {};
}

// ---------------------------------------------------------------------------------- any element

Rule validate_value(Values values, const FieldName& field, double value, std::size_t) {
  return validate_number(values, field, value);
}
Rule validate_value(Values values, const FieldName& field, std::uint32_t particle,
                    std::size_t count) {
  if (values == Values::ruled) return {};
  return validate_particle(field, particle, count);
}
Rule validate_value(Values, const FieldName& field, ConstraintKind kind, std::size_t) {
  return validate_kind(field, kind);
}
Rule validate_value(Values values, const FieldName& field, Vec3 v, std::size_t) {
  if (values == Values::ruled || finite(v)) return {};
  return refuse(field, "must be finite", text(v));
}
template <class T, std::size_t n>
Rule validate_value(Values, const FieldName&, const std::array<T, n>&, std::size_t) {
  return {};  // A rule of the element says it.
}

template <class Element>
Rule validate_element(const FieldName& field, const Element& element, std::size_t particles) {
  Rule result;
  for_each_element_field<Element>([&](const auto& f) {
    if (result)
      result = validate_value(f.values, field.member(f.name), element.*f.member, particles);
  });
  return result ? rule_of(field, element, particles) : result;
}

template <class Element>
Rule validate_list(const SceneDescription& d, const ElementKind<Element>& kind) {
  const std::vector<Element>& list = d.*kind.list;
  const FieldName name(kind.name);
  for (std::size_t i = 0; i < list.size(); ++i) {
    auto r = validate_element(name.at(i), list[i], d.positions.size());
    if (!r) return r;
  }
  return rule_of_list(d, list);
}

}  // namespace

Result<void> validate_number(Values values, const FieldName& field, double value) {
  switch (values) {
    case Values::positive:
      return validate_positive(field, value);
    case Values::squared:
      if (auto r = validate_positive(field, value); !r) return r;
      return validate_square(field, value);
    case Values::not_negative:
      return validate_not_negative(field, value);
    case Values::positive_or_infinite:
      if (value > 0) return {};
      return refuse(field, "must be greater than 0, or infinite", number(value));
    case Values::not_negative_or_infinite:
      if (value >= 0) return {};
      return refuse(field, "must be at least 0, or infinite", number(value));
    case Values::finite:
      if (std::isfinite(value)) return {};
      return refuse(field, "must be finite", number(value));
    case Values::particle:
    case Values::kind:
    case Values::ruled:
      break;
  }
  return {};
}

Result<void> validate_corners(const FieldName& field, std::span<const std::uint32_t> corners,
                              std::size_t particles) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (auto r = validate_particle(field.at(i), corners[i], particles); !r) return r;
    if (std::ranges::find(corners.first(i), corners[i]) != corners.begin() + static_cast<long>(i))
      return refuse(field.at(i), "particle is listed twice", std::to_string(corners[i]));
  }
  return {};
}

Result<void> validate_elements(const SceneDescription& d) {
  Result<void> result;
  for_each_element_kind([&](const auto& kind) {
    if (result) result = validate_list(d, kind);
  });
  for_each_part_field<SceneDescription>([&](const auto& f) {
    if (result) result = validate_value(f.values, f.name, d.*f.member, d.positions.size());
  });
  return result;
}

}  // namespace weft
