/// Pairs of features in lanes against the same in double and against all that is near by, on every
/// instruction set: usual pairs, all that are degenerate, small ones, and far from the origin.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "kernels/reference/distances.h"
#include "kernels/simd/table.h"
#include "tests/support/feature_pairs.h"
#include "tests/support/isas.h"
#include "tests/support/random.h"

namespace weft::test::kernels_simd_distances {
namespace {

using kernels::kLanes;
using kernels::Vector;

/// How large features are, and how far away.
struct Place {
  double size, offset;
};
constexpr std::array kPlaces{Place{1, 0}, Place{0.01, 0}, Place{1e-5, 0}, Place{0.01, 3}};

Vector draw(Random& random, double size) {
  return {random.between(-size, size), random.between(-size, size), random.between(-size, size)};
}

struct Quads {
  kernels::AlignedVector<float> of;
  explicit Quads(std::size_t count) : of(4 * count, 7.f) {}
  void set(std::size_t i, Vector v) {
    of[4 * i] = static_cast<float>(v.x);
    of[4 * i + 1] = static_cast<float>(v.y);
    of[4 * i + 2] = static_cast<float>(v.z);
  }
};

/// Blocks of pairs with points of their own, and ways.
struct Pairs {
  static constexpr std::size_t kBlocks = 12, kCount = kBlocks * kLanes;
  bool edges;
  Place place;
  std::vector<FeaturePair> pairs;
  std::vector<std::array<Vector, 4>> ways;
  std::vector<double> reaches;  // m, that points of the pair may come off their ways, together
  kernels::AlignedVector<simd::PairBlock> blocks{kBlocks};
  Quads points{4 * kCount}, moves{4 * kCount};

  Pairs(bool of_edges, Form form, Place at, std::uint32_t seed) : edges(of_edges), place(at) {
    Random random(seed);
    const Vector by = draw(random, place.offset);
    const std::vector<std::uint32_t> order = random.permutation(4 * kCount);
    for (std::uint32_t i = 0; i < kCount; ++i) {
      FeaturePair pair = feature_pair(edges, form, static_cast<std::uint32_t>(seed * kCount + i));
      std::array<Vector, 4> way;
      for (std::size_t k = 0; k < 4; ++k) {
        pair.point[k] = place.size * pair.point[k] + by;
        way[k] = draw(random, place.size * std::pow(10, random.between(-4, 0)));
        const std::uint32_t slot = order[4 * i + k];
        blocks[i / kLanes].point[k][i % kLanes] = slot;
        points.set(slot, pair.point[k]);
        moves.set(slot, way[k]);
      }
      pairs.push_back(pair);
      ways.push_back(way);
      std::array<double, 2> reach_of{};
      for (std::size_t k = 0; k < 4; ++k) {
        const double reach = place.size * random.between(0, 0.2);
        moves.of[4 * std::size_t{blocks[i / kLanes].point[k][i % kLanes]} + 3] =
            static_cast<float>(reach);
        double& most = reach_of[k < (edges ? 2 : 1) ? 0 : 1];
        most = std::max(most, reach);
      }
      reaches.push_back(reach_of[0] + reach_of[1]);
    }
  }
  reference::Nearest nearest(std::size_t i) const {
    const auto& [a, b, c, d] = pairs[i].point;
    return edges ? reference::nearest_of_edges(a, b, c, d)
                 : reference::nearest_in_triangle(a, b, c, d);
  }
  /// m, of points as floats.
  double rounding() const {
    double farthest = 0;
    for (const FeaturePair& pair : pairs) {
      for (const Vector p : pair.point) farthest = std::max(farthest, length(p));
    }
    return 0x1p-21 * farthest;
  }
  /// Of the pair when a share of its way is over.
  double distance_at(std::size_t i, double share) const {
    FeaturePair there = pairs[i];
    for (std::size_t k = 0; k < 4; ++k) there.point[k] = there.point[k] + share * ways[i][k];
    return distance_of(there);
  }
};

struct Measured {
  std::vector<std::array<float, kLanes>> distance;
  std::vector<std::uint16_t> near;
};

Measured measure(const simd::Table& table, const Pairs& p, double reach, double beyond) {
  Measured to{.distance = std::vector<std::array<float, kLanes>>(Pairs::kBlocks),
              .near = std::vector<std::uint16_t>(Pairs::kBlocks)};
  const simd::PairMeasure m{.pairs = p.blocks.data(),
                            .points = p.points.of.data(),
                            .ways = p.moves.of.data(),
                            .reach = static_cast<float>(reach),
                            .beyond = static_cast<float>(beyond),
                            .distance = reinterpret_cast<float(*)[kLanes]>(to.distance.data()),
                            .near = to.near.data()};
  table.measure_pairs(m, p.edges, 0, Pairs::kBlocks);
  return to;
}

template <class Check>
void for_all_pairs(Check&& check) {
  for (const bool edges : {false, true}) {
    for (const Form form : kForms) {
      for (const Place place : kPlaces) {
        CAPTURE(edges);
        CAPTURE(text(form));
        CAPTURE(place.size);
        CAPTURE(place.offset);
        for (std::uint32_t seed = 1; seed <= 2; ++seed) check(Pairs(edges, form, place, seed));
      }
    }
  }
}

TEST_CASE("a distance in lanes is that in double, and never more than what is verified by it") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    for_all_pairs([&](const Pairs& p) {
      const Measured found = measure(simd::table(isa), p, p.place.size, 1e30);
      for (std::size_t i = 0; i < Pairs::kCount; ++i) {
        CAPTURE(i);
        const double known = distance_of(p.pairs[i]);
        const double distance = double{found.distance[i / kLanes][i % kLanes]};
        // find_moved_pairs takes 0.999 of it, less the rounding of points; that of the kernel's own
        // products, where features all but meet, is small beside any thickness.
        CHECK(0.999 * distance - p.rounding() <= known + 2e-4 * p.place.size);
        // Edges that are all but parallel, and thin triangles, come as near as floats can tell.
        CHECK(distance >= known - p.rounding() - 1e-5 * p.place.size);
      }
    });
  }
}

