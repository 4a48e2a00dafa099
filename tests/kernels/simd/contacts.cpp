/// Contacts in lanes against the law in double, on every instruction set.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/reference/contacts.h"
#include "kernels/simd/contact_data.h"
#include "kernels/simd/table.h"
#include "tests/support/isas.h"
#include "tests/support/random.h"

namespace weft::test::kernels_simd_contacts {
namespace {

using kernels::kLanes;
using kernels::Vector;
using reference::Contact;

constexpr double kThickness = 1e-3, kRecovery = 0.02;

Vector draw(Random& random, double size) {
  return {random.between(-size, size), random.between(-size, size), random.between(-size, size)};
}

Vector hold_of(const simd::ContactBlock& block, std::size_t lane) {
  return {double{block.hold.x[lane]}, double{block.hold.y[lane]}, double{block.hold.z[lane]}};
}

/// A block whose features lie on each other, without faces beside them, and ways of their points.
struct Layers {
  bool edges;
  simd::ContactBlock block{};
  std::vector<Vector> x, ways;
  std::vector<double> inverse_mass;
  kernels::AlignedVector<float> places, moves;

  Layers(std::uint32_t seed, bool has_edges) : edges(has_edges) {
    Random random(seed);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const double apart = kThickness * random.between(0.3, 1.5);
      const std::array<Vector, 4> at =
          edges ? std::array<Vector, 4>{{{-0.01, apart, 0.001},
                                         {0.01, apart, -0.002},
                                         {0.002, 0, -0.01},
                                         {-0.003, 0, 0.01}}}
                : std::array<Vector, 4>{
                      {{0.001, apart, 0.002}, {-0.01, 0, -0.01}, {0.01, 0, -0.01}, {0, 0, 0.012}}};
      for (std::size_t k = 0; k < 4; ++k) {
        block.point[k][lane] = static_cast<std::uint32_t>(x.size());
        x.push_back(at[k] + draw(random, 1e-4));
        ways.push_back(draw(random, 3e-4));
        inverse_mass.push_back(random.between(0, 1) < 0.2 ? 0 : random.between(100, 1000));
      }
      // A border is a side of its own triangle.
      const std::array<std::size_t, 4> thirds =
          edges ? std::array<std::size_t, 4>{0, 0, 2, 2} : std::array<std::size_t, 4>{3, 1, 2, 1};
      for (std::size_t k = 0; k < 4; ++k) block.beside[k][lane] = block.point[thirds[k]][lane];
      for (auto& towards : block.towards) towards[lane] = -1;
      if (edges) block.towards[0][lane] = static_cast<float>(reference::kLeastWithin);
      block.thickness[lane] = static_cast<float>(kThickness);
      block.friction[lane] = static_cast<float>(random.between(0, 0.6));
      // In the last two substeps: nothing, a touch that began or ended, and one that went on.
      const auto some = [&] { return random.between(0, 1) < 0.3 ? 0 : random.between(2e-7, 2e-6); };
      block.push[lane] = static_cast<float>(some());
      block.before[lane] = static_cast<float>(some());
      const Vector hold = draw(random, 0.1 * double{block.push[lane]});
      block.hold.x[lane] = static_cast<float>(hold.x);
      block.hold.y[lane] = static_cast<float>(hold.y);
      block.hold.z[lane] = static_cast<float>(hold.z);
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
      const auto w = static_cast<float>(inverse_mass[i]);
      for (const double v : {x[i].x, x[i].y, x[i].z}) places.push_back(static_cast<float>(v));
      places.push_back(w);
      for (const double v : {ways[i].x, ways[i].y, ways[i].z})
        moves.push_back(static_cast<float>(v));
      moves.push_back(w);
    }
  }
  std::array<Vector, 4> of(const std::vector<Vector>& all, std::size_t lane) const {
    return {all[block.point[0][lane]], all[block.point[1][lane]], all[block.point[2][lane]],
            all[block.point[3][lane]]};
  }
  /// As the law has it where a substep begins, before kernels freeze it.
  Contact contact(std::size_t lane, double warm) const {
    const auto at = of(x, lane);
    const reference::Nearest nearest =
        edges ? reference::nearest_of_edges(at[0], at[1], at[2], at[3])
              : reference::nearest_in_triangle(at[0], at[1], at[2], at[3]);
    Contact contact{.weight = nearest.weight,
                    .normal = (1 / length(nearest.r)) * nearest.r,
                    .friction = double{block.friction[lane]},
                    .push = double{block.push[lane]},
                    .hold = hold_of(block, lane),
                    .before = double{block.before[lane]}};
    contact.gap = reference::gap_over_target(length(nearest.r), kThickness, kRecovery);
    double sum = 0, largest = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      contact.inverse_mass[k] = inverse_mass[block.point[k][lane]];
      sum += contact.inverse_mass[k] * nearest.weight[k] * nearest.weight[k];
      largest = std::max(largest, contact.inverse_mass[k]);
    }
    sum = std::max(sum, reference::kLeastGive * largest);
    contact.slack = reference::kSlack * sum;
    contact.give = sum > 0 ? 1 / (sum + contact.slack) : 0;
    contact.act_again(warm);
    return contact;
  }
};

