#include "kernels/reference/forms.h"

#include <cmath>

namespace weft::reference {

Form::~Form() = default;

/// A step by the gap never goes too far. A way along the side of a hollow touches it all the time,
/// but does not lead into it: it is looked at where it is deeper than short ways get, too, for it
/// may lead into another side.
Touch Form::touch(double thickness, Vector y0, Vector y1) const {
  const auto over = [&](Vector y) {
    Gap at = gap(y);
    at.gap -= thickness;
    return at;
  };
  const Gap end = over(y1);
  const Vector way = y1 - y0;
  const double l = length(way), near = 1e-6 * (narrow_ + thickness);
  const Touch at_end{end.gap < 0, end.normal, end.gap};
  const bool is_beyond = end.gap > l;  // no point of the way is as near
  if (is_beyond || l <= short_way(thickness)) return at_end;
  const Gap start = over(y0);
  // Where it enters what is `deep` under the surface, or else its end.
  const auto entry = [&](double deep) {
    Gap here = start;
    if (here.gap < -deep && dot(here.normal, way) >= 0) return at_end;
    double at = 0;
    for (int i = 0; i < 64 && here.gap + deep > near; ++i) {
      at += (here.gap + deep) / l;
      if (at >= 1) return at_end;
      here = over(y0 + at * way);
    }
    const double gap = here.gap + (1 - at) * dot(here.normal, way);
    return Touch{gap < 0, here.normal, gap};
  };
  const Touch first = entry(0);
  if (is_convex() || first.gap < -near) return first;
  const Touch deeper = entry(short_way(thickness));
  return deeper.gap < -near ? deeper : at_end;
}

double Form::clear(double thickness, Vector y0, Vector y1) const {
  return (gap(y1).gap - thickness - length(y1 - y0)) / 3;
}

Gap FacedForm::gap(Vector y) const {
  Gap largest{-std::numeric_limits<double>::infinity(), {}};
  for (const Face& face : faces_) {
    const double gap = dot(face.normal, y) - face.offset;
    if (gap > largest.gap) largest = {gap, face.normal};
  }
  return largest;
}

Touch FacedForm::touch(double thickness, Vector y0, Vector y1) const {
  double enters = -1, leaves = std::numeric_limits<double>::infinity();
  const Face* entry = nullptr;
  Touch inside{.gap = 0};
  double nearest = -std::numeric_limits<double>::infinity();
  bool ends_inside = true;
  for (const Face& face : faces_) {
    const double g0 = dot(face.normal, y0) - face.offset - thickness;
    const double g1 = dot(face.normal, y1) - face.offset - thickness;
    if (g0 > 0 && g1 > 0) return {};
    ends_inside = ends_inside && g1 <= 0;
    if (g0 > nearest) {
      nearest = g0;
      inside = {true, face.normal, g1};
    }
    if (g0 <= 0 && g1 <= 0) continue;
    const double at = g0 / (g0 - g1);
    if (g1 > 0) {
      leaves = std::min(leaves, at);
    } else if (at > enters) {
      enters = at;
      entry = &face;
    }
  }
  if (entry == nullptr) return ends_inside || inside.gap < nearest ? inside : Touch{};
  if (enters > leaves) return {};
  return {true, entry->normal, dot(entry->normal, y1) - entry->offset - thickness};
}

double FacedForm::clear(double thickness, Vector y0, Vector y1) const {
  double clear = -std::numeric_limits<double>::infinity();
  for (const Face& face : faces_) {
    const double nearer = std::min(dot(face.normal, y0), dot(face.normal, y1));
    clear = std::max(clear, nearer - face.offset - thickness);
  }
  return clear;
}

Gap RoundForm::gap(Vector y) const {
  const Vector from_a = y - round_.a;
  const double height = dot(from_a, round_.axis);
  const double across = std::sqrt(std::max(0.0, dot(from_a, from_a) - height * height));
  const double lean = round_.taper / std::sqrt(1 - round_.taper * round_.taper);
  const double at = std::clamp(height - lean * across, 0.0, round_.length);
  const Vector d = from_a - at * round_.axis;
  const double l = length(d);
  return {l - (round_.radius - at * round_.taper), kernels::direction(d, l)};
}

}  // namespace weft::reference
