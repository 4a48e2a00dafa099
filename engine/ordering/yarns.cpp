#include "engine/ordering/yarns.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/geometry.h"
#include "engine/ordering/incidence.h"
#include "engine/ordering/used_colours.h"

namespace weft {
namespace {

using mesh::dot;
using mesh::operator-;

constexpr double kLeastStraight = -0.5;   // a cosine: yarns turn by less than 60 degrees
constexpr double kUnevenness = 0.25;      // the weight of equal lengths against straightness
constexpr std::size_t kLargestKnot = 64;  // no yarn passes a particle with more links

struct Course {
  Vec3 direction;  // from a to b; zero if the ends coincide
  double length = 0;
};

std::vector<Course> courses_of(std::span<const Vec3> positions, std::span<const Link> links) {
  std::vector<Course> courses;
  courses.reserve(links.size());
  for (const Link& link : links) {
    const Vec3 d = positions[link.b] - positions[link.a];
    const double length = std::sqrt(dot(d, d));
    if (length > 0 && std::isfinite(length)) {
      courses.push_back({{d.x / length, d.y / length, d.z / length}, length});
    } else {
      courses.emplace_back();
    }
  }
  return courses;
}

/// The next links of the yarn beyond the ends a and b of a link, or kNoIndex.
struct Continuation {
  std::uint32_t at_a = kNoIndex, at_b = kNoIndex;
};

class Pairing {
 public:
  Pairing(std::span<const Vec3> positions, std::span<const Link> links, const Lists& incidence)
      : links_(links), courses_(courses_of(positions, links)), next_(links.size()) {
    for (std::uint32_t p = 0; p < incidence.size(); ++p) pair_up(p, incidence[p]);
  }
  std::uint32_t next(std::uint32_t link, std::uint32_t particle) const {
    return links_[link].a == particle ? next_[link].at_a : next_[link].at_b;
  }

 private:
  struct Candidate {
    double cost;  // low for straight pairs of similar length
    std::uint32_t one, two;
    auto operator<=>(const Candidate&) const = default;
  };

  /// Pairs up the links at a particle, the best pair first. Links that would turn too much are not
  /// paired.
  void pair_up(std::uint32_t particle, std::span<const std::uint32_t> links) {
    if (links.size() > kLargestKnot) return;
    candidates_.clear();
    for (std::size_t i = 0; i < links.size(); ++i) {
      for (std::size_t k = i + 1; k < links.size(); ++k) {
        const double cosine = dot(away(links[i], particle), away(links[k], particle));
        if (cosine < kLeastStraight)
          candidates_.push_back({cosine + unevenness(links[i], links[k]), links[i], links[k]});
      }
    }
    std::sort(candidates_.begin(), candidates_.end());
    for (const Candidate& candidate : candidates_) {
      std::uint32_t& one = slot(candidate.one, particle);
      std::uint32_t& two = slot(candidate.two, particle);
      if (one != kNoIndex || two != kNoIndex) continue;
      one = candidate.two;
      two = candidate.one;
    }
  }

  /// A measure of unequal lengths, which distinguishes a link to the neighbour from one that skips
  /// it.
  double unevenness(std::uint32_t one, std::uint32_t two) const {
    const auto [shorter, longer] = std::minmax(courses_[one].length, courses_[two].length);
    return kUnevenness * (1 - shorter / longer);
  }
  Vec3 away(std::uint32_t link, std::uint32_t particle) const {
    const Vec3& d = courses_[link].direction;
    return links_[link].a == particle ? d : Vec3{-d.x, -d.y, -d.z};
  }
  std::uint32_t& slot(std::uint32_t link, std::uint32_t particle) {
    return links_[link].a == particle ? next_[link].at_a : next_[link].at_b;
  }

  std::span<const Link> links_;
  std::vector<Course> courses_;
  std::vector<Continuation> next_;
  std::vector<Candidate> candidates_;
};

class Tracer {
 public:
  Tracer(std::span<const Link> links, std::size_t particles, const Pairing& pairing)
      : links_(links), pairing_(pairing), done_(links.size()), visited_by_(particles, kNoIndex) {}

  WovenYarns trace() {
    for (std::uint32_t i = 0; i < links_.size(); ++i) {
      if (!done_[i]) trace_from(first_of_chain(i));
    }
    return std::move(yarns_);
  }