void check_near(Vector is, Vector should, double tolerance) {
  CHECK(length(is - should) <= tolerance);
}

TEST_CASE("contacts in lanes obey the law in double") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    const simd::ContactKernels& kernels = *simd::table(isa).contacts;
    for (std::uint32_t seed = 1; seed <= 40; ++seed) {
      CAPTURE(seed);
      Layers layers(seed, seed % 2 == 0);
      std::array<Contact, kLanes> contacts;
      for (std::size_t lane = 0; lane < kLanes; ++lane) contacts[lane] = layers.contact(lane, 1);
      simd::ContactBlock& block = layers.block;
      kernels.freeze({.blocks = &block,
                      .places = layers.places.data(),
                      .rounding = 1e-8f,
                      .warm = 1,
                      .recovery = static_cast<float>(kRecovery)},
                     layers.edges, 0, 1);
      const simd::ContactSolve solve{&block, layers.moves.data()};
      const std::uint32_t first = 0;
      std::array<std::array<Vector, 4>, kLanes> ways;
      for (std::size_t lane = 0; lane < kLanes; ++lane) ways[lane] = layers.of(layers.ways, lane);
      for (int round = 0; round < 3; ++round) {
        kernels.visit(solve, &first, 1);
        for (std::size_t lane = 0; lane < kLanes; ++lane) contacts[lane].visit(ways[lane]);
      }
      std::uint16_t active = 0;
      kernels.find_active(solve, false, &active, 0, 1);
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        CAPTURE(lane);
        const Contact& contact = contacts[lane];
        const double unit = contact.give > 0 ? contact.give * 1e-8 : 1e-15;
        CHECK(std::abs(double{block.push[lane]} - contact.push) <= unit);
        CHECK(std::abs(double{block.give[lane]} - contact.give) <= 1e-4 * contact.give);
        check_near(hold_of(block, lane), contact.hold, unit);
        if (contact.push > unit) CHECK((active >> lane & 1) == 1);
        for (std::size_t k = 0; k < 4; ++k) {
          const float* move = &layers.moves[4 * block.point[k][lane]];
          check_near({double{move[0]}, double{move[1]}, double{move[2]}}, ways[lane][k], 1e-8);
        }
      }
    }
  }
}

/// Both kinds of features, and substeps that are shorter and longer than the last.
TEST_CASE("multipliers that act again move points by the least of what acted in two substeps") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    const simd::ContactKernels& kernels = *simd::table(isa).contacts;
    for (const bool edges : {false, true}) {
      for (const double warm : {0.0, 0.5, 1.0, 2.0}) {
        CAPTURE(edges);
        CAPTURE(warm);
        Layers layers(3, edges);
        simd::ContactBlock& block = layers.block;
        std::array<Contact, kLanes> contacts;
        for (std::size_t lane = 0; lane < kLanes; ++lane)
          contacts[lane] = layers.contact(lane, warm);
        kernels.freeze({.blocks = &block,
                        .places = layers.places.data(),
                        .rounding = 1e-8f,
                        .warm = static_cast<float>(warm),
                        .recovery = static_cast<float>(kRecovery)},
                       edges, 0, 1);
        const std::uint32_t first = 0;
        kernels.start({&block, layers.moves.data()}, &first, 1);
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
          CAPTURE(lane);
          const Contact& contact = contacts[lane];
          CHECK(double{block.push[lane]} == doctest::Approx(contact.push));
          CHECK(double{block.before[lane]} == doctest::Approx(contact.before));
          check_near(hold_of(block, lane), contact.hold, 1e-12);
          const Vector by =
              contact.push > 0 ? contact.push * contact.normal + contact.hold : Vector{};
          for (std::size_t k = 0; k < 4; ++k) {
            const float* move = &layers.moves[4 * block.point[k][lane]];
            const double share = contact.inverse_mass[k] * contact.weight[k];
            check_near({double{move[0]}, double{move[1]}, double{move[2]}},
                       layers.ways[block.point[k][lane]] + share * by, 1e-8);
          }
        }
      }
    }
  }
}

TEST_CASE("a contact begins with what pushed in both of the last substeps") {
  Contact contact{.normal = {0, 1, 0}, .give = 1, .push = 3, .hold = {1, 0.5, 0}};
  contact.act_again(1);  // nothing pushed before: it was a blow
  CHECK(contact.push == 0);
  CHECK(contact.hold == Vector{});
  contact.push = 2;
  contact.hold = {1, 0, 0};
  contact.act_again(4);  // the next substep is twice as long
  CHECK(contact.push == 8);
  CHECK(contact.hold == Vector{4, 0, 0});
  contact.push = 1;
  contact.act_again(1);
  CHECK(contact.push == 1);
  contact.push = 5;
  contact.act_again(1);
  CHECK(contact.push == 1);
}

}  // namespace
}  // namespace weft::test::kernels_simd_contacts