TEST_CASE("whatever comes within reach on its way is near") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    int near = 0, far = 0;
    for_all_pairs([&](const Pairs& p) {
      const double reach = 0.3 * p.place.size, left = 2 * p.rounding() + 2e-3 * p.place.size;
      const Measured found = measure(simd::table(isa), p, reach, 1e30);
      for (std::size_t i = 0; i < Pairs::kCount; ++i) {
        CAPTURE(i);
        const bool is_near = found.near[i / kLanes] >> i % kLanes & 1;
        ++(is_near ? near : far);
        if (is_near) continue;
        for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0})
          CHECK(p.distance_at(i, share) > reach + p.reaches[i] - left);
      }
    });
    CHECK(near > 1000);
    CHECK(far > 1000);
  }
}

TEST_CASE("what stands still is near by its distance alone; edges only beside each other") {
  for (const simd::Isa isa : supported_isas()) {
    for (const bool edges : {false, true}) {
      Pairs p(edges, Form::usual, {1, 0}, 5);
      std::ranges::fill(p.moves.of, 0.f);
      const double reach = 0.5, beyond = 0.1;
      const Measured found = measure(simd::table(isa), p, reach, beyond);
      int kinds[2]{};
      for (std::size_t i = 0; i < Pairs::kCount; ++i) {
        CAPTURE(i);
        const auto& [a, b, c, d] = p.pairs[i].point;
        const double known = distance_of(p.pairs[i]);
        if (std::abs(known - reach) < 1e-4) continue;  // rounding decides
        bool faces = true;
        if (edges) {
          // Where the lines are nearest: s along a b, t along c d.
          const Vector u = b - a, v = d - c, r = c - a, n = cross(u, v);
          const double s = dot(cross(r, v), n) / dot(n, n), t = dot(cross(r, u), n) / dot(n, n);
          const bool is_parallel = dot(n, n) < 0.01 * dot(u, u) * dot(v, v);
          const double past = std::max({-s, s - 1, -t, t - 1});
          if (std::abs(past - beyond) < 1e-3) continue;
          faces = is_parallel || past < beyond;
        }
        const bool is_near = known < reach && faces;
        ++kinds[is_near];
        CHECK(static_cast<bool>(found.near[i / kLanes] >> i % kLanes & 1) == is_near);
      }
      CHECK(kinds[0] > 10);
      CHECK(kinds[1] > 10);
    }
  }
}

