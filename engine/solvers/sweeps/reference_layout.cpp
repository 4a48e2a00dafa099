#include "engine/solvers/sweeps/reference_layout.h"

#include <algorithm>

#include "engine/bytes_of.h"
#include "engine/model/model.h"

namespace weft {
namespace {

void build_rows(const Model& model, ReferenceLayout& layout) {
  const ConstraintStore& s = model.constraints;
  Lists& rows = layout.rows;
  rows.begin.push_back(0);
  std::vector<std::pair<std::uint32_t, double>> row;
  for (std::uint32_t c = 0; c < s.plain; ++c) {
    row.clear();
    for (const std::uint32_t p : {s.a[c], s.b[c]}) {
      const double w = model.inverse_mass[p];
      for (const std::uint32_t j : layout.adjacent[p]) {
        const bool same_end = (s.a[j] == p) == (s.a[c] == p);
        if (j != c) row.emplace_back(j, same_end ? w : -w);
      }
    }
    std::ranges::sort(row);
    layout.row_later.push_back(rows.begin.back());
    for (const auto& [j, weight] : row) {
      rows.items.push_back(j);
      layout.row_weight.push_back(weight);
      if (j < c) ++layout.row_later.back();
    }
    rows.begin.push_back(static_cast<std::uint32_t>(rows.items.size()));
  }
}

void build_blocks(const Model& model, ReferenceLayout& layout) {
  const ConstraintStore& s = model.constraints;
  for (std::size_t c = 0; c < s.plain; ++c) {
    layout.plain_colour.push_back(static_cast<std::uint8_t>(s.colour[c]));
  }
  auto& first = layout.block_first;
  for (std::uint32_t c = 0; c < s.plain; ++c) {
    const bool full = !first.empty() && c - first.back() == reference::kBlock;
    if (c == 0 || full || s.colour[c] != s.colour[c - 1]) first.push_back(c);
    layout.block_of.push_back(static_cast<std::uint32_t>(first.size() - 1));
  }
  first.push_back(static_cast<std::uint32_t>(s.plain));
}

void list_block_neighbours(const Model& model, ReferenceLayout& layout) {
  std::vector<std::uint32_t> blocks;
  layout.block_neighbours.begin.push_back(0);
  for (std::size_t block = 0; block + 1 < layout.block_first.size(); ++block) {
    blocks.clear();
    for (std::size_t c = layout.block_first[block]; c < layout.block_first[block + 1]; ++c) {
      for (const std::uint32_t j : layout.rows[c]) {
        if (j < model.constraints.plain) blocks.push_back(layout.block_of[j]);
      }
    }
    std::ranges::sort(blocks);
    blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
    layout.block_neighbours.push_back(blocks);
  }
}

}  // namespace

ReferenceLayout make_reference_layout(const Model& model) {
  ReferenceLayout layout;
  layout.hub = model.hub.data();
  layout.adjacent = make_lists(model.slots(), [&](auto&& add) {
    for (std::uint32_t c = 0; c < model.constraints.size(); ++c) {
      add(model.constraints.a[c], c);
      add(model.constraints.b[c], c);
    }
  });
  build_rows(model, layout);
  build_blocks(model, layout);
  list_block_neighbours(model, layout);
  return layout;
}

reference::Topology ReferenceLayout::topology() const {
  reference::Topology t;
  t.row_begin = rows.begin.data();
  t.row_later = row_later.data();
  t.row_constraint = rows.items.data();
  t.row_weight = row_weight.data();
  t.blocks = block_first.size() - 1;
  t.block_first = block_first.data();
  t.block_of = block_of.data();
  t.block_begin = block_neighbours.begin.data();
  t.block_neighbour = block_neighbours.items.data();
  t.adjacent_begin = adjacent.begin.data();
  t.adjacent_constraint = adjacent.items.data();
  t.hub = hub;
  t.colour = plain_colour.data();
  return t;
}

std::size_t ReferenceLayout::bytes() const {
  return adjacent.bytes() + rows.bytes() + bytes_of(row_later) + bytes_of(row_weight) +
         bytes_of(plain_colour) + bytes_of(block_first) + bytes_of(block_of) +
         block_neighbours.bytes();
}

const ReferenceLayout& Model::reference() const {
  return reference_.get([this] { return make_reference_layout(*this); });
}

}  // namespace weft
