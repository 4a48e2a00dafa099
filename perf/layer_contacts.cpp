#include "perf/layer_contacts.h"

#include <algorithm>
#include <bit>

#include "engine/tuning.h"

namespace weft::perf {

using kernels::kLanes;

namespace {

constexpr std::size_t kColours = 64;
constexpr std::uint32_t kNone = 0xffffffffu;
constexpr double kSubstep = 2e-3;  // s

int bin_of(const LayerPair& pair) {
  return (pair.edges ? 1000 : 0) + static_cast<int>(4 * pair.distance / kLayerThickness);
}

template <class T>
double bytes_of(const T& vector) {
  return static_cast<double>(vector.size() * sizeof(vector[0]));
}

}  // namespace

LayerContacts::LayerContacts(const Layers& layers)
    : numbers_(layers.points.size(), kNone), near_(layers.near.size()) {
  std::vector<LayerPair> pairs = layers.near;
  std::ranges::stable_sort(pairs, {}, bin_of);
  for (const LayerPair& pair : pairs)
    for (const std::uint32_t point : pair.points) number(point);
  moving_ = points_.size();
  for (const LayerPair& pair : pairs)
    for (const std::uint32_t point : pair.beside) number(point);
  const auto edges = std::ranges::find(pairs, true, &LayerPair::edges);
  colour({pairs.begin(), edges});
  edges_from_ = blocks_.size();
  colour({edges, pairs.end()});
  put_places(layers);
}

void LayerContacts::number(std::uint32_t point) {
  if (numbers_[point] != kNone) return;
  numbers_[point] = static_cast<std::uint32_t>(points_.size());
  points_.push_back(point);
}

/// The lowest colour that none of the points has.
void LayerContacts::colour(const std::vector<LayerPair>& waiting) {
  std::vector<std::uint64_t> taken(moving_);
  std::array<std::vector<LayerPair>, kColours + 1> of;
  for (const LayerPair& pair : waiting) {
    std::uint64_t all = 0;
    for (const std::uint32_t point : pair.points) all |= taken[numbers_[point]];
    const auto lowest = static_cast<std::size_t>(std::countr_one(all));
    of[lowest].push_back(pair);
    if (lowest == kColours) continue;
    for (const std::uint32_t point : pair.points)
      taken[numbers_[point]] |= std::uint64_t{1} << lowest;
  }
  for (std::size_t c = 0; c < kColours; ++c) put(of[c]);
  if (!of[kColours].empty()) colour(of[kColours]);
}

/// Of one colour.
void LayerContacts::put(const std::vector<LayerPair>& pairs) {
  if (pairs.empty()) return;
  const std::size_t first = blocks_.size();
  blocks_.resize(first + (pairs.size() + kLanes - 1) / kLanes);
  for (std::size_t i = 0; i < kLanes * (blocks_.size() - first); ++i) {
    simd::ContactBlock& block = blocks_[first + i / kLanes];
    const std::size_t lane = i % kLanes;
    const auto nobody = static_cast<std::uint32_t>(moving_ + lane);
    for (std::size_t k = 0; k < 4; ++k) {
      block.point[k][lane] = i < pairs.size() ? numbers_[pairs[i].points[k]] : nobody;
      block.beside[k][lane] = i < pairs.size() ? numbers_[pairs[i].beside[k]] : nobody;
    }
    if (i >= pairs.size()) continue;
    for (std::size_t k = 0; k < 3; ++k) block.towards[k][lane] = pairs[i].is_border[k] ? -1.f : 1.f;
    block.thickness[lane] = static_cast<float>(kLayerThickness);
    block.friction[lane] = 0.3f;
  }
  colours_.push_back(
      {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(blocks_.size())});
}

/// There are quads for the lanes that are not used, too.
void LayerContacts::put_places(const Layers& layers) {
  places_.resize(4 * (points_.size() + kLanes));
  moves_.resize(4 * (moving_ + kLanes));
  active_.resize(blocks_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const kernels::Vector x = layers.points[points_[i]];
    const double quad[] = {x.x, x.y, x.z, layers.inverse_mass[points_[i]]};
    for (std::size_t k = 0; k < 4; ++k) places_[4 * i + k] = static_cast<float>(quad[k]);
  }
}

void LayerContacts::fall(const simd::Table& table) {
  for (simd::ContactBlock& block : blocks_) {
    std::ranges::fill(block.push, 0.f);
    std::ranges::fill(block.before, 0.f);
    block.hold = {};
  }
  for (std::size_t i = 0; i < moving_; ++i) {
    const float w = places_[4 * i + 3];
    moves_[4 * i] = moves_[4 * i + 2] = 0;
    moves_[4 * i + 1] = w > 0 ? static_cast<float>(-10 * kSubstep * kSubstep) : 0;
    moves_[4 * i + 3] = w;
  }
  freeze(table);
  find_active(table);
  gather_active();
}

void LayerContacts::freeze(const simd::Table& table) {
  const simd::ContactFreeze freeze{.blocks = blocks_.data(),
                                   .places = places_.data(),
                                   .rounding = 1e-6f,
                                   .warm = 1,
                                   .recovery = static_cast<float>(tuning::kContactRecovery)};
  table.contacts->freeze(freeze, false, 0, edges_from_);
  table.contacts->freeze(freeze, true, edges_from_, blocks_.size());
}

void LayerContacts::find_active(const simd::Table& table) {
  table.contacts->find_active(solving(), false, active_.data(), 0, blocks_.size());
}

void LayerContacts::gather_active() {
  active_blocks_.clear();
  active_colours_.clear();
  touching_ = 0;
  for (const Colour& colour : colours_) {
    const auto first = static_cast<std::uint32_t>(active_blocks_.size());
    for (std::uint32_t block = colour.first; block < colour.last; ++block) {
      touching_ += std::popcount(active_[block]);
      if (active_[block] != 0) active_blocks_.push_back(block);
    }
    active_colours_.push_back({first, static_cast<std::uint32_t>(active_blocks_.size())});
  }
}

void LayerContacts::visit(const simd::Table& table) {
  for (const Colour& colour : active_colours_)
    table.contacts->visit(solving(), active_blocks_.data() + colour.first,
                          colour.last - colour.first);
}

double LayerContacts::bytes() const { return bytes_of(blocks_); }
double LayerContacts::active_bytes() const {
  return static_cast<double>(sizeof(simd::ContactBlock) * active_blocks_.size());
}
double LayerContacts::move_bytes() const { return bytes_of(moves_); }

LayerCandidates::LayerCandidates(const Layers& layers) {
  put(layers, false);
  edges_from_ = blocks_.size();
  put(layers, true);
  for (const kernels::Vector x : layers.points)
    for (const double component : {x.x, x.y, x.z, 0.0})
      points_.push_back(static_cast<float>(component));
  ways_.resize(points_.size());
  for (std::size_t i = 3; i < ways_.size(); i += 4) ways_[i] = 1e-4f;
  distance_.resize(blocks_.size());
  near_.resize(blocks_.size());
}

/// Lanes that are not used repeat the last pair.
void LayerCandidates::put(const Layers& layers, bool edges) {
  std::size_t lane = 0;
  for (const LayerPair& pair : layers.candidates) {
    if (pair.edges != edges) continue;
    if (lane == 0) blocks_.emplace_back();
    for (std::size_t k = 0; k < 4; ++k)
      std::fill(blocks_.back().point[k] + lane, std::end(blocks_.back().point[k]), pair.points[k]);
    lane = (lane + 1) % kLanes;
    ++count_;
  }
}

void LayerCandidates::measure(const simd::Table& table) {
  const simd::PairMeasure measure{.pairs = blocks_.data(),
                                  .points = points_.data(),
                                  .ways = ways_.data(),
                                  .reach = static_cast<float>(kLayerThickness),
                                  .beyond = static_cast<float>(tuning::kContactBeyond),
                                  .distance = reinterpret_cast<float(*)[kLanes]>(distance_.data()),
                                  .near = near_.data()};
  table.measure_pairs(measure, false, 0, edges_from_);
  table.measure_pairs(measure, true, edges_from_, blocks_.size());
}

double LayerCandidates::near() const {
  int near = 0;
  for (const std::uint16_t bits : near_) near += std::popcount(bits);
  return near;
}

double LayerCandidates::bytes() const {
  return bytes_of(blocks_) + bytes_of(distance_) + bytes_of(points_) + bytes_of(ways_);
}

}  // namespace weft::perf