struct Touched {
  kernels::AlignedVector<simd::PairSide> sides;
  std::vector<std::uint16_t> touching;
};

/// Half of the pairs were seen on this side. Some are to be looked at in any case.
Touched sides_of(const Pairs& p, double thickness) {
  Random random(77);
  Touched t{.sides = kernels::AlignedVector<simd::PairSide>(Pairs::kBlocks),
            .touching = std::vector<std::uint16_t>(Pairs::kBlocks)};
  for (std::size_t i = 0; i < Pairs::kCount; ++i) {
    simd::PairSide& side = t.sides[i / kLanes];
    const Vector r = p.nearest(i).r, v = draw(random, 1);
    const double sign = dot(v, r) > 0 ? 1 : -1;
    const Vector n = (sign * (random.below(4) == 0 ? -1 : 1) / length(v)) * v;
    side.normal.x[i % kLanes] = static_cast<float>(n.x);
    side.normal.y[i % kLanes] = static_cast<float>(n.y);
    side.normal.z[i % kLanes] = static_cast<float>(n.z);
    side.thickness[i % kLanes] = static_cast<float>(thickness * random.between(0.5, 1.5));
    if (random.below(8) != 0) side.used |= 1u << i % kLanes;
    if (random.below(8) == 0) side.used |= 1u << (kLanes + i % kLanes);
  }
  return t;
}

Touched touch(const simd::Table& table, const Pairs& p, double thickness) {
  Touched t = sides_of(p, thickness);
  const simd::PairTouch call{.pairs = p.blocks.data(),
                             .points = p.points.of.data(),
                             .sides = t.sides.data(),
                             .touching = t.touching.data()};
  table.touch_pairs(call, p.edges, 0, Pairs::kBlocks);
  return t;
}

Vector normal_in(const simd::PairSide& side, std::size_t lane) {
  return {double{side.normal.x[lane]}, double{side.normal.y[lane]}, double{side.normal.z[lane]}};
}

/// In lengths: how far past an end of one the lines of two edges are nearest to each other; less
/// than 0 within both, and of edges that are nearly parallel.
double past_ends(const std::array<Vector, 4>& x) {
  const Vector u = x[1] - x[0], v = x[3] - x[2], w = x[0] - x[2];
  const double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), uw = dot(u, w), vw = dot(v, w);
  const double determinant = uu * vv - uv * uv;
  if (determinant < 0.02 * uu * vv) return -1;
  const double s = (uv * vw - vv * uw) / determinant, t = (uu * vw - uv * uw) / determinant;
  return std::max({-s, s - 1, -t, t - 1});
}

