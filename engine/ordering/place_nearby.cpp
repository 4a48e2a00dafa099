#include <algorithm>

#include "engine/ordering/placement.h"

namespace weft {
namespace {

/// Recursive bisection of the mesh into tiles. A cut follows the levels of a breadth-first search
/// that begins at a far end of the piece.
class Bisection {
 public:
  Bisection(const Lists& incidence, std::span<const Link> links)
      : incidence_(incidence), links_(links), piece_of_(incidence.size()) {
    for (std::uint32_t p = 0; p < incidence.size(); ++p) {
      if (!incidence[p].empty()) order_.push_back(p);
    }
  }
  std::size_t joined() const { return order_.size(); }

  std::vector<std::vector<std::uint32_t>> cut(std::uint32_t tiles) {
    struct Piece {
      std::size_t first, last;
      std::uint32_t tiles;
    };
    std::vector<std::vector<std::uint32_t>> result;
    std::vector<Piece> open{{0, order_.size(), tiles}};
    while (!open.empty()) {
      const Piece piece = open.back();
      open.pop_back();
      search(piece.first, piece.last);
      search(piece.first, piece.last);
      if (piece.tiles == 1) {
        result.emplace_back(at(piece.first), at(piece.last));
        continue;
      }
      const std::uint32_t half = piece.tiles / 2;
      const std::size_t middle = piece.first + (piece.last - piece.first) * half / piece.tiles;
      open.push_back({middle, piece.last, piece.tiles - half});
      open.push_back({piece.first, middle, half});
    }
    return result;
  }

 private:
  std::vector<std::uint32_t>::iterator at(std::size_t i) {
    return order_.begin() + static_cast<std::ptrdiff_t>(i);
  }

  /// Sorts a piece by a breadth-first search from its last particle, which is at a far end if the
  /// piece was in such an order before. Unconnected parts follow each other.
  void search(std::size_t first, std::size_t last) {
    const std::uint32_t piece = ++pieces_;  // marks those not found yet
    for (std::size_t i = first; i < last; ++i) piece_of_[order_[i]] = piece;
    found_.clear();
    std::size_t next = 0;
    for (std::size_t i = last; i-- > first;) {
      find(order_[i], piece);
      for (; next < found_.size(); ++next) {
        const std::uint32_t p = found_[next];
        for (const std::uint32_t link : incidence_[p]) find(other_end(links_[link], p), piece);
      }
    }
    std::copy(found_.begin(), found_.end(), at(first));
  }

  void find(std::uint32_t particle, std::uint32_t piece) {
    if (piece_of_[particle] != piece) return;
    piece_of_[particle] = 0;
    found_.push_back(particle);
  }

  const Lists& incidence_;
  std::span<const Link> links_;
  std::vector<std::uint32_t> order_, piece_of_, found_;
  std::uint32_t pieces_ = 0;
};

}  // namespace

Placement place_nearby(const Lists& incidence, std::span<const Link> links,
                       std::uint32_t tile_particles) {
  Placement placement;
  placement.colour_class.assign(links.size(), kNoIndex);
  if (incidence.size() == 0) return placement;
  Bisection bisection(incidence, links);
  placement.tiles = bisection.cut(tile_count(bisection.joined(), tile_particles));
  // Particles without a link stand behind the others, and change nothing about their order.
  for (std::uint32_t p = 0; p < incidence.size(); ++p) {
    if (incidence[p].empty()) placement.tiles.back().push_back(p);
  }
  return placement;
}

}  // namespace weft
