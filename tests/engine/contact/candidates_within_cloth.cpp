/// Pairs of features within a cloth, against all pairs: which are candidates, and which are
/// contacts.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

#include "engine/contact/near.h"
#include "engine/contact/rest_distances.h"
#include "engine/contact/tangles.h"
#include "engine/model/model.h"
#include "kernels/reference/distances.h"
#include "tests/support/clothes.h"
#include "tests/support/contact_particles.h"
#include "tests/support/moving_sheet.h"
#include "tests/support/random.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_contact_candidates_within_cloth {
namespace {

using namespace moving_sheet;

/// A flat sheet of cells of 20 mm that flies on at 20 m/s and flutters.
struct Fluttering : Moving {
  explicit Fluttering(double speed) : Moving(5) {
    MeshDescription mesh = irregular_triangles(20, 0.2, random);
    for (Vec3& x : mesh.positions) x = {0.02 * x.x, 0, 0.02 * x.y};
    mesh.material = find_material("cotton").value();
    SceneDescription scene = made(mesh).scene;
    scene.self_contact = {.on = true, .thickness = kThickness};
    model = model_of(scene);
    clock.begin({}, kH, kSubsteps, false);
    start(speed);
    for (Vector& its : v) its = its + Vector{0, 0, 20};
  }
};

TEST_CASE("cloth that flutters has few candidates") {
  const auto candidates_at = [](double speed) {
    Fluttering now(speed);
    now.clock.begin_interval(kH);
    for (std::size_t i = 0; i < now.v.size(); ++i)
      now.particles.to[i] = now.particles.from[i] + kH * now.v[i];
    return candidates_of(now, 1) / now.model->particles;
  };
  CHECK(candidates_at(1) < 40);
  CHECK(candidates_at(10) < 80);
}

/// A sheet in pleats, whose walls are as far apart as cloth is thick. Some of it speeds up.
struct Pleats : Moving {
  Pleats() : Moving(3) {
    MeshDescription mesh = irregular_triangles(8, 0.2, random);
    for (Vec3& x : mesh.positions)
      x = {0.002 * x.x, 0.05 * std::abs(std::fmod(x.x, 2.) - 1), 0.05 * x.y};
    mesh.material = find_material("cotton").value();
    SceneDescription scene = made(mesh).scene;
    scene.self_contact = {.on = true, .thickness = kThickness};
    model = model_of(scene);
    clock.begin({}, kH, kSubsteps, false);
    start(0.2);
  }
  void finish(int interval) {
    for (int substep = 0; substep < 4; ++substep) {
      clock.advance();
      if (substep == 0) continue;
      for (std::size_t i = 0; i < v.size(); ++i) particles.to[i] = particles.to[i] + kH * v[i];
    }
    for (Vector& its : v)
      if (random.below(10) == 0) its = draw(interval == 1 ? 3 : 0.2);
  }
};

/// visit(name, distance, whether triangles of both share a point), of all that share none.
template <class Visit>
void for_all_within(const TriangleSurface& s, const std::vector<Vector>& x, Visit&& visit) {
  const auto are_joined = [&](std::uint32_t p, std::uint32_t q) {
    return std::ranges::find(s.neighbours[p], q) != s.neighbours[p].end();
  };
  for (std::uint32_t t = 0; t < s.triangles.size(); ++t) {
    const auto [p, q, r] = s.triangles[t];
    for (std::uint32_t i = 0; i < x.size(); ++i) {
      if (s.triangles_at[i].empty() || i == p || i == q || i == r) continue;
      visit(Name{PairKind::point_triangle, false, i, t},
            length(reference::nearest_in_triangle(x[i], x[p], x[q], x[r]).r),
            are_joined(i, p) || are_joined(i, q) || are_joined(i, r));
    }
  }
  for (std::uint32_t i = 0; i < s.edges.size(); ++i) {
    for (std::uint32_t j = i + 1; j < s.edges.size(); ++j) {
      const auto [a, b] = s.edges[i];
      const auto [c, d] = s.edges[j];
      if (a == c || a == d || b == c || b == d) continue;
      visit(Name{PairKind::edges, false, i, j},
            length(reference::nearest_of_edges(x[a], x[b], x[c], x[d]).r),
            are_joined(a, c) || are_joined(a, d) || are_joined(b, c) || are_joined(b, d));
    }
  }
}

std::set<Name> names_within(const Candidates& candidates) {
  std::set<Name> names;
  for (const auto& [kind, turned, first, second] : names_of(candidates)) {
    const bool swap = kind == PairKind::edges && second < first;
    CHECK(names.insert(Name{kind, turned, swap ? second : first, swap ? first : second}).second);
  }
  return names;
}

TEST_CASE("pairs within a cloth that may come near in an interval are among the candidates") {
  Pleats now;
  const simd::Table& table =
      simd::table(simd::supported(simd::Isa::avx2) ? simd::Isa::avx2 : simd::Isa::sse2);
  ContactPoints points(*now.model);
  points.begin(now.clock);
  CandidateSearch search(table);
  Candidates candidates;
  Team team;
  int far = 0, adjacent = 0, left_out = 0;
  for (int interval = 0; interval < 4; ++interval) {
    CAPTURE(interval);
    now.predict();
    if (interval == 0) points.look_ahead(now.particles, now.clock);
    points.begin_interval(now.particles, now.clock, 4);
    search.find(points, candidates, team);
    const std::set<Name> names = names_within(candidates);
    // Boxes hold half of the thickness beyond all places.
    std::vector<Vector> place(now.model->slots());
    for (int draw = 0; draw < 3; ++draw) {
      for (std::uint32_t slot = 0; slot < place.size(); ++slot) {
        const Box& box = points.box(slot);
        const auto in = [&](std::size_t k) {
          return now.random.between(static_cast<double>(box.low[k]) + 0.5 * kThickness,
                                    static_cast<double>(box.high[k]) - 0.5 * kThickness);
        };
        place[slot] = points.origin() + Vector{in(0), in(1), in(2)};
      }
      for_all_within(points.cloth(), place, [&](const Name& name, double distance, bool joined) {
        if (distance < 0.99 * kThickness) {
          ++(joined ? adjacent : far);
          CHECK(names.contains(name));
        } else if (joined) {
          left_out += !names.contains(name);
        }
      });
    }
    now.finish(interval);
  }
  CHECK(far > 300);
  CHECK(adjacent > 100);
  CHECK(left_out > 1000);
}

/// Contacts as they are after some intervals, by their names.
struct LiveContacts {
  std::vector<std::uint64_t> keys;  // 0: gone

