#include "tools/pin_rule.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <set>

#include "tools/parse.h"

namespace weft::tools {
namespace {

using Test = std::function<bool(const Vec3&)>;

/// "y>0.9": one axis, one comparison, one number.
std::optional<Test> comparison(std::string_view rule) {
  if (rule.size() < 3 || rule[0] < 'x' || rule[0] > 'z') return std::nullopt;
  constexpr double Vec3::*kAxes[] = {&Vec3::x, &Vec3::y, &Vec3::z};
  const auto axis = kAxes[rule[0] - 'x'];
  const bool greater = rule[1] == '>';
  const bool or_equal = rule[2] == '=';
  const auto bound = parse_number(rule.substr(or_equal ? 3 : 2));
  if ((!greater && rule[1] != '<') || !bound) return std::nullopt;
  return [=](const Vec3& v) {
    const double value = v.*axis;
    return (greater ? value > *bound : value < *bound) || (or_equal && value == *bound);
  };
}

Test near_top(const Mesh& mesh) {
  constexpr double kFractionOfHeight = 1e-3;
  double highest = -std::numeric_limits<double>::infinity();
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t vertex = 0; vertex < mesh.vertices.size(); ++vertex) {
    if (mesh.particle_of_vertex[vertex] == kNoIndex) continue;
    highest = std::max(highest, mesh.vertices[vertex].y);
    lowest = std::min(lowest, mesh.vertices[vertex].y);
  }
  return [bound = highest - kFractionOfHeight * (highest - lowest)](const Vec3& v) {
    return v.y >= bound;
  };
}

/// "7" or "7-9"; nothing if it is neither.
struct Range {
  long long first, last;
};
std::optional<Range> range(std::string_view text) {
  const std::size_t dash = text.find('-');
  const auto first = parse_count(text.substr(0, dash));
  const auto last = dash == std::string_view::npos ? first : parse_count(text.substr(dash + 1));
  if (!first || !last || *last < *first) return std::nullopt;
  return Range{*first, *last};
}

Error unreadable(std::string_view rule) {
  return Error{fmt::format(
      "--pin: '{}' is not none, top, a comparison like y>0.9, or vertex numbers like 0,5,7-9",
      rule)};
}

Result<std::set<std::uint32_t>> listed_particles(std::string_view rule, const Mesh& mesh) {
  std::set<std::uint32_t> particles;
  for (std::string_view rest = rule;;) {
    const std::size_t comma = rest.find(',');
    const auto numbers = range(rest.substr(0, comma));
    if (!numbers) return unreadable(rule);
    for (auto vertex = numbers->first; vertex <= numbers->last; ++vertex) {
      const auto number = static_cast<std::size_t>(vertex);
      if (number >= mesh.vertices.size() || mesh.particle_of_vertex[number] == kNoIndex) {
        return Error{fmt::format("--pin: '{}': no face has a vertex {}", rule, vertex)};
      }
      particles.insert(mesh.particle_of_vertex[number]);
    }
    if (comma == std::string_view::npos) return particles;
    rest.remove_prefix(comma + 1);
  }
}

Result<std::set<std::uint32_t>> matching_particles(std::string_view rule, const Mesh& mesh,
                                                   const Test& matches) {
  std::set<std::uint32_t> particles;
  for (std::size_t vertex = 0; vertex < mesh.vertices.size(); ++vertex) {
    const std::uint32_t particle = mesh.particle_of_vertex[vertex];
    if (particle != kNoIndex && matches(mesh.vertices[vertex])) particles.insert(particle);
  }
  if (particles.empty()) return Error{fmt::format("--pin: '{}' matches no vertex", rule)};
  return particles;
}

Result<std::set<std::uint32_t>> chosen_particles(std::string_view rule, const Mesh& mesh) {
  if (rule == "top") return matching_particles(rule, mesh, near_top(mesh));
  if (const auto test = comparison(rule)) return matching_particles(rule, mesh, *test);
  return listed_particles(rule, mesh);
}

}  // namespace

Result<std::vector<std::uint32_t>> pinned_particles(std::string_view rule, const Mesh& mesh) {
  if (rule == "none") return std::vector<std::uint32_t>{};
  const auto chosen = chosen_particles(rule, mesh);
  if (!chosen) return Error{chosen.error()};
  return std::vector<std::uint32_t>(chosen.value().begin(), chosen.value().end());
}

}  // namespace weft::tools
