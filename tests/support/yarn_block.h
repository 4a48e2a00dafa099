/// A block of yarns without a cloth around it, and what dense matrices in double make of it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <iterator>
#include <vector>

#include "kernels/simd/table.h"
#include "tests/support/random.h"

namespace weft::test {

using kernels::kLanes;

/// How the block finds its particles: scattered, as rows of memory, as patches, or as single rows.
enum class Stand : std::uint8_t { quads, in_place, patches, singles };
inline constexpr Stand kStands[] = {Stand::quads, Stand::in_place, Stand::patches, Stand::singles};

/// A block of kLanes yarns of lanes 0 ... kLanes - 1 particles, each with slots of its own, bent at
/// random and stretched by up to a hundredth; some particles are fixed.
struct BlockOfYarns {
  static constexpr std::uint32_t kRows = kLanes;
  Stand stand;
  std::vector<simd::YarnPatch> patches;
  std::vector<std::uint32_t> slot, kind;
  kernels::AlignedVector<simd::YarnRow> rows;
  kernels::AlignedVector<simd::YarnSystemRow> system;
  kernels::AlignedVector<simd::YarnBaseSteps> base_step;
  kernels::AlignedVector<simd::YarnScratch> scratch;
  kernels::AlignedVector<simd::YarnDirections> directions;  // at the start of a rattle step
  kernels::AlignedVector<simd::YarnSpringRow> springs;      // empty: all links are rigid
  kernels::AlignedVector<float> base, u, t;
  kernels::Vectors x;
  double cell = 0x1p-10;
  std::uint32_t lanes = kLanes;
  bool placed = false;  // the rows have the base
  bool from_memory = false;
  std::uint32_t patches_ahead = 0;  // behind the block's own: of a block that comes next

