#include <algorithm>
#include <array>
#include <tuple>

#include "engine/ordering/lattice_steps.h"
#include "engine/ordering/placement.h"

// A tile holds whole rows of the lattice. Its slots are grouped by the parity of the row and of the
// column, and each group is sorted by rows. With rows of 7 particles, where numbers are columns and
// '.' is padding:
//
//             columns 0 2 4 6        columns 1 3 5
//   row 0   | 0 2 4 6 |            | 1 3 5 . |
//   row 2   | 0 2 4 6 |  group 00  | 1 3 5 . |  group 01
//   row 1   | 0 2 4 6 |  group 10  | 1 3 5 . |  group 11
//   row 3   | 0 2 4 6 |            | 1 3 5 . |
//
// In slot order a group is one line, 0 2 4 6 0 2 4 6 and so on, so that constraint k of the batch
// "along the rows, from even columns" joins 00 + k with 01 + k, and that of "across, from odd rows"
// joins 10 + k with 00 + 4 + k. Joints across the end of a row are padding. Where links skip a row
// or a column, the period is 4 instead of 2.

namespace weft {
namespace {

using kernels::kLanes;

constexpr double kLargestWaste = 1.2;  // slots of a band of rows for each of its particles

// --------------------------------------------------------------------------------------- rows

struct Row {
  std::size_t first = 0, last = 0;   // in Rows::particles
  std::uint32_t number = 0;          // in its part
  std::uint32_t begin = 0, end = 0;  // columns
  std::size_t size() const { return last - first; }
};

struct Rows {
  std::vector<std::uint32_t> particles;
  std::vector<Row> rows;
};

std::vector<bool> joined_by(std::span<const Link> links, std::size_t particles) {
  std::vector<bool> is_joined(particles);
  for (const Link& link : links) is_joined[link.a] = is_joined[link.b] = true;
  return is_joined;
}

/// Rows that are so wide that only few of them fit into a tile are cut into strips, which follow
/// each other.
std::vector<std::uint32_t> strip_widths(std::span<const Cell> cells, std::uint32_t tile_particles,
                                        std::uint32_t period) {
  const std::uint32_t widest = std::max(64u, tile_particles / 4);
  std::vector<std::uint32_t> width;
  for (const Cell& cell : cells) {
    if (cell.part >= width.size()) width.resize(cell.part + 1);
    width[cell.part] = std::max(width[cell.part], static_cast<std::uint32_t>(cell.column) + 1);
  }
  for (std::uint32_t& w : width) {
    const std::uint32_t strips = (w + widest - 1) / widest;
    w = kernels::round_up((w + strips - 1) / strips, period);
  }
  return width;
}

Rows list_rows(std::span<const Cell> cells, const std::vector<bool>& is_joined,
               std::uint32_t tile_particles, std::uint32_t period) {
  const std::vector<std::uint32_t> width = strip_widths(cells, tile_particles, period);
  using Key = std::tuple<std::uint32_t, std::uint32_t, std::int32_t>;  // part, strip, row
  const auto key = [&](std::uint32_t p) {
    const Cell& cell = cells[p];
    return Key{cell.part, static_cast<std::uint32_t>(cell.column) / width[cell.part], cell.row};
  };
  std::vector<std::tuple<Key, std::int32_t, std::uint32_t>> sorted;
  sorted.reserve(cells.size());
  for (std::uint32_t p = 0; p < cells.size(); ++p) {
    if (is_joined[p]) sorted.push_back({key(p), cells[p].column, p});
  }
  std::sort(sorted.begin(), sorted.end());
  Rows rows;
  rows.particles.reserve(cells.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const auto& [at, column, p] = sorted[i];
    if (i == 0 || at != std::get<Key>(sorted[i - 1])) {
      const auto begin = static_cast<std::uint32_t>(column);
      rows.rows.push_back({i, i, static_cast<std::uint32_t>(cells[p].row), begin, begin});
    }
    rows.rows.back().last = i + 1;
    rows.rows.back().end = static_cast<std::uint32_t>(column) + 1;
    rows.particles.push_back(p);
  }
  return rows;
}

/// The numbers of the rows at which tiles begin, and the number of all rows.
std::vector<std::size_t> cut(const Rows& rows, std::uint32_t tiles) {
  std::vector<std::size_t> begin{0};
  const std::size_t particles = rows.particles.size();
  std::size_t row = 0;
  for (std::uint32_t t = 1; t < tiles; ++t) {
    const std::size_t wanted = particles * t / tiles;
    while (row < rows.rows.size() && (rows.rows[row].first + rows.rows[row].last) / 2 < wanted) {
      ++row;
    }
    if (row > begin.back()) begin.push_back(row);
  }
  if (rows.rows.size() > begin.back()) begin.push_back(rows.rows.size());
  return begin;
}

// -------------------------------------------------------------------------------------- bands

/// The layout of a row in its tile. The rows of a band have the same origin, which aligns them. A
/// row with too many holes is stored without them.
struct Lay {
  std::uint32_t origin = 0, width = 0;
  bool dense = false;
};

std::uint32_t padded_width(std::uint32_t width, std::uint32_t period) {
  return width < period ? width : kernels::round_up(width, period);
}

std::vector<Lay> lay_rows(std::span<const Row> rows, std::uint32_t period) {
  std::vector<Lay> lays;
  while (lays.size() < rows.size()) {
    const std::size_t first = lays.size();
    std::size_t last = first, size = 0;
    std::uint32_t begin = ~0u, end = 0;
    Lay lay;
    for (; last < rows.size(); ++last) {
      const Row& row = rows[last];
      const std::uint32_t origin = std::min(begin, row.begin) / period * period;
      const std::uint32_t width = padded_width(std::max(end, row.end) - origin, period);
      const auto area = static_cast<double>(width) * static_cast<double>(last + 1 - first);
      const auto most = kLargestWaste * static_cast<double>(size + row.size());
      if (area > most + kLanes && last > first) break;
      lay = {origin, width, area > most + kLanes};
      begin = std::min(begin, row.begin);
      end = std::max(end, row.end);
      size += row.size();
      if (lay.dense) {
        ++last;
        break;
      }
    }
    lays.insert(lays.end(), last - first, lay);
  }
  return lays;
}

// --------------------------------------------------------------------------------------- tile

constexpr std::uint32_t kLargestPeriod = 4;
using Groups = std::array<std::array<std::uint32_t, kLargestPeriod>, kLargestPeriod>;

class TileLayout {
 public:
  TileLayout(const Rows& rows, std::span<const Row> tile, std::span<const Cell> cells,
             Steps::Period period)
      : rows_(rows), cells_(cells), period_(period) {
    const std::vector<Lay> lays = lay_rows(tile, period.columns);
    for (std::size_t i = 0; i < tile.size(); ++i) {
      for (std::uint32_t c = 0; c < period.columns; ++c) {
        next_[tile[i].number % period.rows][c] += stride(tile[i], lays[i], c);
      }
    }
    start_groups();
    for (std::size_t i = 0; i < tile.size(); ++i) place(tile[i], lays[i]);
  }
  std::vector<std::uint32_t> particle_at() && { return std::move(particle_at_); }

