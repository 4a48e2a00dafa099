#include "tools/program/formats/pin_rule.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>

#include "tools/program/text/parse.h"

namespace weft::tools {
namespace {

/// Of each vertex, whether a rule is about it.
using Chosen = std::vector<bool>;
using Test = std::function<bool(const Vec3&)>;

constexpr double Vec3::*kAxisOfLetter[] = {&Vec3::x, &Vec3::y, &Vec3::z};

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// The parts between words like " and ".
std::vector<std::string_view> parts_of(std::string_view text, std::string_view word) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t found = text.find(word);
    parts.push_back(without_blanks(text.substr(0, found)));
    if (found == std::string_view::npos) return parts;
    text.remove_prefix(found + word.size());
  }
}

/// "y>0.9": one axis, one comparison, one number.
std::optional<Test> comparison(std::string_view rule) {
  if (rule.size() < 3 || rule[0] < 'x' || rule[0] > 'z') return std::nullopt;
  const auto axis = kAxisOfLetter[rule[0] - 'x'];
  const bool greater = rule[1] == '>';
  const bool or_equal = rule[2] == '=';
  const auto bound = parse_number(rule.substr(or_equal ? 3 : 2));
  if ((!greater && rule[1] != '<') || !bound) return std::nullopt;
  return [=](const Vec3& v) {
    const double value = v.*axis;
    return (greater ? value > *bound : value < *bound) || (or_equal && value == *bound);
  };
}

/// Those of a face or a line.
std::vector<bool> used_vertices(const Mesh& mesh) {
  std::vector<bool> used(mesh.vertices.size());
  for (const auto* parts : {&mesh.faces, &mesh.lines}) {
    for (const auto& part : *parts) {
      for (const std::uint32_t vertex : part) used[vertex] = true;
    }
  }
  return used;
}

/// What rules choose from.
class Vertices {
 public:
  Vertices(const Mesh& mesh, double Vec3::*up) : mesh_(mesh), up_(up), used_(used_vertices(mesh)) {}
  std::size_t count() const { return used_.size(); }
  bool is_used(std::size_t vertex) const { return vertex < count() && used_[vertex]; }
  Chosen matching(const Test& matches) const {
    Chosen chosen(count());
    for (std::size_t vertex = 0; vertex < count(); ++vertex)
      chosen[vertex] = used_[vertex] && matches(mesh_.vertices[vertex]);
    return chosen;
  }
  Chosen top() const {
    constexpr double kFractionOfHeight = 1e-3;
    double highest = -std::numeric_limits<double>::infinity();
    double lowest = std::numeric_limits<double>::infinity();
    for (std::size_t vertex = 0; vertex < count(); ++vertex) {
      if (!used_[vertex]) continue;
      highest = std::max(highest, mesh_.vertices[vertex].*up_);
      lowest = std::min(lowest, mesh_.vertices[vertex].*up_);
    }
    const double bound = highest - kFractionOfHeight * (highest - lowest);
    return matching([&](const Vec3& v) { return v.*up_ >= bound; });
  }

 private:
  const Mesh& mesh_;
  double Vec3::*up_;
  std::vector<bool> used_;
};

Error unreadable(std::string_view rule) {
  return Error{
      fmt::format("--pin: '{}' is not none, top, a comparison like y>0.9, or vertex "
                  "numbers like 0,5,7-9, nor several of them joined by and, or",
                  rule)};
}

Result<Chosen> listed(std::string_view rule, const Vertices& vertices) {
  const auto ranges = parse_ranges(rule);
  if (!ranges) return unreadable(rule);
  Chosen chosen(vertices.count());
  for (const NumberRange& range : *ranges) {
    if (range.last < range.first) return unreadable(rule);
    for (long long vertex = range.first; vertex <= range.last; ++vertex) {
      const auto number = static_cast<std::size_t>(vertex);
      if (!vertices.is_used(number)) {
        return Error{fmt::format("--pin: '{}': no face has a vertex {}", rule, vertex)};
      }
      chosen[number] = true;
    }
  }
  return chosen;
}

Result<Chosen> chosen_by_one(std::string_view rule, const Vertices& vertices) {
  if (rule == "top") return vertices.top();
  if (const auto test = comparison(rule)) return vertices.matching(*test);
  return listed(rule, vertices);
}

/// "top and x<0.2"
Result<Chosen> chosen_by_all(std::string_view rules, const Vertices& vertices) {
  Chosen chosen(vertices.count(), true);
  for (const std::string_view rule : parts_of(rules, " and ")) {
    const auto by_one = chosen_by_one(rule, vertices);
    if (!by_one) return by_one;
    for (std::size_t i = 0; i < chosen.size(); ++i) chosen[i] = chosen[i] && by_one.value()[i];
  }
  return chosen;
}

Result<Chosen> chosen_by_any(std::string_view rule, const Vertices& vertices) {
  Chosen chosen(vertices.count());
  for (const std::string_view rules : parts_of(rule, " or ")) {
    const auto by_all = chosen_by_all(rules, vertices);
    if (!by_all) return by_all;
    for (std::size_t i = 0; i < chosen.size(); ++i) chosen[i] = chosen[i] || by_all.value()[i];
  }
  return chosen;
}

}  // namespace

Result<std::vector<std::uint32_t>> pinned_vertices(std::string_view rule, const Mesh& mesh,
                                                   double Vec3::*up) {
  if (rule == "none") return std::vector<std::uint32_t>{};
  const auto chosen = chosen_by_any(rule, Vertices(mesh, up));
  if (!chosen) return Error{chosen.error()};
  std::vector<std::uint32_t> pinned;
  for (std::uint32_t vertex = 0; vertex < mesh.vertices.size(); ++vertex) {
    if (chosen.value()[vertex]) pinned.push_back(vertex);
  }
  if (pinned.empty()) return Error{fmt::format("--pin: '{}' matches no vertex", rule)};
  return pinned;
}

}  // namespace weft::tools
