#include "engine/solvers/yarn/yarn_layout.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <set>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/measure/simd_layout.h"
#include "engine/model/model.h"
#include "engine/ordering/used_colours.h"
#include "engine/ordering/yarns.h"

namespace weft {
namespace {

using kernels::kLanes;

/// An open yarn: link k joins particles k and k + 1.
struct Chain {
  std::vector<std::uint32_t> particles, links;
  std::uint32_t family = 0;
};

/// Its links are numbers of constraints.
WovenYarns find_yarns_of(const Model& model, std::span<const std::uint32_t> constraints) {
  const ConstraintStore& s = model.constraints;
  std::vector<Link> links;
  for (const std::uint32_t c : constraints) links.push_back({s.a[c], s.b[c]});
  WovenYarns yarns = find_yarns(initial_positions(model), links);
  for (std::uint32_t& link : yarns.links) link = constraints[link];
  return yarns;
}

std::vector<Chain> open_chains(const WovenYarns& yarns, std::size_t slots) {
  std::vector<Chain> chains;
  std::vector<Chain> cut;
  UsedColours used(slots);
  for (const Yarn& yarn : yarns.yarns) {
    const auto particles = yarns.particles_of(yarn);
    const auto links = yarns.links_of(yarn);
    Chain chain{{particles.begin(), particles.end()}, {links.begin(), links.end()}, yarn.family};
    for (const std::uint32_t p : particles) used.insert(p, yarn.family);
    if (yarn.closed) {
      cut.push_back({{particles.back(), particles.front()}, {chain.links.back()}});
      chain.links.pop_back();
    }
    chains.push_back(std::move(chain));
  }
  for (Chain& chain : cut) {
    chain.family = used.lowest_free(chain.particles);
    for (const std::uint32_t p : chain.particles) used.insert(p, chain.family);
    chains.push_back(std::move(chain));
  }
  return chains;
}

/// Calls work(k, links) for each span: the particles k and k + links are fixed, and those between
/// them are free. A single link between two fixed particles is no span, since nothing can move.
template <class Work>
void for_each_span(const Model& model, const Chain& chain, Work&& work) {
  std::size_t before = chain.particles.size();  // the last fixed particle, if any
  for (std::size_t k = 0; k < chain.particles.size(); ++k) {
    if (model.inverse_mass[chain.particles[k]] != 0) continue;
    const std::size_t from = std::exchange(before, k);
    if (from < k && k - from > 1) work(from, k - from);
  }
}

/// The family with most links in spans that are not braced becomes the first, which linear systems
/// eliminate exactly: a span that is almost straight is too stiff for conjugate gradients.
void begin_with_spans(const Model& model, Braces& braces, std::vector<Chain>& chains) {
  std::vector<std::size_t> count;  // per family
  for (const Chain& chain : chains) {
    count.resize(std::max<std::size_t>(count.size(), chain.family + 1));
    for_each_span(model, chain, [&](std::size_t k, std::size_t links) {
      const bool braced = braces.is_braced(std::span(chain.particles).subspan(k, links + 1));
      if (!braced) count[chain.family] += links;
    });
  }
  if (count.empty()) return;
  const auto most = static_cast<std::uint32_t>(std::ranges::max_element(count) - count.begin());
  for (Chain& chain : chains) {
    if (chain.family == most)
      chain.family = 0;
    else if (chain.family == 0)
      chain.family = most;
  }
}

/// Sorts by family, then by length, the longest chains first, then by position in memory.
void sort(std::vector<Chain>& chains) {
  for (Chain& chain : chains) {
    if (chain.particles.front() < chain.particles.back()) continue;
    std::ranges::reverse(chain.particles);
    std::ranges::reverse(chain.links);
  }
  std::ranges::sort(chains, [](const Chain& one, const Chain& two) {
    if (one.family != two.family) return one.family < two.family;
    if (one.links.size() != two.links.size()) return one.links.size() > two.links.size();
    return one.particles < two.particles;
  });
}

/// Whether these chains of equal length are adjacent in memory: the k-th particles of all chains
/// have consecutive slots.
bool side_by_side(std::span<const Chain> chains) {
  for (std::size_t i = 1; i < chains.size(); ++i) {
    for (std::size_t k = 0; k < chains[0].particles.size(); ++k) {
      if (chains[i].particles[k] != chains[0].particles[k] + i) return false;
    }
  }
  return true;
}

/// Sorts chains of equal length so that groups of four that are adjacent in memory come first.
void bring_fours_forward(std::span<Chain> chains) {
  std::vector<Chain> fours, others;
  for (std::size_t i = 0; i < chains.size();) {
    const bool four = i + 4 <= chains.size() && side_by_side(chains.subspan(i, 4));
    std::vector<Chain>& to = four ? fours : others;
    for (const std::size_t last = i + (four ? 4 : 1); i < last; ++i) {
      to.push_back(std::move(chains[i]));
    }
  }
  std::ranges::move(fours, chains.begin());
  std::ranges::move(others, chains.begin() + static_cast<std::ptrdiff_t>(fours.size()));
}

/// How many chains at the beginning are like the first.
template <class Alike>
std::size_t stretch(std::span<const Chain> chains, Alike&& alike) {
  std::size_t n = 1;
  while (n < chains.size() && alike(chains[0], chains[n])) ++n;
  return n;
}

bool of_one_family(const Chain& one, const Chain& two) { return one.family == two.family; }
bool of_one_length(const Chain& one, const Chain& two) {
  return of_one_family(one, two) && one.links.size() == two.links.size();
}

/// Compares the rows with these numbers.
struct LessByBytes {
  const kernels::AlignedVector<simd::YarnRow>& rows;

