/// A block of yarns without a cloth around it, and what dense matrices in double make of it.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <iterator>
#include <vector>

#include "kernels/simd/table.h"
#include "tests/support/random.h"

namespace weft::test {

using kernels::kLanes;

/// A block of kLanes yarns of lanes 0 ... kLanes - 1 particles, each with slots of its own, bent at
/// random and stretched by up to a hundredth; some particles are fixed.
struct BlockOfYarns {
  static constexpr std::uint32_t kRows = kLanes;
  std::vector<std::uint32_t> slot, kind;
  kernels::AlignedVector<simd::YarnRow> rows;
  kernels::AlignedVector<simd::YarnSystemRow> system;
  kernels::AlignedVector<std::int32_t> base_step;
  kernels::AlignedVector<simd::YarnScratch> scratch;
  kernels::AlignedVector<simd::LaneVectors> directions;  // at the start of a rattle step
  kernels::AlignedVector<float> base, u, t;
  kernels::Vectors x;
  double cell = 0x1p-10;
  bool placed = false;  // the rows have the base
  bool from_memory = false;
  bool in_fours = false;

  BlockOfYarns() : rows(kRows), system(kRows), base_step(kRows * kLanes), scratch(kRows) {
    const std::size_t slots = kRows * kLanes + kLanes;
    base.resize(4 * slots);
    u.resize(4 * slots);
    t.resize(4 * slots);
    x.resize(slots);
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

  static std::uint32_t length(std::uint32_t lane) { return lane; }
  std::uint32_t slot_of(std::uint32_t k, std::uint32_t lane) const {
    return slot[k * kLanes + lane];
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
    return {kind.data(),
            rows.data(),
            system.data(),
            slot.data(),
            directions.empty() ? nullptr : directions.data(),
            false,
            base.data(),
            base_step.data(),
            static_cast<float>(cell),
            !placed,
            from_memory};
  }
  simd::YarnBlock block() const { return {0, kRows, in_fours}; }
  /// Lanes k, k + 4, k + 8 and k + 12 side by side; those of k = 3 are padding.
  void stand_in_fours() {
    for (std::uint32_t i = 0; i < slot.size(); ++i) {
      const std::uint32_t lane = i % kLanes, place = 4 * (lane % 4) + lane / 4;
      slot[i] = lane % 4 == 3 ? kRows * kLanes + place : i - lane + place;
      if (lane % 4 < 3) continue;
      rows[i / kLanes].rest[lane] = rows[i / kLanes].inverse_mass[lane] = 0;
    }
    Random random(7);
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) place(lane, random);
  }
  void push(const kernels::Vectors& d) {
    for (std::size_t i = 0; i < d.size(); ++i) {
      t[4 * i] = static_cast<float>(d[i].x);
      t[4 * i + 1] = static_cast<float>(d[i].y);
      t[4 * i + 2] = static_cast<float>(d[i].z);
    }
  }
  kernels::Vector t_of(std::uint32_t k, std::uint32_t lane) const {
    const float* at = &t[4 * slot_of(k, lane)];
    return {static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])};
  }
  std::vector<float> p() const {
    std::vector<float> values;
    for (const simd::YarnSystemRow& row : system) {
      values.insert(values.end(), std::begin(row.p), std::end(row.p));
    }
    return values;
  }
  simd::Displacements quads(kernels::AlignedVector<float>& v) { return {v.data(), 1, 4}; }
  void start(const simd::Table& table) {
    table.split_positions(x.view(), quads(base), quads(u), cell, 0, x.size());
  }
  /// Impulses act along the directions at q from now on.
  void keep_start(const simd::Table& table, const kernels::Vectors& q) {
    directions.resize(kRows);
    table.split_positions(kernels::Vectors(q).view(), quads(base), quads(u), cell, 0, q.size());
    table.yarn_keep_start(yarns(), block(), quads(u));
  }
  kernels::Vectors end(const simd::Table& table) { return end(table, x); }
  kernels::Vectors end(const simd::Table& table, kernels::Vectors moved) {
    table.join_positions(moved.view(), quads(base), quads(u), 0, x.size());
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
/// Vectors of up to `size`, or beside those given.
kernels::Vectors scattered(kernels::Vectors v, double size);

}  // namespace weft::test