  void take(const NearContacts& layers) {
    if (layers.anew) keys.clear();
    for (const std::uint32_t name : layers.gone) {
      CHECK(keys[name] != 0);
      keys[name] = 0;
    }
    for (const auto& touching : layers.touching) CHECK(keys[touching.name] != 0);
    for (const NearContact& found : layers.found) keys.push_back(found.pair.key());
  }
  std::ptrdiff_t count(std::uint64_t key) const { return std::ranges::count(keys, key); }
};

TEST_CASE("near pairs are contacts, each once, and go when they are no candidates any more") {
  Pleats now;
  const simd::Table& table = simd::table(simd::best_isa());
  ContactPoints points(*now.model);
  points.begin(now.clock);
  CandidateSearch search(table);
  NearSearch near(table);
  Tangles tangles(table);
  tangles.begin(points.cloth(), {});
  Candidates candidates;
  Team team;
  NearContacts layers;
  LiveContacts live;
  std::size_t stay = 0, come = 0, gone = 0;
  for (int interval = 0; interval < 4; ++interval) {
    CAPTURE(interval);
    now.predict();
    if (interval == 0) points.look_ahead(now.particles, now.clock);
    points.begin_interval(now.particles, now.clock, 4);
    const bool have_moved = search.find(points, candidates, team);
    near.measure(points, candidates, have_moved, team);
    layers.anew = interval == 0 || have_moved;
    near.find_layers(points, candidates, tangles, layers);
    live.take(layers);
    if (!layers.anew) {
      come += layers.found.size();
      gone += layers.gone.size();
    }
    for (std::size_t list = kBodyLists; list < kPairLists; ++list) {
      for (std::size_t i = 0; i < candidates[list].size(); ++i) {
        if (!candidates[list].is_used(i)) continue;
        const std::size_t block = i / kernels::kLanes, lane = i % kernels::kLanes;
        const bool is_near = near.distances()[list].near[block] >> lane & 1;
        const std::ptrdiff_t contacts = live.count(candidates[list].pairs[i].key());
        CHECK((is_near ? contacts == 1 : contacts <= 1));
        stay += !layers.anew && contacts == 1;
      }
    }
    now.finish(interval);
  }
  CHECK(stay > 100);
  CHECK(come > 10);
  CHECK(gone > 10);
}

/// A flat sheet of triangles of 0.5 to 6 mm: heights of some are above the thickness, of others
/// below it.
TEST_CASE("features of a sheet that are nearer at rest than the thickness are all known") {
  for (std::uint32_t seed = 1; seed <= 4; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    MeshDescription mesh = irregular_triangles(10, 0.2, random);
    for (Vec3& x : mesh.positions) x = {5e-4 * std::pow(1.6, x.x), 3e-3 * x.y, 0};
    SceneDescription scene = made(mesh).scene;
    scene.self_contact = {.on = true, .thickness = kThickness};
    const auto model = model_of(scene);
    const TriangleSurface& s = model->touched_surface();
    const RestDistances rest(*model, kThickness, SewnPoints(*model));
    const auto at = [&](std::uint32_t point) -> Vector { return model->initial_position[point]; };
    std::size_t nearer = 0;
    const auto hold = [&](PairKind kind, std::uint32_t first, std::uint32_t second, Vector r) {
      Pair pair;
      pair.kind = kind;
      pair.first = first;
      pair.second = second;
      const double distance = length(r);
      nearer += distance < kThickness;
      const double kept = distance < kThickness ? tuning::kRestDistance * distance : kThickness;
      CHECK(rest.of(pair) == doctest::Approx(kept).epsilon(1e-9));
    };
    for (std::uint32_t t = 0; t < s.triangles.size(); ++t) {
      const auto [a, b, c] = s.triangles[t];
      for (std::uint32_t p = 0; p < s.triangles_at.size(); ++p) {
        if (s.triangles_at[p].empty() || p == a || p == b || p == c) continue;
        hold(PairKind::point_triangle, p, t,
             reference::nearest_in_triangle(at(p), at(a), at(b), at(c)).r);
      }
    }
    for (std::uint32_t i = 0; i < s.edges.size(); ++i) {
      for (std::uint32_t j = 0; j < i; ++j) {
        const auto [a, b] = s.edges[i];
        const auto [c, d] = s.edges[j];
        if (a == c || a == d || b == c || b == d) continue;
        hold(PairKind::edges, i, j, reference::nearest_of_edges(at(a), at(b), at(c), at(d)).r);
      }
    }
    CHECK(rest.count() == nearer);
    CHECK(nearer > 100);
  }
}

}  // namespace
}  // namespace weft::test::engine_contact_candidates_within_cloth
