#include "engine/ordering/lattice.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "engine/geometry.h"

namespace weft {
namespace {

using mesh::dot;
using mesh::operator-;

/// The most frequent value, and how often it occurs. Among equally frequent values it is the
/// lowest. Sorts the values.
std::pair<std::int32_t, std::size_t> most_frequent(std::vector<std::int32_t>& values) {
  std::sort(values.begin(), values.end());
  std::pair<std::int32_t, std::size_t> best{0, 0};
  for (std::size_t i = 0; i < values.size();) {
    std::size_t end = i;
    while (end < values.size() && values[end] == values[i]) ++end;
    if (end - i > best.second) best = {values[i], end - i};
    i = end;
  }
  return best;
}

/// Rows are yarns of family 0, and columns are yarns of family 1. After a first row, the columns
/// that cross it are placed, then the rows that these cross, and so on. A yarn is aligned with the
/// majority of those of its particles that have a place already. If there is only one, the
/// direction of the neighbouring yarn decides which way the yarn points.
class Weaver {
 public:
  Weaver(std::span<const Vec3> positions, const WovenYarns& yarns)
      : positions_(positions), yarns_(yarns), cells_(positions.size()) {
    for (auto& crossing : crossings_) crossing.resize(positions.size());
    for (std::uint32_t i = 0; i < yarns.yarns.size(); ++i) {
      const Yarn& yarn = yarns.yarns[i];
      if (yarn.family > 1) continue;
      const auto particles = yarns.particles_of(yarn);
      for (std::uint32_t k = 0; k < particles.size(); ++k) {
        crossings_[yarn.family][particles[k]] = {i, k};
      }
    }
    direction_.assign(yarns.yarns.size(), 0);
    place_all();
  }

  std::vector<Cell> cells() && { return std::move(cells_); }

 private:
  struct Crossing {
    std::uint32_t yarn = kNoIndex, index = 0;
  };

  void place_all() {
    for (const std::uint32_t family : {0u, 1u}) {
      for (std::uint32_t i = 0; i < yarns_.yarns.size(); ++i) {
        if (yarns_.yarns[i].family != family || direction_[i] != 0) continue;
        enqueue(i, 1);
        spread();
        ++part_;
      }
    }
    for (Cell& cell : cells_) {
      if (cell.part == kNoIndex) cell.part = part_++;
    }
  }

  void enqueue(std::uint32_t yarn, int direction) {
    direction_[yarn] = direction;
    queue_.push_back(yarn);
  }

  void spread() {
    for (std::size_t next = 0; next < queue_.size(); ++next) {
      place(queue_[next]);
      enqueue_crossing(queue_[next]);
    }
    queue_.clear();
  }

  /// Gives the particles of a yarn the coordinate direction * index + shift along it; the
  /// coordinate across it is constant.
  void place(std::uint32_t i) {
    const Yarn& yarn = yarns_.yarns[i];
    const auto particles = yarns_.particles_of(yarn);
    const bool is_row = yarn.family == 0;
    values_.clear();
    for (const std::uint32_t p : particles) {
      if (placed(p)) values_.push_back(is_row ? cells_[p].row : cells_[p].column);
    }
    const std::int32_t across = most_frequent(values_).first;
    const auto forward = votes(yarn, across, 1);
    const auto backward = votes(yarn, across, -1);
    int& direction = direction_[i];
    if (forward.second > backward.second) direction = 1;
    if (forward.second < backward.second) direction = -1;
    const std::int32_t shift = direction > 0 ? forward.first : backward.first;
    for (std::uint32_t k = 0; k < particles.size(); ++k) {
      if (placed(particles[k])) continue;
      const std::int32_t along = direction * static_cast<std::int32_t>(k) + shift;
      cells_[particles[k]] = {part_, is_row ? across : along, is_row ? along : across};
    }
  }

