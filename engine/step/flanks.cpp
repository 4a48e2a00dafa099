#include "engine/step/flanks.h"

#include <algorithm>
#include <span>

#include "engine/contact/leads_through.h"
#include "engine/lists.h"

namespace weft {
namespace flanks {
namespace {

using Triangle = TriangleSurface::Triangle;

/// Broken seams behind all others: numbers of the others stay when one of these goes.
std::size_t first_of_flanks(const SeamStore& seams) {
  std::size_t first = seams.size();
  while (first > 0 && seams.is_broken(first - 1)) --first;
  return first;
}

class Parting {
 public:
  explicit Parting(const State& s)
      : model_(*s.model),
        x_(s.position),
        surface_(model_.touched_surface()),
        is_apart_(model_.seams.size()) {}

  std::vector<std::uint32_t> run() {
    const SeamStore& seams = model_.seams;
    std::vector<std::uint32_t> apart;
    for (std::size_t i = first_of_flanks(seams); i < seams.size(); ++i) {
      if (!are_far(seams.a[i], seams.b[i]) || !parts(static_cast<std::uint32_t>(i))) continue;
      is_apart_[i] = true;
      apart.push_back(static_cast<std::uint32_t>(i));
    }
    return apart;
  }

 private:
  bool are_far(std::uint32_t a, std::uint32_t b) const {
    return length(x_[a] - x_[b]) > model_.self_contact.thickness;
  }
  /// Whether all that it alone joins is apart.
  bool parts(std::uint32_t seam) {
    const std::vector<std::uint32_t> one = joined_to(model_.seams.a[seam], seam),
                                     other = joined_to(model_.seams.b[seam], seam);
    if (std::ranges::find(one, other[0]) != one.end()) return true;
    return std::ranges::all_of(one, [&](std::uint32_t a) {
      return std::ranges::all_of(
          other, [&](std::uint32_t b) { return are_far(a, b) && !do_stars_cross(a, b); });
    });
  }
  /// The point, and all that other seams join to it.
  std::vector<std::uint32_t> joined_to(std::uint32_t point, std::uint32_t without) {
    if (seams_at_.begin.empty()) list_seams();
    std::vector<std::uint32_t> joined{point};
    for (std::size_t n = 0; n < joined.size(); ++n) {
      for (const std::uint32_t seam : seams_at_[joined[n]]) {
        if (seam == without || is_apart_[seam]) continue;
        const std::uint32_t next =
            model_.seams.a[seam] == joined[n] ? model_.seams.b[seam] : model_.seams.a[seam];
        if (std::ranges::find(joined, next) == joined.end()) joined.push_back(next);
      }
    }
    return joined;
  }
  void list_seams() {
    seams_at_ = make_lists(model_.slots(), [&](auto&& add) {
      for (std::uint32_t i = 0; i < model_.seams.size(); ++i) {
        add(model_.seams.a[i], i);
        add(model_.seams.b[i], i);
      }
    });
  }

  bool do_stars_cross(std::uint32_t a, std::uint32_t b) const {
    return std::ranges::any_of(surface_.triangles_at[a], [&](std::uint32_t one) {
      return std::ranges::any_of(surface_.triangles_at[b], [&](std::uint32_t other) {
        return leads_through(one, other) || leads_through(other, one);
      });
    });
  }
  /// Whether a side of one leads through the other one.
  bool leads_through(std::uint32_t one, std::uint32_t other) const {
    if (!surface_.is_face(other)) return false;
    const Triangle& t = surface_.triangles[other];
    const Corners corners{x_[t[0]], x_[t[1]], x_[t[2]]};
    for (const std::uint32_t edge : surface_.edges_of[one]) {
      const auto [p, q] = surface_.edges[edge];
      const bool touches = std::ranges::find(t, p) != t.end() || std::ranges::find(t, q) != t.end();
      if (!touches && weft::leads_through(x_[p], x_[q], corners, 0)) return true;
    }
    return false;
  }

  const Model& model_;
  const kernels::Vectors& x_;
  const TriangleSurface& surface_;
  std::vector<bool> is_apart_;
  Lists seams_at_;  // per slot
};

}  // namespace
}  // namespace flanks

bool has_flanks(const Model& model) {
  return model.self_contact.on && model.seams.size() > 0 &&
         model.seams.is_broken(model.seams.size() - 1);
}

std::vector<std::uint32_t> flanks_apart(const State& state) {
  if (!has_flanks(*state.model)) return {};
  return flanks::Parting(state).run();
}

}  // namespace weft
