#include "engine/model/threads.h"

#include <algorithm>
#include <utility>

#include "engine/lists.h"
#include "engine/partition.h"

namespace weft {
namespace {

/// A link of two slots.
struct Side {
  std::uint32_t a = 0, b = 0;
  double length = 0;  // m, at rest
};

/// The pieces of a surface: triangles with a common corner are of one.
class SurfacePieces {
 public:
  explicit SurfacePieces(const Model& model) : joined_(model.slots()), is_in_(model.slots()) {
    for (const auto& triangle : model.surface) {
      for (const std::uint32_t corner : triangle) {
        is_in_[corner] = true;
        joined_.join(triangle[0], corner);
      }
    }
  }
  bool have_one(std::uint32_t a, std::uint32_t b) {
    return is_in_[a] && is_in_[b] && joined_.first(a) == joined_.first(b);
  }

 private:
  Partition joined_;
  std::vector<bool> is_in_;
};

/// Those whose ends are all fixed, too; not those that are broken.
std::vector<Side> constraints_of(const Model& model) {
  std::vector<Side> sides;
  const ConstraintStore& c = model.constraints;
  for (std::size_t i = 0; i < c.size(); ++i) sides.push_back({c.a[i], c.b[i], c.rest_length[i]});
  const auto& slot_of = model.ordering.slot_of;
  for (const auto& [described, inert] : model.inert.constraints) {
    if (inert.strength == 0) continue;
    sides.push_back({slot_of[inert.a], slot_of[inert.b], inert.rest_length});
  }
  return sides;
}

/// Leaves out those that are longer than two sides that lead from end to end.
void leave_out_braces(const Model& model, std::vector<Side> sides, std::vector<Side>& threads) {
  for (const auto& triangle : model.surface) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangle[k], b = triangle[(k + 1) % 3];
      sides.push_back({a, b, length(model.initial_position[a] - model.initial_position[b])});
    }
  }
  const Lists sides_at = make_lists(model.slots(), [&](auto&& add) {
    for (std::uint32_t i = 0; i < sides.size(); ++i) {
      add(sides[i].a, i);
      add(sides[i].b, i);
    }
  });
  const auto leads_over = [&](std::uint32_t from, std::uint32_t to, double within) {
    return std::ranges::any_of(sides_at[from], [&](std::uint32_t i) {
      const Side& first = sides[i];
      const std::uint32_t middle = first.a == from ? first.b : first.a;
      if (middle == to || !(first.length < within)) return false;
      return std::ranges::any_of(sides_at[middle], [&](std::uint32_t j) {
        const Side& second = sides[j];
        return (second.a == to || second.b == to) && second.length < within;
      });
    });
  };
  std::erase_if(threads, [&](const Side& s) { return leads_over(s.a, s.b, s.length); });
}

}  // namespace

std::vector<std::array<std::uint32_t, 2>> find_threads(const Model& model) {
  SurfacePieces pieces(model);
  const std::vector<Side> sides = constraints_of(model);
  std::vector<Side> threads = sides;
  std::erase_if(threads, [&](const Side& side) { return pieces.have_one(side.a, side.b); });
  if (!threads.empty()) leave_out_braces(model, sides, threads);
  std::vector<std::array<std::uint32_t, 2>> ends;
  for (const Side& thread : threads) ends.push_back({thread.a, thread.b});
  return ends;
}

std::vector<std::array<std::uint32_t, 2>> threads_of(const Model& model) {
  std::vector<std::array<std::uint32_t, 2>> threads = find_threads(model);
  for (auto& thread : threads) {
    for (std::uint32_t& end : thread) end = model.ordering.particle_at[end];
  }
  return threads;
}

}  // namespace weft
