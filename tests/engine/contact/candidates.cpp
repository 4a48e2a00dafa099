/// Which pairs of features are looked at, against all pairs: those that come nearer than the
/// thickness in an interval are candidates, and near if points go on as expected; pairs that sleep
/// are not.
#include <doctest/doctest.h>

#include <cstdint>
#include <set>
#include <vector>

#include "engine/contact/near.h"
#include "engine/contact/tangles.h"
#include "engine/model/model.h"
#include "kernels/reference/distances.h"
#include "tests/support/body_meshes.h"
#include "tests/support/clothes.h"
#include "tests/support/contact_particles.h"
#include "tests/support/moving_sheet.h"
#include "tests/support/random.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_contact_candidates {
namespace {

using namespace moving_sheet;

/// A sheet beside a body that turns, goes on and, if `deforms`, breathes.
struct Beside : Moving {
  Bodies bodies;

  /// origin: of both.
  Beside(std::uint32_t seed, bool moves, bool deforms, Vec3 origin = {}) : Moving(seed) {
    MeshDescription mesh = irregular_triangles(8, 0.2, random);
    for (Vec3& x : mesh.positions)
      x = origin + Vec3{0.05 * x.x - 0.17, 0.003 * x.x, 0.05 * x.y - 0.18};
    mesh.material = find_material("cotton").value();
    model = model_of(made(mesh).scene);
    const TriangleMesh ball = icosphere(0.15, 3);
    const Vec3 place = origin + Vec3{0.01, -0.137, 0.02};
    const auto id =
        bodies.add({.shape = shape_of(ball), .pose = {.position = place}, .thickness = kThickness});
    if (moves)
      bodies.move(
          id, {.position = place + Vec3{0.004, 0.001, 0}, .rotation = turn({0.6, 0, 0.8}, 0.15)});
    if (deforms) {
      std::vector<Vec3> to = ball.vertices;
      for (Vec3& x : to) x.y *= 1.01;
      bodies.move_vertices(id, to);
    }
    clock.begin(bodies.travelling(0.3, {}), kH, kSubsteps, false);
    start(0.4);
  }
};

/// visit(name, distance), of all pairs of features at a place of all points.
template <class At, class Visit>
void for_all_pairs(const ContactSurface& cloth, const ContactSurface& body, At&& at,
                   Visit&& visit) {
  const TriangleSurface &a = *cloth.triangles, &b = *body.triangles;
  const auto in = [&](std::uint32_t i) { return at(body.first_point + i); };
  for (std::uint32_t t = 0; t < b.triangles.size(); ++t) {
    const auto [p, q, r] = b.triangles[t];
    for (std::uint32_t i = 0; i < a.triangles_at.size(); ++i) {
      if (a.triangles_at[i].empty()) continue;
      visit(Name{PairKind::point_triangle, false, i, t},
            length(reference::nearest_in_triangle(at(i), in(p), in(q), in(r)).r));
    }
  }
  for (std::uint32_t t = 0; t < a.triangles.size(); ++t) {
    const auto [p, q, r] = a.triangles[t];
    for (std::uint32_t i = 0; i < b.triangles_at.size(); ++i)
      visit(Name{PairKind::point_triangle, true, i, t},
            length(reference::nearest_in_triangle(in(i), at(p), at(q), at(r)).r));
  }
  for (std::uint32_t i = 0; i < a.edges.size(); ++i) {
    for (std::uint32_t j = 0; j < b.edges.size(); ++j) {
      const reference::Nearest found = reference::nearest_of_edges(
          at(a.edges[i][0]), at(a.edges[i][1]), in(b.edges[j][0]), in(b.edges[j][1]));
      visit(Name{PairKind::edges, false, i, j}, length(found.r));
    }
  }
}

/// Where a vertex is when a share of an interval of so many substeps is over.
Vector vertex_at(const Beside& now, const ContactSurface& body, std::uint32_t vertex,
                 double substeps) {
  const double before = now.clock.share_after(0), after = now.clock.share_after(1);
  const double share = before + substeps * (after - before);
  return now.clock.vertex(body.body, vertex, now.clock.bodies()[body.body].travel.at(share), share);
}

void check(std::uint32_t seed, bool moves, bool deforms) {
  Beside now(seed, moves, deforms);
  const simd::Table& table = simd::table(simd::best_isa());
  ContactPoints points(*now.model);
  points.begin(now.clock);
  CandidateSearch search(table);
  NearSearch near(table);
  Candidates candidates;
  Team team;
  int known = 0, asleep = 0, renewed = 0;
  for (int interval = 0; interval < 4; ++interval) {
    CAPTURE(interval);
    now.predict();
    if (interval == 0) points.look_ahead(now.particles, now.clock);
    points.begin_interval(now.particles, now.clock, 4);
    const std::size_t before = candidates[0].size() + candidates[1].size();
    const bool have_moved = search.find(points, candidates, team);
    renewed +=
        interval > 0 && (have_moved || candidates[0].size() + candidates[1].size() != before);
    near.measure(points, candidates, have_moved, team);
    const std::set<Name> names = names_of(candidates);
    const ContactSurface &cloth = points.surfaces()[0], &body = points.surfaces()[1];

    // Anywhere in the boxes of cloth, and on the way of the body.
    std::vector<Vector> place(now.model->slots());
    for (int draw = 0; draw < 3; ++draw) {
      for (std::uint32_t slot = 0; slot < place.size(); ++slot) {
        const Box& box = points.box(slot);
        const auto in = [&](std::size_t k) {
          return now.random.between(static_cast<double>(box.low[k]),
                                    static_cast<double>(box.high[k]));
        };
        place[slot] = points.origin() + Vector{in(0), in(1), in(2)};
      }
      const auto at = [&](std::uint32_t point) {
        return points.is_of_cloth(point)
                   ? place[point]
                   : vertex_at(now, body, point - body.first_point, 2. * draw);
      };
      for_all_pairs(cloth, body, at, [&](const Name& name, double distance) {
        if (!(distance < kThickness)) return;
        ++known;
        CHECK(names.contains(name));
      });
    }
    // What sleeps is as far apart as is said, and not near by a look that knows of no sleep.
    NearSearch awake(table);
    awake.measure(points, candidates, true, team);
    for (std::size_t list = 0; list < kPairLists; ++list) {
      for (std::size_t i = 0; i < candidates[list].size(); ++i) {
        const std::size_t block = i / kernels::kLanes, lane = i % kernels::kLanes;
        if (!candidates[list].is_used(i)) continue;
        const auto four = candidates[list].points(i);
        const double distance =
            length(nearest(candidates[list].pairs[i].kind, points.starts_of(four)).r);
        CHECK(static_cast<double>(near.least(list, i)) < distance + 1e-6);
        const bool expected = awake.distances()[list].near[block] >> lane & 1;
        const bool found = near.distances()[list].near[block] >> lane & 1;
        CHECK(found == expected);
        asleep += (near.distances()[list].awake[block] >> lane & 1) == 0;
      }
    }
    // Some do what was not expected.
    for (int substep = 0; substep < 4; ++substep) {
      now.clock.advance();
      if (substep == 0) continue;
      for (std::size_t i = 0; i < now.v.size(); ++i)
        now.particles.to[i] = now.particles.to[i] + kH * now.v[i];
    }
    // Soon they are slow, and what is far sleeps; in the end some are fast, and leave their boxes.
    for (Vector& v : now.v) v = now.draw(interval == 2 && now.random.below(10) == 0 ? 3 : 0.02);
  }
  CHECK(known > 300);
  if (moves || deforms) return;  // boxes and ways are wide then
  CHECK(renewed > 0);
  CHECK(asleep > 100);
}

TEST_CASE("pairs that may come near in an interval are among the candidates; others may sleep" *
          doctest::test_suite("long")) {
  SUBCASE("of a body that is still") { check(1, false, false); }
  SUBCASE("of one that moves") { check(1, true, false); }
  SUBCASE("of one that moves and deforms") { check(1, true, true); }
}

TEST_CASE("130 km from the origin as many pairs are candidates as beside it") {
  Beside here(1, false, false), there(1, false, false, {131072, 0, -131072});
  for (Beside* now : {&here, &there}) now->predict();
  const std::size_t expected = candidates_of(here, 4);
  CHECK(expected > 300);
  CHECK(candidates_of(there, 4) == doctest::Approx(static_cast<double>(expected)).epsilon(0.01));
}

/// Tangles ask for places that nobody asked for before.
TEST_CASE(
    "of a mesh those vertices alone are placed that are looked at, and what is inside is known") {
  Beside now(1, false, false);
  now.predict();
  const simd::Table& table = simd::table(simd::best_isa());
  ContactPoints points(*now.model);
  points.begin(now.clock);
  points.look_ahead(now.particles, now.clock);
  points.begin_interval(now.particles, now.clock, 4);
  CandidateSearch search(table);
  Candidates candidates;
  Team team;
  search.find(points, candidates, team);
  Tangles tangles(table);
  tangles.begin(points.cloth(), {});
  tangles.find(points);
  const Vector centre{0.01, -0.137, 0.02};
  int inside = 0, placed = 0;
  for (std::uint32_t slot = 0; slot < now.model->slots(); ++slot) {
    const double from_centre = length(points.start(slot) - centre);
    if (tangles.is_inside(slot)) {
      ++inside;
      CHECK(from_centre < 0.15);
    } else {
      CHECK((!now.model->is_particle(slot) || from_centre > 0.147));  // its faces are that near
    }
  }
  const ContactSurface& ball = points.surfaces()[1];
  for (std::size_t i = 0; i < ball.from.size(); ++i) {
    const Vector at = points.start(ball.first_point + static_cast<std::uint32_t>(i));
    if (at == Vector{}) continue;
    ++placed;
    CHECK(length(at - (centre + ball.from[i])) < 1e-12);
  }
  CHECK(inside > 0);
  CHECK(placed > 10);
  CHECK(placed < 0.5 * static_cast<double>(ball.from.size()));
}

}  // namespace
}  // namespace weft::test::engine_contact_candidates