 private:
  struct Start {
    std::uint32_t link, particle;  // the chain leaves the particle along the link
  };

  /// Goes back along the chain to its end, or once around if it is closed.
  Start first_of_chain(std::uint32_t start) const {
    std::uint32_t link = start, particle = links_[start].a;
    for (;;) {
      const std::uint32_t before = pairing_.next(link, particle);
      if (before == kNoIndex || done_[before] || before == start) return {link, particle};
      link = before;
      particle = other_end(links_[link], particle);
    }
  }

  void trace_from(Start at) {
    const std::uint32_t first = at.link;
    begin(at.particle);
    while (at.link != kNoIndex && !done_[at.link]) {
      const std::uint32_t to = other_end(links_[at.link], at.particle);
      const std::uint32_t next = pairing_.next(at.link, to);
      const bool closes =
          next == first && to == yarns_.particles[yarns_.yarns.back().first_particle];
      // A chain that meets itself continues as another yarn, which begins one link before the
      // meeting.
      if (visited_by_[to] == current() && !closes) {
        end(false);
        begin(at.particle);
      }
      done_[at.link] = true;
      yarns_.links.push_back(at.link);
      if (closes) return end(true);
      visit(to);
      at = {next, to};
    }
    end(false);
  }

  std::uint32_t current() const { return static_cast<std::uint32_t>(yarns_.yarns.size() - 1); }
  void visit(std::uint32_t particle) {
    visited_by_[particle] = current();
    yarns_.particles.push_back(particle);
  }
  void begin(std::uint32_t particle) {
    Yarn yarn;
    yarn.first_particle = static_cast<std::uint32_t>(yarns_.particles.size());
    yarn.first_link = static_cast<std::uint32_t>(yarns_.links.size());
    yarns_.yarns.push_back(yarn);
    visit(particle);
  }
  void end(bool closed) {
    Yarn& yarn = yarns_.yarns.back();
    yarn.last_particle = static_cast<std::uint32_t>(yarns_.particles.size());
    yarn.last_link = static_cast<std::uint32_t>(yarns_.links.size());
    yarn.closed = closed;
  }

  std::span<const Link> links_;
  const Pairing& pairing_;
  std::vector<bool> done_;
  std::vector<std::uint32_t> visited_by_;  // the last yarn through each particle
  WovenYarns yarns_;
};

/// The number of links divided by their mean square length. Bending links that skip every other
/// particle thus rank below the links over which they skip.
double rank(const WovenYarns& yarns, const Yarn& yarn, std::span<const Vec3> positions,
            std::span<const Link> links) {
  double squares = 0;
  for (const std::uint32_t link : yarns.links_of(yarn)) {
    const Vec3 d = positions[links[link].b] - positions[links[link].a];
    squares += dot(d, d);
  }
  const double count = yarn.last_link - yarn.first_link;
  const double rank = count * count / std::max(squares, std::numeric_limits<double>::min());
  return std::isfinite(rank) ? rank : 0;
}

void choose_families(std::span<const Vec3> positions, std::span<const Link> links,
                     WovenYarns& yarns) {
  std::vector<double> ranks;
  for (const Yarn& yarn : yarns.yarns) ranks.push_back(rank(yarns, yarn, positions, links));
  std::vector<std::uint32_t> by_rank(yarns.yarns.size());
  std::iota(by_rank.begin(), by_rank.end(), 0u);
  std::stable_sort(by_rank.begin(), by_rank.end(),
                   [&](std::uint32_t i, std::uint32_t k) { return ranks[i] > ranks[k]; });
  UsedColours used(positions.size());
  for (const std::uint32_t i : by_rank) {
    Yarn& yarn = yarns.yarns[i];
    yarn.family = used.lowest_free(yarns.particles_of(yarn));
    for (const std::uint32_t p : yarns.particles_of(yarn)) used.insert(p, yarn.family);
    yarns.families = std::max(yarns.families, yarn.family + 1);
  }
}

}  // namespace

WovenYarns find_yarns(std::span<const Vec3> positions, std::span<const Link> links) {
  const Lists incidence = links_at(positions.size(), links);
  const Pairing pairing(positions, links, incidence);
  WovenYarns yarns = Tracer(links, positions.size(), pairing).trace();
  choose_families(positions, links, yarns);
  return yarns;
}

}  // namespace weft
