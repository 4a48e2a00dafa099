/// Features of one star of a cloth: who names their pairs, and that those left out do not meet.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <tuple>
#include <vector>

#include "engine/contact/stars.h"
#include "engine/model/model.h"
#include "tests/support/clothes.h"
#include "tests/support/contact_particles.h"
#include "tests/support/crossing_triangles.h"
#include "tests/support/random.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_contact_stars {
namespace {

using kernels::Vector;

/// A sheet of irregular triangles whose points move by chance in one interval.
struct Sheet {
  std::shared_ptr<const Model> model;
  BodyClock clock;
  StandingParticles particles;

  Sheet(std::uint32_t seed, double rough, double way) {
    Random random(seed);
    MeshDescription mesh = irregular_triangles(6, 0.2, random);
    mesh.material = find_material("cotton").value();
    SceneDescription scene = made(mesh).scene;
    scene.self_contact = {.on = true, .thickness = 0.01};
    model = model_of(scene);
    const auto draw = [&](double size) {
      return Vector{random.between(-size, size), random.between(-size, size),
                    random.between(-size, size)};
    };
    for (std::uint32_t slot = 0; slot < model->slots(); ++slot) {
      particles.from.push_back(model->initial_position[slot] + draw(rough));
      particles.to.push_back(particles.from.back() + draw(way));
    }
    clock.begin({}, 1e-3, 1, false);
    clock.begin_interval(1e-3);
  }
  /// Names of the pairs of features of stars that fold.
  std::set<std::tuple<PairKind, std::uint32_t, std::uint32_t>> folded(Stars::Fold fold) {
    ContactPoints points(*model);
    points.begin(clock);
    points.look_ahead(particles, clock);
    points.begin_interval(particles, clock, 1);
    Stars stars(simd::table(simd::best_isa()));
    stars.make(points);
    stars.begin();
    Candidates candidates;
    Team team;
    stars.add_folded(points, fold, candidates, team);
    CHECK_FALSE(stars.add_folded(points, fold, candidates, team));  // each star once
    std::set<std::tuple<PairKind, std::uint32_t, std::uint32_t>> names;
    for (std::size_t list = 0; list < kPairLists; ++list) {
      for (const Pair& pair : candidates[list].pairs) {
        CHECK(is_of_stars(list));
        CHECK(are_in_one_star(points.cloth(), pair));
        const bool swap = pair.kind == PairKind::edges && pair.second < pair.first;
        CHECK(names
                  .insert(
                      {pair.kind, swap ? pair.second : pair.first, swap ? pair.first : pair.second})
                  .second);
      }
    }
    return names;
  }
};

TEST_CASE("where all stars fold they name each pair of their features once") {
  Sheet sheet(1, 3, 3);  // cells are 1 m
  const auto names = sheet.folded(Stars::Fold::comes_near);
  const TriangleSurface& s = sheet.model->touched_surface();
  const auto stars_of_edge = [&](std::uint32_t e) {
    std::set<std::uint32_t> stars;
    for (std::uint32_t t = 0; t < s.triangles.size(); ++t) {
      if (std::ranges::find(s.edges_of[t], e) == s.edges_of[t].end()) continue;
      stars.insert(s.triangles[t].begin(), s.triangles[t].end());
    }
    return stars;
  };
  const auto have_one = [](const std::set<std::uint32_t>& a, const std::set<std::uint32_t>& b) {
    return std::ranges::any_of(a, [&](std::uint32_t star) { return b.contains(star); });
  };
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < s.edges.size(); ++i) {
    for (std::uint32_t j = i + 1; j < s.edges.size(); ++j) {
      const auto [a, b] = s.edges[i];
      const auto [c, d] = s.edges[j];
      if (a == c || a == d || b == c || b == d || !have_one(stars_of_edge(i), stars_of_edge(j)))
        continue;
      ++count;
      CHECK(names.contains({PairKind::edges, i, j}));
    }
  }
  for (std::uint32_t t = 0; t < s.triangles.size(); ++t) {
    const auto& corners = s.triangles[t];
    for (std::uint32_t p = 0; p < s.triangles_at.size(); ++p) {
      if (s.triangles_at[p].empty() || std::ranges::find(corners, p) != corners.end()) continue;
      std::set<std::uint32_t> stars{p};
      stars.insert(s.neighbours[p].begin(), s.neighbours[p].end());
      if (!have_one(stars, {corners.begin(), corners.end()})) continue;
      ++count;
      CHECK(names.contains({PairKind::point_triangle, p, t}));
    }
  }
  CHECK(count == names.size());
  CHECK(count > 800);
}

TEST_CASE("a sheet whose inner stars do not fold on its way crosses itself in none of them") {
  int left_out = 0, crossings = 0;
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    Sheet sheet(seed, 0.25, 0.02 * seed);
    const auto names = sheet.folded(Stars::Fold::crosses);
    const TriangleSurface& s = sheet.model->touched_surface();
    for (std::uint32_t star = 0; star < s.triangles_at.size(); ++star) {
      if (s.triangles_at[star].empty()) continue;
      // Of a star none of whose pairs is named.
      bool is_named = false;
      std::vector<TriangleSurface::Triangle> triangles;
      for (const std::uint32_t t : s.triangles_at[star]) {
        triangles.push_back(s.triangles[t]);
        for (const std::uint32_t p : s.neighbours[star])
          is_named = is_named || names.contains({PairKind::point_triangle, p, t});
      }
      if (is_named) continue;
      ++left_out;
      for (int k = 0; k <= 4; ++k) {
        std::vector<Vec3> x;
        for (std::uint32_t p = 0; p < s.triangles_at.size(); ++p) {
          const Vector at = sheet.particles.from[p] +
                            (0.25 * k) * (sheet.particles.to[p] - sheet.particles.from[p]);
          x.push_back({at.x, at.y, at.z});
        }
        CHECK(count_self_crossings({x, triangles}) == 0);
      }
    }
    std::vector<Vec3> end;
    for (const Vector& at : sheet.particles.to) end.push_back({at.x, at.y, at.z});
    crossings += count_self_crossings({end, s.triangles});
  }
  CHECK(left_out > 300);
  CHECK(crossings > 100);
}

}  // namespace
}  // namespace weft::test::engine_contact_stars
