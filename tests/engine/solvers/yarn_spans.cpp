/// Taut stretches of yarns: which there are, and what they keep.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/model.h"
#include "engine/solvers/yarn_layout.h"
#include "tests/support/clothes.h"
#include "tests/support/mesh_scenes.h"
#include "tests/support/meshes.h"

namespace weft::test {
namespace {

/// A line of six, 0.1 m apart; the first, third and last are fixed.
SceneDescription line() {
  SceneDescription scene;
  for (std::uint32_t i = 0; i < 6; ++i) {
    scene.positions.push_back({0.1 * i, 0, 0});
    scene.masses.push_back(0.01);
    if (i > 0) scene.constraints.push_back({i - 1, i, 0.1});
  }
  scene.fixed = {0, 2, 5};
  return scene;
}

/// A sheet of 5 x 5 with both diagonals of each cell, or none, that hangs by two corners.
SceneDescription sheet(bool diagonals, ConstraintKind kind) {
  Mesh mesh = grid(5, 5);
  if (diagonals) add_diagonals(mesh, 5, 5, kind);
  SceneDescription scene = scene_of(mesh);
  scene.fixed = {0, 4};
  return scene;
}

std::vector<std::uint32_t> links_of_spans(const SceneDescription& scene) {
  const auto model = model_of(scene);
  std::vector<std::uint32_t> links;
  for (const YarnSpan& span : model->yarns().spans) {
    links.push_back(span.last_row - span.row);
  }
  std::ranges::sort(links);
  return links;
}

/// The line's longer span, its ends `apart`, two of its links 1 % too long (the third up to 2 % too
/// short).
struct Line {
  explicit Line(double apart) {
    scene.positions[5].x = 0.2 + apart;
    for (const std::uint32_t i : {3u, 4u}) scene.positions[i].x = 0.2 + (i - 2) * 0.101;
    model = model_of(scene);
  }

  /// Of the longer span's first link, over that of the layout.
  double held(double usual, double tolerance) {
    const YarnLayout& layout = model->yarns();
    const auto span = std::ranges::max_element(layout.spans, {}, &YarnSpan::length);
    REQUIRE(span->last_row - span->row == 3);
    HeldSpans spans(layout);
    Team team(1);
    kernels::Vectors positions = model->initial_position;
    const auto x = positions.view();
    spans.hold(x, x, usual, tolerance, team);
    if (!spans.holds()) return 1;
    const bool backwards = layout.span_slots[span->particle] != model->ordering.slot_of[2];
    const std::uint32_t row = backwards ? span->last_row - 1 : span->row;
    return static_cast<double>(spans.kinds()[spans.kind()[row]].rest[span->lane]) / 0.1;
  }

  SceneDescription scene = line();
  std::shared_ptr<const Model> model;
};

TEST_CASE("between two fixed particles of a yarn is a span, if anything in it can move") {
  CHECK(links_of_spans(line()) == std::vector<std::uint32_t>{2, 3});
  CHECK(links_of_spans(scene_of("hang", 5)).empty());
  CHECK(links_of_spans(sheet(false, {})) == std::vector<std::uint32_t>{4});
}

TEST_CASE("what triangles brace is none") {
  CHECK(links_of_spans(sheet(true, ConstraintKind::distance)).empty());
  CHECK(links_of_spans(sheet(true, ConstraintKind::rope)).empty());
}

TEST_CASE("a taut span keeps its lengths, within most of what is usual") {
  CHECK(Line(0.3).held(0.02, 0.05) == doctest::Approx(1.01).epsilon(1e-6));
  CHECK(Line(0.3).held(0.005, 0.005) == doctest::Approx(1.004).epsilon(1e-6));
}

TEST_CASE("what is out by more than is usual is brought in by a fifth of it, up to the tolerance") {
  CHECK(Line(0.3).held(0.005, 0.01) == doctest::Approx(1.008).epsilon(1e-6));
}

TEST_CASE("spans that are slack, or longer than the tolerance allows, keep nothing") {
  CHECK(Line(0.299).held(0.005, 0.05) > 1);
  CHECK(Line(0.298).held(0.005, 0.05) == doctest::Approx(1).epsilon(1e-6));
  CHECK(Line(0.314).held(0.005, 0.05) > 1);
  CHECK(Line(0.316).held(0.005, 0.05) == doctest::Approx(1).epsilon(1e-6));
}

}  // namespace
}  // namespace weft::test