 private:
  /// The number of slots that the row has in the group of columns c.
  std::uint32_t stride(const Row& row, const Lay& lay, std::uint32_t c) const {
    if (!lay.dense) return (lay.width + period_.columns - 1 - c) / period_.columns;
    std::uint32_t count = 0;
    for (std::size_t i = row.first; i < row.last; ++i) count += column_class(i) == c ? 1 : 0;
    return count;
  }

  std::uint32_t column(std::size_t i) const {
    return static_cast<std::uint32_t>(cells_[rows_.particles[i]].column);
  }
  std::uint32_t column_class(std::size_t i) const { return column(i) % period_.columns; }

  /// Replaces the sizes of groups by their first slots. A run may end anywhere in a group and is
  /// padded to whole lanes, so that each group is followed by enough padding slots. The size of a
  /// tile is no multiple of a cache way: otherwise rows at the same place in successive tiles,
  /// which yarns visit together, would fall into the same sets of the cache.
  void start_groups() {
    std::uint32_t slots = 0;
    for (auto& row : next_) {
      for (std::uint32_t& group : row) {
        const std::uint32_t size = group;
        group = slots;
        if (size > 0) slots += kernels::round_up(size, kLanes) + kLanes;
      }
    }
    constexpr std::uint32_t kSlotsOfCacheWay = 256;  // 4 KB of quads
    if (slots % kSlotsOfCacheWay == 0) slots += kLanes;
    particle_at_.assign(slots, kNoIndex);
  }

  void place(const Row& row, const Lay& lay) {
    auto& groups = next_[row.number % period_.rows];
    std::array<std::uint32_t, kLargestPeriod> used{};
    for (std::size_t i = row.first; i < row.last; ++i) {
      const std::uint32_t c = column_class(i);
      const std::uint32_t k = lay.dense ? used[c]++ : (column(i) - lay.origin) / period_.columns;
      particle_at_[groups[c] + k] = rows_.particles[i];
    }
    for (std::uint32_t c = 0; c < period_.columns; ++c) groups[c] += stride(row, lay, c);
  }

  const Rows& rows_;
  std::span<const Cell> cells_;
  Steps::Period period_;
  Groups next_{};
  std::vector<std::uint32_t> particle_at_;
};

/// Particles without a link stand behind the others, and change nothing about their order.
void append_lone(const std::vector<bool>& is_joined, Placement& placement) {
  if (placement.tiles.empty() && !is_joined.empty()) placement.tiles.emplace_back();
  for (std::uint32_t p = 0; p < is_joined.size(); ++p) {
    if (!is_joined[p]) placement.tiles.back().push_back(p);
  }
}

}  // namespace

std::uint32_t tile_count(std::size_t particles, std::uint32_t tile_particles) {
  constexpr std::size_t kWorthTwo = 1000;
  const std::size_t size = std::max(tile_particles, kLanes);
  const std::size_t least = particles >= kWorthTwo ? 2 : 1;
  const std::size_t count = std::max((particles + size - 1) / size, least);
  return static_cast<std::uint32_t>(count > 1 ? count + count % 2 : count);
}

Placement place_woven(std::span<const Cell> cells, std::span<const Link> links,
                      std::uint32_t tile_particles) {
  Placement placement;
  placement.has_runs = true;
  const Steps steps(cells, links);
  for (const Link& link : links) placement.colour_class.push_back(steps.colour_class(link));
  const Steps::Period period = steps.period();
  const std::vector<bool> is_joined = joined_by(links, cells.size());
  const Rows rows = list_rows(cells, is_joined, tile_particles, period.columns);
  const std::vector<std::size_t> begin =
      cut(rows, tile_count(rows.particles.size(), tile_particles));
  for (std::size_t t = 0; t + 1 < begin.size(); ++t) {
    const std::span<const Row> tile(rows.rows.data() + begin[t], begin[t + 1] - begin[t]);
    placement.tiles.push_back(TileLayout(rows, tile, cells, period).particle_at());
  }
  append_lone(is_joined, placement);
  return placement;
}

}  // namespace weft