  bool operator()(std::uint32_t one, std::uint32_t two) const {
    return std::memcmp(&rows[one], &rows[two], sizeof(simd::YarnRow)) < 0;
  }
};

/// In kg; 1 if no particle is free. Particles that no constraint joins do not count: their mass may
/// be out of the range of a float.
double lightest_joined(const Model& model) {
  double most = 0;
  for (std::size_t c = 0; c < model.constraints.size(); ++c) {
    most = std::max({most, model.inverse_mass[model.constraints.a[c]],
                     model.inverse_mass[model.constraints.b[c]]});
  }
  return most > 0 ? 1 / most : 1;
}

class YarnLayoutBuilder {
 public:
  YarnLayoutBuilder(const Model& model, Braces& braces, YarnLayout& layout)
      : model_(model), braces_(braces), layout_(layout), known_(LessByBytes{layout.kinds}) {
    layout.lightest = lightest_joined(model);
  }

  /// Makes a block of these chains, one in each lane. The first is the longest.
  void add_block(std::span<const Chain> chains) {
    const std::size_t rows = chains.front().particles.size();
    const std::size_t first = layout_.rows(), last = first + rows;
    const std::size_t padding = model_.slots() + kLanes * layout_.blocks.size();
    block_.assign(rows, {});
    layout_.longest = std::max(layout_.longest, rows);
    layout_.blocks.push_back({static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last),
                              static_cast<std::uint32_t>(chains.size())});
    for (std::size_t i = first * kLanes; i < last * kLanes; ++i) {
      layout_.slot.push_back(static_cast<std::uint32_t>(padding + i % kLanes));
      layout_.constraint.push_back(kNoIndex);
    }
    layout_.links.push_back(0);
    for (std::size_t i = 0; i < chains.size(); ++i) {
      fill(chains[i], first, i);
      layout_.links.back() += static_cast<std::uint32_t>(chains[i].links.size());
    }
    simd::derive_joints(block_);
    for (const simd::YarnRow& row : block_) layout_.kind.push_back(kind_of(row));
  }

 private:
  std::uint32_t kind_of(const simd::YarnRow& row) {
    layout_.kinds.push_back(row);
    const auto [known, is_new] =
        known_.insert(static_cast<std::uint32_t>(layout_.kinds.size() - 1));
    if (!is_new) layout_.kinds.pop_back();
    return *known;
  }
  void fill(const Chain& chain, std::size_t first, std::size_t lane) {
    for (std::size_t k = 0; k < chain.particles.size(); ++k) {
      const std::uint32_t slot = chain.particles[k];
      layout_.slot[(first + k) * kLanes + lane] = slot;
      simd::YarnRow& row = block_[k];
      row.inverse_mass[lane] = static_cast<float>(model_.inverse_mass[slot] * layout_.lightest);
      if (k == chain.links.size()) continue;
      layout_.constraint[(first + k) * kLanes + lane] = chain.links[k];
      row.rest[lane] = static_cast<float>(model_.constraints.rest_length[chain.links[k]]);
      row.compliance[lane] = model_.constraints.compliance_in_lanes(chain.links[k]);
    }
    add_spans(chain, first, lane);
  }
  /// A model with springs holds none: with laws in place of lengths nothing is to be kept of these.
  void add_spans(const Chain& chain, std::size_t first, std::size_t lane) {
    if (model_.constraints.has_springs()) return;
    for_each_span(model_, chain, [&](std::size_t k, std::size_t links) {
      const auto slots = std::span(chain.particles).subspan(k, links + 1);
      if (braces_.is_braced(slots)) return;
      YarnSpan& span = layout_.spans.emplace_back();
      span.row = static_cast<std::uint32_t>(first + k);
      span.last_row = static_cast<std::uint32_t>(first + k + links);
      span.lane = static_cast<std::uint32_t>(lane);
      span.first_slot = static_cast<std::uint32_t>(layout_.span_slots.size());
      span.has_chords = braces_.has_chords(slots);
      layout_.span_slots.insert(layout_.span_slots.end(), slots.begin(), slots.end());
      for (std::size_t i = k; i < k + links; ++i) {
        span.length += model_.constraints.rest_length[chain.links[i]];
      }
    });
  }

