/// Which blocks of particles a body may meet until the next search, and bodies as lanes read them.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/solvers/small_steps/body_frame.h"
#include "engine/solvers/small_steps/simd_bodies.h"
#include "engine/solvers/small_steps/small_steps_layout.h"
#include "engine/tuning.h"

namespace weft {

using kernels::kLanes;
using kernels::Vector;
using reference::BodyMotion;

SimdBodies::Extent SimdBodies::extent_of(std::size_t block, int substeps,
                                         const simd::Flight& flight, const float* base) const {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const YarnPlaces& places = model_.small_steps().places();
  const std::size_t step = places.woven() ? 1 : 4, axis = places.stride;
  const simd::BodyBlock& b = layout_.blocks[block];
  float low[3] = {kInfinity, kInfinity, kInfinity}, high[3] = {-kInfinity, -kInfinity, -kInfinity};
  float longest = 0, widest = 0, largest = 0;
  const auto ahead = static_cast<float>(substeps);
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    if (!(b.mass[lane] > 0)) continue;
    float square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t at = b.place + step * lane + k * axis;
      const float from = base[at] + flight.u_before[at];
      const float way = ahead * (flight.u[at] - flight.u_before[at]), to = from + way;
      low[k] = std::min({low[k], from, to});
      high[k] = std::max({high[k], from, to});
      largest = std::max(largest, std::abs(to));
      square += way * way;
    }
    longest = std::max(longest, square);
    widest = std::max(widest, b.radius[lane]);
  }
  const auto as_vector = [](const float(&v)[3]) {
    return Vector{static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
  };
  constexpr double kRounding = 0x1p-22;
  const double reach =
      static_cast<double>(widest) + kRounding * static_cast<double>(largest) + contact_tolerance_;
  return {as_vector(low), as_vector(high), reach, std::sqrt(static_cast<double>(longest))};
}

bool SimdBodies::may_touch(const Extent& extent, std::size_t body, const BodyClock::Box& box,
                           double time) const {
  if (clock_.bodies()[body].mesh != nullptr || !extent.meets(box)) return false;
  const BodyMotion& motion = clock_.motions()[body];
  const Vector middle = extent.middle();
  const double moves =
      time * (length(motion.velocity) + length(motion.spin) * length(middle - motion.to.centre));
  const reference::Gap gap = gap_of(*motion.form, motion.thickness, motion.to.from_place(middle));
  return gap.gap <= extent.radius() + moves;
}

/// Which blocks may meet which bodies until the next search.
void SimdBodies::search(const simd::Flight& flight, const float* base) {
  collect_impulses();
  const int substeps = clock_.substeps_of_interval();
  pairs_.clear();
  first_pair_.clear();
  pairs_of_.clear();
  std::vector<BodyClock::Box>& boxes = boxes_;
  boxes.clear();
  for (std::size_t body = 0; body < clock_.bodies().size(); ++body)
    boxes.push_back(clock_.box(body, substeps));  // of a mesh: nobody asks for it
  const double share = static_cast<double>(substeps) * h_;
  Vector sum{};
  extents_.clear();
  // A body or the fabric makes a particle that it takes along as fast as itself.
  double longest = 0;
  for (std::size_t body = 0; body < boxes.size(); ++body)
    longest = std::max(longest, share * clock_.fastest(body));
  for (std::uint32_t block = 0; block < layout_.blocks.size(); ++block) {
    extents_.push_back(extent_of(block, substeps, flight, base));
    longest = std::max(longest, extents_.back().way);
  }
  for (std::uint32_t block = 0; block < layout_.blocks.size(); ++block) {
    Extent& extent = extents_[block];
    extent.reach += tuning::kContactReach * longest;
    sum = sum + extent.middle();
    pairs_of_.push_back(static_cast<std::uint32_t>(pairs_.size()));
    for (std::uint32_t body = 0; body < boxes.size(); ++body) {
      if (!may_touch(extent, body, boxes[body], share)) continue;
      if (first_pair_.empty() || pairs_.back().block != block)
        first_pair_.push_back(static_cast<std::uint32_t>(pairs_.size()));
      pairs_.push_back({block, body});
    }
  }
  pairs_of_.push_back(static_cast<std::uint32_t>(pairs_.size()));
  first_pair_.push_back(static_cast<std::uint32_t>(pairs_.size()));
  contact_sums_.assign(pairs_.size(), {});
  for (auto* bits : {&touching_, &moved_, &quick_}) bits->assign(pairs_.size(), 0);
  const Vector middle = (1 / static_cast<double>(layout_.blocks.size())) * sum;
  constexpr double kGrid = 0x1p-6;  // m: floats hold its multiples up to 262 km
  const auto rounded = [](double x) { return kGrid * std::round(x / kGrid); };
  origin_ = {rounded(middle.x), rounded(middle.y), rounded(middle.z)};
}

void SimdBodies::write_frames() {
  const std::span<const BodyMotion> motions = clock_.motions();
  const auto count_of = [](const BodyMotion& body) {
    return body.form != nullptr ? body.form->faces().size() : 0;
  };
  std::size_t faces = 0;
  for (const BodyMotion& body : motions) faces += count_of(body);
  frames_.resize(motions.size());
  faces_.resize(faces);
  std::size_t first = 0;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    if (motions[i].form == nullptr) continue;  // a mesh, which no pair names
    const std::size_t count = count_of(motions[i]);
    write_frame(frames_[i], std::span(faces_).subspan(first, count), motions[i], origin_);
    first += count;
  }
}

}  // namespace weft
