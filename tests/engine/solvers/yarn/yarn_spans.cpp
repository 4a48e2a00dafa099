/// Taut stretches of yarns: which there are, and what they keep.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "engine/model/model.h"
#include "engine/solvers/yarn/held_spans.h"
#include "engine/solvers/yarn/yarn_layout.h"
#include "tests/support/clothes.h"
#include "tests/support/mesh_scenes.h"
#include "tests/support/meshes.h"

namespace weft::test::engine_solvers_yarn_yarn_spans {
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

/// Every second particle joined as well.
SceneDescription stiff_line() {
  SceneDescription scene = line();
  for (std::uint32_t i = 0; i < 4; ++i) scene.constraints.push_back({i, i + 2, 0.2});
  return scene;
}

/// A line's span from its third particle to its last, the ends `apart`; at the start its first link
/// is a third of that and 1 mm more.
struct Line {
  Line(SceneDescription description, double apart) : scene(std::move(description)) {
    scene.positions[3].x = 0.2 + apart / 3 + 0.001;
    scene.positions[4].x = 0.2 + 2 * apart / 3;
    scene.positions[5].x = 0.2 + apart;
    model = model_of(scene);
  }

  /// Its first link, over the rest length, where the middle is predicted to fall by so much.
  double held(double usual, double tolerance, double fall = 0) {
    HeldSpans spans(model->yarns(), usual, tolerance, true);
    hold(spans, fall, 0);
    return spans.holds() ? first_link(spans) : 1;
  }

  /// Where the middle is predicted to fall by so much, and the last particle to come so much
  /// nearer.
  void hold(HeldSpans& spans, double fall, double nearer) {
    Team team;
    kernels::Vectors start = model->initial_position, x = start;
    for (const std::uint32_t i : {3u, 4u}) x.y[model->ordering.slot_of[i]] -= fall;
    x.x[model->ordering.slot_of[5]] -= nearer;
    spans.hold(start.view(), x.view(), team);
  }

  double first_link(const HeldSpans& spans) const {
    const YarnLayout& layout = model->yarns();
    const auto is_it = [](const YarnSpan& span) { return span.last_row - span.row == 3; };
    const auto span = std::ranges::find_if(layout.spans, is_it);
    REQUIRE(span != layout.spans.end());
    const bool backwards = layout.span_slots[span->first_slot] != model->ordering.slot_of[2];
    const std::uint32_t row = backwards ? span->last_row - 1 : span->row;
    return static_cast<double>(spans.kinds()[spans.kind()[row]].rest[span->lane]) / 0.1;
  }

  SceneDescription scene;
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

TEST_CASE("what joins particles of a span besides its links is a chord of it") {
  for (const bool stiff : {false, true}) {
    CAPTURE(stiff);
    const auto model = model_of(stiff ? stiff_line() : line());
    for (const YarnSpan& span : model->yarns().spans) {
      if (span.last_row - span.row == 3) CHECK(span.has_chords == stiff);
    }
  }
}

TEST_CASE("a taut span is as long as it is predicted to be, its links alike") {
  CHECK(Line(line(), 0.3).held(0.02, 0.05) == doctest::Approx(1).epsilon(1e-6));
  CHECK(Line(line(), 0.303).held(0.02, 0.05) == doctest::Approx(1.01).epsilon(1e-6));
  const double longer = (2 * std::hypot(0.1, 0.01) + 0.1) / 0.3;  // but for the millimetre
  CHECK(Line(line(), 0.3).held(0.02, 0.05, 0.01) == doctest::Approx(longer).epsilon(1e-4));
}

TEST_CASE("within most of what may be left: the usual, or what there was, up to the tolerance") {
  CHECK(Line(line(), 0.3).held(0.01, 0.01, 0.05) == doctest::Approx(1.008).epsilon(1e-6));
  CHECK(Line(line(), 0.3).held(0.002, 0.05, 0.05) == doctest::Approx(1.008).epsilon(1e-6));
  CHECK(Line(line(), 0.3).held(0.002, 0.005, 0.05) == doctest::Approx(1.004).epsilon(1e-6));
}

TEST_CASE("where it has chords each link keeps what it has at the start") {
  CHECK(Line(stiff_line(), 0.3).held(0.02, 0.05, 0.01) == doctest::Approx(1.01).epsilon(1e-6));
  CHECK(Line(stiff_line(), 0.3).held(0.005, 0.005, 0.01) == doctest::Approx(1.004).epsilon(1e-6));
}

TEST_CASE("spans that are slack, or longer than the tolerance allows, keep nothing") {
  CHECK(Line(line(), 0.299).held(0.005, 0.05, 0.05) > 1);
  CHECK(Line(line(), 0.298).held(0.005, 0.05, 0.05) == doctest::Approx(1).epsilon(1e-6));
  CHECK(Line(line(), 0.314).held(0.005, 0.05) > 1);
  CHECK(Line(line(), 0.316).held(0.005, 0.05) == doctest::Approx(1).epsilon(1e-6));
}

TEST_CASE("a span that was held and is slack keeps nothing while another is held") {
  Line scene(line(), 0.3);
  HeldSpans spans(scene.model->yarns(), 0.005, 0.05, true);
  scene.hold(spans, 0.05, 0);
  CHECK(scene.first_link(spans) > 1.001);
  scene.hold(spans, 0.05, 0.01);
  CHECK(spans.holds());
  CHECK(scene.first_link(spans) == doctest::Approx(1).epsilon(1e-6));
}

}  // namespace
}  // namespace weft::test::engine_solvers_yarn_yarn_spans