  /// The shift on which most of the placed particles agree, and the number of these particles.
  std::pair<std::int32_t, std::size_t> votes(const Yarn& yarn, std::int32_t across, int direction) {
    const auto particles = yarns_.particles_of(yarn);
    values_.clear();
    for (std::uint32_t k = 0; k < particles.size(); ++k) {
      const Cell& cell = cells_[particles[k]];
      if (cell.part != part_) continue;
      const bool is_row = yarn.family == 0;
      if ((is_row ? cell.row : cell.column) != across) continue;
      values_.push_back((is_row ? cell.column : cell.row) -
                        direction * static_cast<std::int32_t>(k));
    }
    return most_frequent(values_);
  }

  void enqueue_crossing(std::uint32_t i) {
    const Yarn& yarn = yarns_.yarns[i];
    const auto& crossings = crossings_[1 - yarn.family];
    Vec3 reference{};
    for (const std::uint32_t p : yarns_.particles_of(yarn)) {
      const Crossing& crossing = crossings[p];
      if (crossing.yarn == kNoIndex) continue;
      const Vec3 along = chord(crossing);
      if (direction_[crossing.yarn] == 0)
        enqueue(crossing.yarn, dot(along, reference) < 0 ? -1 : 1);
      reference = along;
      if (direction_[crossing.yarn] < 0) reference = Vec3{} - along;
    }
  }

  /// The vector from the previous particle of the yarn to the next.
  Vec3 chord(const Crossing& at) const {
    const Yarn& yarn = yarns_.yarns[at.yarn];
    const auto particles = yarns_.particles_of(yarn);
    const std::size_t count = particles.size(), last = count - 1;
    const std::size_t before = at.index > 0 ? at.index - 1 : yarn.closed ? last : 0;
    const std::size_t after = at.index < last ? at.index + 1 : yarn.closed ? 0 : last;
    return positions_[particles[after]] - positions_[particles[before]];
  }

  bool placed(std::uint32_t particle) const { return cells_[particle].part != kNoIndex; }

  std::span<const Vec3> positions_;
  const WovenYarns& yarns_;
  std::vector<Cell> cells_;
  std::vector<Crossing> crossings_[2];  // by family and particle
  std::vector<int> direction_;          // by yarn; 0: not reached yet
  std::vector<std::uint32_t> queue_;
  std::vector<std::int32_t> values_;
  std::uint32_t part_ = 0;
};

/// Where several particles have the same place, all but the first become parts of their own.
void separate(std::vector<Cell>& cells) {
  std::vector<std::pair<Cell, std::uint32_t>> sorted;
  sorted.reserve(cells.size());
  std::uint32_t parts = 0;
  for (std::uint32_t p = 0; p < cells.size(); ++p) {
    sorted.push_back({cells[p], p});
    parts = std::max(parts, cells[p].part + 1);
  }
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i].first == sorted[i - 1].first) cells[sorted[i].second] = {parts++, 0, 0};
  }
}

void start_at_zero(std::vector<Cell>& cells) {
  constexpr std::int32_t kLargest = std::numeric_limits<std::int32_t>::max();
  std::uint32_t parts = 0;
  for (const Cell& cell : cells) parts = std::max(parts, cell.part + 1);
  std::vector<Cell> least(parts, Cell{0, kLargest, kLargest});
  for (const Cell& cell : cells) {
    least[cell.part].row = std::min(least[cell.part].row, cell.row);
    least[cell.part].column = std::min(least[cell.part].column, cell.column);
  }
  for (Cell& cell : cells) {
    cell.row -= least[cell.part].row;
    cell.column -= least[cell.part].column;
  }
}

}  // namespace

std::vector<Cell> find_lattice(std::span<const Vec3> positions, const WovenYarns& yarns) {
  std::vector<Cell> cells = Weaver(positions, yarns).cells();
  separate(cells);
  start_at_zero(cells);
  return cells;
}

}  // namespace weft
