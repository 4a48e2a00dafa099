#include "tools/scenes/garments.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <set>
#include <utility>

namespace weft::scenes {
namespace {

enum PanelOf : std::size_t { kFront, kBack };

// -------------------------------------------------------------------------------------- tunic

/// Edges of both panels, counterclockwise from the hem.
enum TunicEdge : std::size_t {
  kHem,
  kRightSide,
  kRightUnderarm,
  kRightCuff,
  kRightSleeve,
  kRightPeg,
  kRightNeck,
  kNeckline,
  kLeftNeck,
  kLeftPeg,
  kLeftSleeve,
  kLeftCuff,
  kLeftUnderarm,
  kLeftSide
};

constexpr TunicEdge kSewn[] = {kRightSide, kRightUnderarm, kRightSleeve, kRightPeg,     kRightNeck,
                               kLeftNeck,  kLeftPeg,       kLeftSleeve,  kLeftUnderarm, kLeftSide};

Point mirrored(Point p) { return {-p.x, p.y}; }
double distance(Point a, Point b) { return std::hypot(a.x - b.x, a.y - b.y); }

/// Body and sleeves are of one piece. m, above the floor that its wearer stands on.
Panel tunic_panel(double neckline_depth) {
  const Point hem{0.26, 0.60}, waist{0.17, 0.85}, armpit{0.18, 1.03}, cuff_below{0.46, 1.10},
      cuff_above{0.46, 1.25}, neck{0.085, 1.28};
  const auto shoulder = [&](double x) {
    return Point{x, neck.y + (x - neck.x) / (cuff_above.x - neck.x) * (cuff_above.y - neck.y)};
  };
  const Point peg_out = shoulder(0.20), peg_in = shoulder(0.12), under{0.22, 1.07};
  return {bent(mirrored(hem), {0, 0.57}, hem),
          bent(hem, waist, armpit),
          bent(armpit, under, cuff_below),
          line(cuff_below, cuff_above),
          line(cuff_above, peg_out),
          line(peg_out, peg_in),
          line(peg_in, neck),
          bent(neck, {0, neck.y - 2 * neckline_depth}, mirrored(neck)),
          line(mirrored(neck), mirrored(peg_in)),
          line(mirrored(peg_in), mirrored(peg_out)),
          line(mirrored(peg_out), mirrored(cuff_above)),
          line(mirrored(cuff_above), mirrored(cuff_below)),
          bent(mirrored(cuff_below), mirrored(under), mirrored(armpit)),
          bent(mirrored(armpit), mirrored(waist), mirrored(hem))};
}

/// The nearest of some vertices of a panel, kNoIndex if there is none.
std::uint32_t nearest_of(const CutPattern& cut, std::size_t v,
                         const std::vector<std::uint32_t>& vertices) {
  std::uint32_t nearest = kNoIndex;
  double least = std::numeric_limits<double>::infinity();
  for (const std::uint32_t other : vertices) {
    const double away = distance(cut.flat[v], cut.flat[other]);
    if (cut.panel[other] != cut.panel[v] || away >= least) continue;
    least = away;
    nearest = other;
  }
  return nearest;
}

std::vector<std::uint32_t> sewn_vertices(const CutPattern& cut) {
  std::vector<std::uint32_t> sewn;
  for (const auto& edges : cut.edges) {
    for (const TunicEdge edge : kSewn)
      sewn.insert(sewn.end(), edges[edge].begin(), edges[edge].end());
  }
  return sewn;
}

/// m, from each vertex to the nearest one of its panel that is sewn.
std::vector<double> distances_to_seams(const CutPattern& cut) {
  const std::vector<std::uint32_t> sewn = sewn_vertices(cut);
  std::vector<double> distances;
  for (std::size_t v = 0; v < cut.flat.size(); ++v)
    distances.push_back(distance(cut.flat[v], cut.flat[nearest_of(cut, v, sewn)]));
  return distances;
}

/// Front and back lie against each other with a little air between, which ends at the seams.
std::vector<Vec3> laid_flat(const CutPattern& cut) {
  constexpr double kHalfGap = 0.01, kRamp = 0.1;  // m; between them edges are 0.5 % longer
  const std::vector<double> distances = distances_to_seams(cut);
  std::vector<Vec3> start;
  for (std::size_t v = 0; v < cut.flat.size(); ++v) {
    const double away = kHalfGap * std::min(1.0, distances[v] / kRamp);
    start.push_back({cut.flat[v].x, cut.flat[v].y, cut.panel[v] == kFront ? away : -away});
  }
  return start;
}

/// Like a pillow: its sides are quarters of a circle, for which seams come inwards, so that what
/// leads across them keeps its length.
std::vector<Vec3> laid_around(const CutPattern& cut) {
  constexpr double kRadius = 0.055, kRound = kRadius * std::numbers::pi / 2;  // m
  const std::vector<std::uint32_t> sewn = sewn_vertices(cut);
  std::vector<std::uint32_t> inner(cut.flat.size());
  std::iota(inner.begin(), inner.end(), 0u);
  const std::set<std::uint32_t> border(sewn.begin(), sewn.end());
  std::erase_if(inner, [&](std::uint32_t v) { return border.contains(v); });
  std::vector<Vec3> start;
  for (std::uint32_t v = 0; v < cut.flat.size(); ++v) {
    const bool is_sewn = border.contains(v);
    const Point here = cut.flat[v];
    const Point other = cut.flat[nearest_of(cut, v, is_sewn ? inner : sewn)];
    const double apart = distance(here, other), from_seam = is_sewn ? 0 : apart;
    const double angle = std::min(from_seam, kRound) / kRadius;
    const double inwards = kRound - kRadius * angle - kRadius * std::cos(angle);
    const double share = (is_sewn ? inwards : -inwards) / apart;
    const double away = kRadius * std::sin(angle);
    start.push_back({here.x + share * (other.x - here.x), here.y + share * (other.y - here.y),
                     cut.panel[v] == kFront ? away : -away});
  }
  return start;
}

// -------------------------------------------------------------------------------------- skirt

/// Each panel is a sector of a ring: the cone that both make is `turn()` times as wide in angle as
/// they are when they lie flat.
struct SkirtShape {
  double waist = 0, length = 0;  ///< m, from the centre; and down the skirt
  double sector = 0;             ///< rad
  double height = 0;             ///< m, of the waist
  constexpr double turn() const { return std::numbers::pi / sector; }
};
constexpr SkirtShape kSkirt{0.216, 0.45, 100 * std::numbers::pi / 180, 0.95};
/// Wide enough at its waist for the tunic, and steeper.
constexpr SkirtShape kOuterSkirt{0.6, 0.4, std::numbers::pi / 3, 0.92};

enum SkirtEdge : std::size_t { kSkirtHem, kSkirtRight, kSkirtWaist, kSkirtLeft };

Panel skirt_panel(const SkirtShape& shape) {
  constexpr double kDown = -std::numbers::pi / 2;
  const double left = kDown - shape.sector / 2, right = kDown + shape.sector / 2;
  const auto at = [](double radius, double angle) {
    return Point{radius * std::cos(angle), radius * std::sin(angle)};
  };
  const double outer = shape.waist + shape.length;
  return {arc({}, outer, left, right), line(at(outer, right), at(shape.waist, right)),
          arc({}, shape.waist, right, left), line(at(shape.waist, left), at(outer, left))};
}

/// On the cone that both panels make together; no edge is longer or shorter for it.
Vec3 on_cone(const SkirtShape& shape, Point p, std::size_t panel) {
  const double wider = shape.turn(), radius = std::hypot(p.x, p.y);
  const double turn = wider * std::atan2(p.x, -p.y) + (panel == kBack ? std::numbers::pi : 0);
  const double out = radius / wider;
  const double down = std::sqrt(1 - 1 / (wider * wider)) * (radius - shape.waist);
  return {out * std::sin(turn), shape.height - down, out * std::cos(turn)};
}

Pattern pattern_of(const SkirtShape& shape) {
  Pattern pattern;
  pattern.panels = {skirt_panel(shape), skirt_panel(shape)};
  pattern.seams = {{{kFront, kSkirtRight}, {kBack, kSkirtLeft}, true},
                   {{kBack, kSkirtRight}, {kFront, kSkirtLeft}, true}};
  return pattern;
}

// --------------------------------------------------------------------------------------- both

/// Panels lie side by side at rest, so that none is on another.
std::vector<Vec3> side_by_side(const CutPattern& cut) {
  constexpr double kApart = 3;  // m
  std::vector<Vec3> rest;
  for (std::size_t v = 0; v < cut.flat.size(); ++v)
    rest.push_back({cut.flat[v].x + kApart * static_cast<double>(cut.panel[v]), cut.flat[v].y, 0});
  return rest;
}

Result<CutPattern> cut_for(const Pattern& pattern, const Options& options) {
  return cut(pattern, Grid{options.size}.spacing());
}

Layout layout_of(const CutPattern& cut, std::vector<Vec3> start) {
  Layout layout;
  layout.start = std::move(start);
  layout.rest = side_by_side(cut);
  layout.faces = cut.faces;
  layout.seams = cut.seams;
  return layout;
}

/// Outside is outside on the back, too.
Layout tunic_layout(const CutPattern& cut, std::vector<Vec3> start) {
  Layout layout = layout_of(cut, std::move(start));
  for (Face& face : layout.faces) {
    if (cut.panel[face[0]] == kBack) std::swap(face[1], face[2]);
  }
  return layout;
}

void pin_edge(const CutPattern& cut, PanelEdge edge, Layout& layout) {
  const auto& vertices = cut.edges[edge.panel][edge.edge];
  layout.pins.insert(layout.pins.end(), vertices.begin(), vertices.end());
}

Result<Layout> skirt_layout(const SkirtShape& shape, const Options& options) {
  auto made = cut_for(pattern_of(shape), options);
  if (!made) return Error{made.error()};
  const CutPattern& cut = made.value();
  std::vector<Vec3> start;
  for (std::size_t v = 0; v < cut.flat.size(); ++v)
    start.push_back(on_cone(shape, cut.flat[v], cut.panel[v]));
  Layout layout = layout_of(cut, std::move(start));
  for (const std::size_t panel : {kFront, kBack}) pin_edge(cut, {panel, kSkirtWaist}, layout);
  return layout;
}

}  // namespace

Pattern tunic_pattern() {
  Pattern pattern;
  pattern.panels = {tunic_panel(0.09), tunic_panel(0.03)};
  for (const TunicEdge edge : kSewn) pattern.seams.push_back({{kFront, edge}, {kBack, edge}});
  return pattern;
}

Pattern skirt_pattern() { return pattern_of(kSkirt); }

Result<Layout> worn_tunic(const Options& options) {
  auto made = cut_for(tunic_pattern(), options);
  if (!made) return Error{made.error()};
  return tunic_layout(made.value(), laid_around(made.value()));
}

Result<Layout> hung_tunic(const Options& options) {
  auto made = cut_for(tunic_pattern(), options);
  if (!made) return Error{made.error()};
  const CutPattern& cut = made.value();
  Layout layout = tunic_layout(cut, laid_flat(cut));
  pin_edge(cut, {kFront, kRightPeg}, layout);
  pin_edge(cut, {kFront, kLeftPeg}, layout);
  layout.touches_itself = true;
  return layout;
}

Result<Layout> fitted_skirt(const Options& options) { return skirt_layout(kSkirt, options); }

Result<Layout> outer_skirt(const Options& options) { return skirt_layout(kOuterSkirt, options); }

}  // namespace weft::scenes