  const Model& model_;
  Braces& braces_;
  YarnLayout& layout_;
  std::set<std::uint32_t, LessByBytes> known_;  // the kinds so far, without duplicates
  std::vector<simd::YarnRow> block_;
};

double cell_of(const ConstraintStore& store) {
  const auto rests = std::span(store.rest_length).first(store.plain);
  if (rests.empty()) return 0;
  const auto [shortest, longest] = std::ranges::minmax(rests);
  return std::exp2(std::floor(std::log2(std::min(8 * shortest, longest / 64))));
}

/// The number of quads: one for each slot of the model, then kLanes of padding for each block.
std::size_t quads_of(const Model& model, const YarnLayout& layout) {
  return model.slots() + kLanes * layout.blocks.size();
}

/// The slots of particles that are on no yarn of the second family.
std::vector<std::uint32_t> slots_not_in_second(const Model& model, const YarnLayout& layout) {
  std::vector<bool> held(quads_of(model, layout), false);
  if (layout.families() > 1) {
    const std::size_t first = layout.blocks[layout.family_begin[1]].first;
    const std::size_t last = layout.blocks[layout.family_begin[2] - 1].last;
    for (std::size_t i = first * kLanes; i < last * kLanes; ++i) held[layout.slot[i]] = true;
  }
  std::vector<std::uint32_t> slots;
  for (std::uint32_t slot = 0; slot < model.slots(); ++slot) {
    if (!held[slot] && model.ordering.particle_at[slot] != kNoIndex) slots.push_back(slot);
  }
  return slots;
}

std::vector<std::uint32_t> find_longest_at(const Model& model, std::span<const Chain> chains) {
  const auto rows = [](const Chain& chain) {
    return static_cast<std::uint32_t>(chain.particles.size());
  };
  const auto another = [&](const Chain& chain) { return rows(chain) != rows(chains.front()); };
  if (std::ranges::none_of(chains, another)) return {};
  std::vector<std::uint32_t> rows_of_yarn(model.constraints.size());
  for (const Chain& chain : chains) {
    for (const std::uint32_t link : chain.links) rows_of_yarn[link] = rows(chain);
  }
  std::vector<std::uint32_t> longest_at;
  for (const Chunk& chunk : model.simd().chunks) {
    std::uint32_t& longest = longest_at.emplace_back(0);
    for (std::uint32_t i = 0; i < chunk.run.length; ++i) {
      const std::uint32_t c = model.simd().constraint_at[chunk.run.constraint + i];
      if (c != kNoIndex) longest = std::max(longest, rows_of_yarn[c]);
    }
  }
  return longest_at;
}

}  // namespace

std::vector<Vec3> initial_positions(const Model& model) {
  std::vector<Vec3> positions;
  positions.reserve(model.slots());
  for (std::size_t i = 0; i < model.slots(); ++i) {
    const kernels::Vector x = model.initial_position[i];
    positions.push_back({x.x, x.y, x.z});
  }
  return positions;
}

YarnLayout make_yarn_layout(const Model& model) {
  std::vector<std::uint32_t> all(model.constraints.plain);
  std::iota(all.begin(), all.end(), 0u);
  return make_yarn_layout(model, all, YarnMemory::woven_if_possible, !model.has_spheres());
}

YarnLayout make_yarn_layout(const Model& model, std::span<const std::uint32_t> constraints,
                            YarnMemory memory, bool spans_first) {
  YarnLayout layout;
  layout.cell = cell_of(model.constraints);
  std::vector<Chain> chains = open_chains(find_yarns_of(model, constraints), model.slots());
  Braces braces(model);
  if (spans_first) begin_with_spans(model, braces, chains);
  sort(chains);
  layout.longest_at = find_longest_at(model, chains);
  YarnLayoutBuilder builder(model, braces, layout);
  for (std::span<Chain> left = chains; !left.empty();) {
    const std::size_t n = stretch(left, of_one_length);
    bring_fours_forward(left.first(n));
    left = left.subspan(n);
  }
  for (std::span<const Chain> left = chains; !left.empty();) {
    const std::size_t n = stretch(left, of_one_family);
    layout.family_begin.push_back(static_cast<std::uint32_t>(layout.blocks.size()));
    for (std::size_t i = 0; i < n; i += kLanes) {
      builder.add_block(left.subspan(i, std::min<std::size_t>(kLanes, n - i)));
    }
    left = left.subspan(n);
  }
  layout.family_begin.push_back(static_cast<std::uint32_t>(layout.blocks.size()));
  layout.not_in_second = slots_not_in_second(model, layout);
  layout.places.floats = 4 * quads_of(model, layout);
  layout.places.padding = 4 * model.slots();
  if (memory == YarnMemory::woven_if_possible) weave(model, layout);
  for (std::uint32_t& slot : layout.not_in_second) slot = layout.places.of(slot);
  return layout;
}

std::size_t YarnLayout::bytes() const {
  return bytes_of(blocks) + bytes_of(links) + bytes_of(constraint) + bytes_of(family_begin) +
         bytes_of(slot) + bytes_of(patches) + bytes_of(kind) + bytes_of(kinds) +
         bytes_of(not_in_second) + bytes_of(longest_at) + bytes_of(spans) + bytes_of(span_slots) +
         places.bytes();
}

const YarnLayout& Model::yarns() const {
  return yarns_.get([this] { return make_yarn_layout(*this); });
}

}  // namespace weft