TEST_CASE("what is nearer than its thickness or on the other side touches; others turn") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    int touching = 0, apart = 0, past = 0, in_any_case = 0;
    for_all_pairs([&](const Pairs& p) {
      const double thickness = 0.2 * p.place.size;
      const Touched before = sides_of(p, thickness), after = touch(simd::table(isa), p, thickness);
      for (std::size_t i = 0; i < Pairs::kCount; ++i) {
        CAPTURE(i);
        const std::size_t block = i / kLanes, lane = i % kLanes;
        const simd::PairSide& side = after.sides[block];
        const bool is_used = side.used >> lane & 1, found = after.touching[block] >> lane & 1;
        if (!is_used) CHECK_FALSE(found);
        const Vector r = p.nearest(i).r, n = normal_in(before.sides[block], lane);
        const double known = distance_of(p.pairs[i]), rounding = 8 * p.rounding();
        const double margin = rounding + 1e-5 * p.place.size;
        if (length(r) > known + margin) continue;  // nearest at several places
        if (std::abs(dot(r, n)) < 0.01 * length(r) + margin) continue;
        const bool stays = dot(r, n) > 0, is_deep = known < double{side.thickness[lane]};
        const double beyond = p.edges ? past_ends(p.pairs[i].point) : -1;
        const bool is_sure = !p.edges || p.place.offset == 0;
        const bool is_marked = side.used >> (kLanes + lane) & 1;
        if (is_used && is_marked) {
          CHECK(found);
          ++in_any_case;
        } else if (is_used && is_sure && beyond > 0.01 && stays) {
          CHECK_FALSE(found);
          past += is_deep;
        } else if (std::abs(known - double{side.thickness[lane]}) > margin && is_used &&
                   (beyond < 0 || !stays)) {
          CHECK(found == (!stays || is_deep));
          ++(found ? touching : apart);
        }
        const Vector now = normal_in(side, lane);
        if (!stays) {
          CHECK(length(now - n) == 0);
        } else if (p.pairs[i].form == Form::usual && p.place.offset == 0 &&
                   known > 0.05 * p.place.size) {
          CHECK(length(now - (1 / length(r)) * r) < 1e-3);
        }
      }
    });
    CHECK(touching > 1000);
    CHECK(apart > 1000);
    CHECK(past > 100);
    CHECK(in_any_case > 100);
  }
}

std::vector<std::uint16_t> moved(const simd::Table& table, const Pairs& p,
                                 const std::vector<std::array<float, kLanes>>& distance) {
  std::vector<std::uint16_t> moved(Pairs::kBlocks);
  const simd::PairMoves call{.pairs = p.blocks.data(),
                             .moves = p.moves.of.data(),
                             .distance = reinterpret_cast<const float(*)[kLanes]>(distance.data()),
                             .rounding = static_cast<float>(p.rounding()),
                             .most = static_cast<float>(2 * 4 * p.place.size),
                             .moved = moved.data()};
  table.find_moved_pairs(call, p.edges, 0, Pairs::kBlocks);
  return moved;
}

TEST_CASE("pairs that are said not to have moved did not meet; those that move far are found") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    int stayed = 0;
    for_all_pairs([&](const Pairs& p) {
      const Measured measured = measure(simd::table(isa), p, p.place.size, 1e30);
      const std::vector<std::uint16_t> found = moved(simd::table(isa), p, measured.distance);
      for (std::size_t i = 0; i < Pairs::kCount; ++i) {
        CAPTURE(i);
        const std::size_t firsts = p.edges ? 2 : 1;
        double most = 0;
        for (std::size_t k = 0; k < firsts; ++k) {
          for (std::size_t l = firsts; l < 4; ++l)
            most = std::max(most, length(p.ways[i][k] - p.ways[i][l]));
        }
        const double distance = double{measured.distance[i / kLanes][i % kLanes]};
        const bool has_moved = found[i / kLanes] >> i % kLanes & 1;
        const double rounding = 10 * p.rounding() + 1e-3 * p.place.size;
        if (most > 1.1 * distance + rounding) CHECK(has_moved);
        if (most < 0.5 * distance - rounding) CHECK_FALSE(has_moved);
        if (has_moved) continue;
        ++stayed;
        for (const double share : {0.2, 0.5, 0.8, 1.0}) CHECK(p.distance_at(i, share) > 0);
      }
    });
    CHECK(stayed > 1000);
  }
}

TEST_CASE("values are small up to the limit, in the blocks that were asked for") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    Random random(5);
    std::vector<std::array<float, kLanes>> of(Pairs::kBlocks);
    for (auto& lanes : of) {
      for (float& x : lanes) x = static_cast<float>(random.below(5));
    }
    std::vector<std::uint16_t> small(Pairs::kBlocks, 0xabcd);
    simd::table(isa).find_small(reinterpret_cast<const float(*)[kLanes]>(of.data()), 2,
                                small.data(), 1, 5);
    for (std::size_t i = 0; i < Pairs::kBlocks; ++i) {
      std::uint32_t expected = 0;
      for (std::size_t lane = 0; lane < kLanes; ++lane) expected |= (of[i][lane] <= 2) << lane;
      CHECK(small[i] == (i >= 1 && i < 5 ? expected : 0xabcd));
    }
  }
}