  explicit BlockOfYarns(Stand how = Stand::quads)
      : stand(how),
        rows(kRows),
        system(kRows),
        base_step(kRows),
        scratch(2 * (kRows + 1)),
        x(kRows * kLanes + kLanes) {
    for (kernels::AlignedVector<float>* array : {&base, &u, &t}) array->resize(floats());
    if (stand == Stand::patches) {
      for (std::uint32_t first = 0; first < kRows; first += kColumns) add_patch(first);
    }
    if (stand == Stand::singles) {
      for (std::uint32_t k = 0; k < kRows; ++k) add_single(k);
    }
    Random random(7);
    for (std::uint32_t k = 0; k < kRows; ++k) {
      kind.push_back(k);
      for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
        const bool real = k < length(lane);
        slot.push_back(real ? (k * kLanes + lane) * 77 % (kRows * kLanes) : kRows * kLanes + lane);
        rows[k].rest[lane] = k + 1 < length(lane) ? 0.1f : 0.f;
        rows[k].inverse_mass[lane] =
            real && (k > 0 || lane % 3 > 0) ? static_cast<float>(random.between(0.1, 1)) : 0.f;
      }
    }
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) place(lane, random);
  }

  /// Two of three links become springs that have pulled and pushed before.
  void soften() {
    springs.resize(kRows);
    for (std::uint32_t k = 0; k < kRows; ++k) {
      for (std::uint32_t lane = k + 2; lane < kLanes; ++lane) {
        if ((k + lane) % 3 == 0) continue;
        springs[k].softness[lane] = 0.01f * static_cast<float>(1 << ((k + 2 * lane) % 12));
        springs[k].shift[lane] = 1e-3f * static_cast<float>((k + lane) % 5);
        springs[k].sum[lane] = 2e-4f * static_cast<float>(lane % 4) - 3e-4f;
      }
    }
  }
  double softness(std::uint32_t k, std::uint32_t lane) const {
    return springs.empty() ? 0 : static_cast<double>(springs[k].softness[lane]);
  }
  /// The length beyond rest at which a link has no error.
  double give(std::uint32_t k, std::uint32_t lane) const {
    if (springs.empty()) return 0;
    return static_cast<double>(springs[k].shift[lane]) +
           softness(k, lane) * static_cast<double>(springs[k].sum[lane]);
  }

  static std::uint32_t length(std::uint32_t lane) { return lane; }
  std::uint32_t slot_of(std::uint32_t k, std::uint32_t lane) const {
    return slot[k * kLanes + lane];
  }

  /// Places of particles, and the way from axis to axis. Patches have two rows of memory for each
  /// lane, and columns that are nobody's; lanes without particles share a row that is nobody's.
  static constexpr std::uint32_t kColumns = kRows / 2;
  std::uint32_t place_of(std::uint32_t k, std::uint32_t lane) const {
    if (stand == Stand::quads) return 4 * slot_of(k, lane);
    if (stand == Stand::in_place) return 3 * kLanes * k + lane;
    const std::uint32_t row = length(lane) == 0 ? 2 * kLanes : lane + kLanes * (k / kColumns);
    return 3 * kLanes * row + k % kColumns;
  }
  std::size_t stride() const { return stand == Stand::quads ? 1 : kLanes; }
  std::size_t floats() const {
    if (stand == Stand::quads) return 4 * x.size();
    return 3 * kLanes * (stand == Stand::in_place ? kRows : 2 * kLanes + 1);
  }
  void add_patch(std::uint32_t first) {
    simd::YarnPatch patch{};
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) patch.place[lane] = place_of(first, lane);
    for (std::uint32_t i = 0; i < kLanes; ++i) patch.row[i] = i < kColumns ? first + i : kRows;
    patch.columns = kColumns;
    patches.push_back(patch);
  }
  void add_single(std::uint32_t k) {
    simd::YarnPatch patch{};
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) patch.place[lane] = place_of(k, lane);
    patch.row[0] = k;
    patch.single = true;
    patches.push_back(patch);
  }
  /// Of all particles.
  std::vector<float> of_particles(const kernels::AlignedVector<float>& array) const {
    std::vector<float> values;
    for_each_component([&](std::size_t, std::size_t place) { values.push_back(array[place]); });
    return values;
  }
  /// work(index in quads, index as the block stands)
  template <class Work>
  void for_each_component(Work&& work) const {
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
      for (std::uint32_t k = 0; k < length(lane); ++k) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          work(4 * std::size_t{slot_of(k, lane)} + axis, place_of(k, lane) + axis * stride());
        }
      }
    }
  }

  void place(std::uint32_t lane, Random& random) {
    kernels::Vector at{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    for (std::uint32_t k = 0; k < length(lane); ++k) {
      x.set(slot_of(k, lane), at);
      kernels::Vector d{1, random.between(-1, 1), random.between(-1, 1)};
      at = at + (0.1 * random.between(0.99, 1.01) / kernels::length(d)) * d;
    }
  }
  simd::Yarns yarns() {
    simd::derive_joints(rows);
    return {kind.data(),
            rows.data(),
            system.data(),
            slot.data(),
            patches.data(),
            directions.empty() ? nullptr : directions.data(),
            false,
            base.data(),
            base_step.data(),
            static_cast<float>(cell),
            !placed,
            from_memory,
            springs.empty() ? nullptr : springs.data()};
  }
  /// Of small steps.
  static double compliance(std::uint32_t lane) { return lane % 3 == 0 ? 1e-2 : 1e-3; }
  simd::YarnBlock block() const {
    simd::YarnBlock block{0, kRows, lanes};
    for (std::uint32_t lane = 0; lane < lanes; ++lane)
      block.compliance[lane] = static_cast<float>(compliance(lane));
    if (stand == Stand::quads) return block;
    block.access =
        stand == Stand::in_place ? simd::YarnAccess::in_place : simd::YarnAccess::patches;
    block.last_patch = static_cast<std::uint32_t>(patches.size()) - patches_ahead;
    block.patches_ahead = patches_ahead;
    return block;
  }
  void add_patches_ahead(std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) patches.push_back(simd::YarnPatch(patches[i]));
    patches_ahead = count;
  }
  void push(const kernels::Vectors& d) {
    for_each_component([&](std::size_t quad, std::size_t place) {
      const kernels::Vector v = d[quad / 4];
      t[place] = static_cast<float>(quad % 4 == 0 ? v.x : quad % 4 == 1 ? v.y : v.z);
    });
  }
  kernels::Vector t_of(std::uint32_t k, std::uint32_t lane) const {
    const float* at = &t[place_of(k, lane)];
    const auto axis = [&](std::size_t i) { return static_cast<double>(at[i * stride()]); };
    return {axis(0), axis(1), axis(2)};
  }
  std::vector<float> system_floats() const {
    std::vector<float> floats;
    for (const simd::YarnSystemRow& row : system) {
      floats.insert(floats.end(), std::begin(row.floats), std::end(row.floats));
    }
    return floats;
  }
  /// base + u = v
  void split(const simd::Table& table, kernels::Vectors v, double in_cells) {
    kernels::AlignedVector<float> base_quads(4 * v.size()), u_quads(4 * v.size());
    table.split_quads(v.view(), 0, v.size(), in_cells, base_quads.data(), u_quads.data());
    if (stand == Stand::quads) {
      base = base_quads;
      u = u_quads;
    }
    for_each_component([&](std::size_t quad, std::size_t place) {
      base[place] = base_quads[quad];
      u[place] = u_quads[quad];
    });
  }
  void start(const simd::Table& table) { split(table, x, cell); }
  /// Impulses act along the directions at q from now on.
  void keep_start(const simd::Table& table, const kernels::Vectors& q) {
    directions.resize(kRows);
    split(table, q, cell);
    table.yarn_keep_start(yarns(), block(), u.data(), scratch.data());
  }
  kernels::Vectors end(const simd::Table& table) { return end(table, x); }
  kernels::Vectors end(const simd::Table& table, kernels::Vectors moved) {
    kernels::AlignedVector<float> base_quads(4 * x.size()), u_quads(4 * x.size());
    for_each_component([&](std::size_t quad, std::size_t place) {
      base_quads[quad] = base[place];
      u_quads[quad] = u[place];
    });
    if (stand == Stand::quads) base_quads = base, u_quads = u;
    table.join_quads(moved.view(), 0, x.size(), base_quads.data(), u_quads.data());
    return moved;
  }
};

/// Along each link of a lane at x.
std::vector<kernels::Vector> directions(const BlockOfYarns& b, const kernels::Vectors& x,
                                        std::uint32_t lane);
/// What vectors at the particles of a lane become by impulses along s that bring e, errors that
/// change along n, to 0.
std::vector<kernels::Vector> solved_densely(const BlockOfYarns& b, std::uint32_t lane,
                                            const kernels::Vectors& at,
                                            const std::vector<kernels::Vector>& n,
                                            const std::vector<kernels::Vector>& s,
                                            const Eigen::VectorXd& e);
Eigen::VectorXd length_errors(const BlockOfYarns& b, std::uint32_t lane);
/// Where one exact linear solve takes the particles of a lane.
std::vector<kernels::Vector> solved_densely(const BlockOfYarns& b, std::uint32_t lane);
/// What is left of the laws at x, the largest, over rest lengths.
double largest_strain(const BlockOfYarns& b, const kernels::Vectors& x);
/// Vectors of up to `size`, or beside those given.
kernels::Vectors scattered(kernels::Vectors v, double size);

}  // namespace weft::test
