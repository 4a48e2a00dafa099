#include "perf/workbench.h"

#include <algorithm>
#include <span>

#include "engine/measure/simd_layout.h"
#include "kernels/runs.h"

namespace weft::perf {
namespace {

Ordering order_of(const SceneDescription& scene, const OrderingOptions& options) {
  std::vector<Link> links;
  for (const Constraint& c : scene.constraints) links.push_back({c.a, c.b, c.kind});
  return order(scene.positions, links, {}, options);
}

}  // namespace

Workbench::Workbench(const SceneDescription& scene, const OrderingOptions& options)
    : particles(scene.positions.size()),
      constraints(scene.constraints.size()),
      ordering(order_of(scene, options)) {
  place_particles(scene);
  place_constraints(scene);
  cut_pieces();
}

void Workbench::place_particles(const SceneDescription& scene) {
  for (kernels::Vectors* v : {&position, &velocity, &solved, &next_velocity}) v->resize(slots());
  inverse_mass.resize(slots());
  mass.resize(slots());
  reach.resize(slots());
  near.resize(slots());
  const std::size_t boxes = kernels::round_up(slots(), simd::kBoxed) / simd::kBoxed;
  for (kernels::Vectors* v : {&box_low, &box_high}) v->resize(kernels::round_up(boxes, kLanes));
  base.resize(4 * slots());
  change.resize(4 * slots());
  mask.assign(slots(), ~std::uint64_t{0});
  stride_ = slots() + kLanes;
  u_.resize(4 * stride_);
  for (std::size_t slot = 0; slot < slots(); ++slot) {
    const std::uint32_t i = ordering.particle_at[slot];
    if (i == kNoIndex) continue;
    position.set(slot, {scene.positions[i].x, scene.positions[i].y, scene.positions[i].z});
    inverse_mass[slot] = 1 / scene.masses[i];
    mass[slot] = scene.masses[i];
  }
  solved = position;
}

void Workbench::place_constraints(const SceneDescription& scene) {
  const std::size_t size = constraint_slots();
  blocks_.resize(size / kLanes);
  impulse.resize(size);
  rest_length_.assign(size, 1);
  inverse_square_.assign(size, 0);
  scale_.resize(size);
  for (std::size_t c = 0; c < size; ++c) {
    if (ordering.link_at[c] == kNoIndex) continue;
    const double rest = scene.constraints[ordering.link_at[c]].rest_length;
    rest_length_[c] = rest;
    inverse_square_[c] = 1 / (rest * rest);
    scale_[c] = 1 / rest;
    block(c).gain_a[c % kLanes] = static_cast<float>(-rest * rest / 2);
    block(c).gain_b[c % kLanes] = static_cast<float>(rest * rest / 2);
  }
}

void Workbench::cut_pieces() {
  for (const Batch& batch : ordering.batches) {
    const std::size_t first = pieces.size();
    for (std::uint32_t r = batch.first_run; r < batch.last_run; ++r) {
      cut(ordering.runs[r], batch, false);
    }
    const std::size_t singles = pieces.size();
    cut({0, 0, batch.singles, batch.last - batch.singles}, batch, true);
    batches.push_back({first, singles, pieces.size()});
  }
  for (const Piece& piece : pieces) runs.push_back(piece.run);
}

void Workbench::cut(const kernels::Run& run, const Batch& batch, bool singles) {
  for (std::uint32_t k = 0; k < run.length; k += kChunk) {
    const std::uint32_t length = std::min(kChunk, run.length - k);
    pieces.push_back({{run.a + k, run.b + k, run.constraint + k, length}, batch.colour, singles});
  }
}

/// All directions the same, errors by chance: more demands than a mesh with cells can meet, so that
/// every pass corrects every constraint, and no number shrinks until it is denormal.
void Workbench::fill_errors() {
  Random random(7);
  for (std::size_t c = 0; c < constraint_slots(); ++c) {
    const std::size_t lane = c % kLanes;
    block(c).nx[lane] = static_cast<float>(scale_[c]);
    block(c).ny[lane] = block(c).nz[lane] = 0;
    block(c).e0[lane] = scale_[c] > 0 ? static_cast<float>(0.04 * (random.unit() - 0.5)) : 0;
  }
  std::ranges::fill(u_, 0.f);
}

simd::BlockRelaxation Workbench::relaxation(bool in_quads) {
  fill_errors();
  simd::BlockRelaxation r;
  r.u = {u_.data(), in_quads ? 1 : stride_, in_quads ? std::size_t{4} : 1};
  r.blocks = blocks_.data();
  r.impulse = impulse.data();
  r.a = ordering.a.data();
  r.b = ordering.b.data();
  r.mask = mask.data();
  r.threshold = 0;
  r.from_memory = blocks_.size() * sizeof blocks_[0] > kernels::kCachedBytes;
  return r;
}

simd::Geometry Workbench::geometry() {
  return {position.view(), rest_length_.data(), inverse_square_.data(),
          scale_.data(),   ordering.a.data(),   ordering.b.data()};
}

simd::Boxes Workbench::boxes() {
  return {box_low.view(), box_high.view(), reach.data(), box_low.size()};
}

simd::Motion Workbench::motion() {
  simd::Motion m;
  m.inverse_mass = inverse_mass.data();
  m.mass = mass.data();
  m.gravity = {0, -10, 0};
  m.position = position.view();
  m.velocity = velocity.view();
  m.solved = solved.view();
  m.next_velocity = next_velocity.view();
  return m;
}

const PullLayout& Workbench::pulls() {
  if (!pulls_) {
    pulls_ = std::make_unique<PullLayout>(make_pull_layout(ordering));
    pull_memory_ = std::make_unique<PullMemory>(*pulls_);
    pull_weight_ = pulls_->weights(blocks_);
  }
  return *pulls_;
}

simd::Anticipation Workbench::anticipation(float threshold) {
  const PullLayout& layout = pulls();
  return pull_memory_->view(layout, pull_weight_, threshold);
}

Workbench& Workshop::get(const std::string& mesh, int size, bool singles) {
  auto& bench = benches_[{mesh, size, singles}];
  OrderingOptions options;
  if (singles) options.least_run_share = 2;
  if (!bench) {
    bench = std::make_unique<Workbench>(mesh == "grid" ? grid(size) : irregular(size), options);
  }
  return *bench;
}

}  // namespace weft::perf