/// Boxes that meet others at their faces too; `used` of them.
simd::BoxCluster random_cluster(Random& random, std::size_t used) {
  simd::BoxCluster cluster;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto low = static_cast<float>(random.below(5));
      cluster.low[k][lane] = lane < used ? low : 1e38f;
      cluster.high[k][lane] = lane < used ? low + static_cast<float>(random.below(3)) : -1e38f;
    }
  }
  return cluster;
}

TEST_CASE("a box finds the boxes that it meets, and no others") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    Random random(3);
    int count = 0;
    for (int i = 0; i < 2000; ++i) {
      const simd::BoxCluster boxes = random_cluster(random, random.below(kLanes + 1));
      float low[3], high[3];
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = static_cast<float>(random.below(5));
        high[k] = low[k] + static_cast<float>(random.below(3));
      }
      std::uint32_t expected = 0;
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        bool meets = true;
        for (std::size_t k = 0; k < 3; ++k) {
          meets = meets && !(boxes.low[k][lane] > high[k]) && !(boxes.high[k][lane] < low[k]);
        }
        expected |= (meets ? 1u : 0u) << lane;
        count += meets;
      }
      CHECK(simd::table(isa).find_met(boxes, low, high) == expected);
    }
    CHECK(count > 100);
  }
}

TEST_CASE("ranges of blocks are kept to") {
  for (const simd::Isa isa : supported_isas()) {
    const Pairs p(true, Form::usual, {1, 0}, 9);
    std::vector<std::array<float, kLanes>> distance(Pairs::kBlocks);
    std::vector<std::uint16_t> near(Pairs::kBlocks, 0xabcd);
    const simd::PairMeasure m{.pairs = p.blocks.data(),
                              .points = p.points.of.data(),
                              .ways = p.moves.of.data(),
                              .reach = 1,
                              .beyond = 1e30f,
                              .distance = reinterpret_cast<float(*)[kLanes]>(distance.data()),
                              .near = near.data()};
    simd::table(isa).measure_pairs(m, true, 3, 5);
    const Measured all = measure(simd::table(isa), p, 1, 1e30);
    for (std::size_t i = 0; i < Pairs::kBlocks; ++i) {
      const bool is_done = i == 3 || i == 4;
      CHECK(near[i] == (is_done ? all.near[i] : 0xabcd));
      CHECK(distance[i][2] == (is_done ? all.distance[i][2] : 0));
    }
  }
}

template <class T>
bool same_bits(const T& a, const T& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
}

TEST_CASE("AVX2 and AVX-512 give the same bits") {
  if (!simd::supported(simd::Isa::avx512)) {
    MESSAGE("this machine lacks avx512: not tested");
    return;
  }
  const simd::Table &a = simd::table(simd::Isa::avx2), &b = simd::table(simd::Isa::avx512);
  for_all_pairs([&](const Pairs& p) {
    const double size = p.place.size;
    const Measured of_a = measure(a, p, 0.3 * size, 0.1), of_b = measure(b, p, 0.3 * size, 0.1);
    CHECK(same_bits(of_a.distance, of_b.distance));
    CHECK(same_bits(of_a.near, of_b.near));
    const Touched by_a = touch(a, p, 0.2 * size), by_b = touch(b, p, 0.2 * size);
    CHECK(same_bits(by_a.touching, by_b.touching));
    for (std::size_t i = 0; i < Pairs::kBlocks; ++i) {
      CHECK(std::memcmp(&by_a.sides[i].normal, &by_b.sides[i].normal, sizeof(simd::LaneVectors)) ==
            0);
    }
    CHECK(same_bits(moved(a, p, of_a.distance), moved(b, p, of_a.distance)));
  });
}

}  // namespace
}  // namespace weft::test::kernels_simd_distances
