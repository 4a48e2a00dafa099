#include "tools/program/viewer/structure.h"

#include <vector>

#include "engine/model/model.h"
#include "engine/ordering/yarns.h"
#include "engine/solvers/small_steps/small_steps_layout.h"
#include "tools/program/measure/stretch.h"

namespace weft::tools {
namespace {

using LinkNumbers = std::vector<std::int32_t>;
constexpr std::int32_t kNoNumber = -1;

std::int32_t number(std::size_t value) { return static_cast<std::int32_t>(value); }

LinkNumbers link_colours(const SceneDescription& scene, const ConstraintStore& store) {
  LinkNumbers colours(scene.constraints.size(), kNoNumber);
  for (std::size_t i = 0; i < store.size(); ++i) {
    if (store.colour[i] != kNoIndex) colours[store.described[i]] = number(store.colour[i]);
  }
  return colours;
}

struct YarnNumbers {
  LinkNumbers yarns, families;
};

YarnNumbers link_yarns(const SceneDescription& scene,
                       std::span<const std::array<std::uint32_t, 4>> cells) {
  const std::vector<bool> is_diagonal = find_diagonals(scene.constraints, cells);
  std::vector<Link> links;
  std::vector<std::uint32_t> constraint;
  for (std::uint32_t i = 0; i < scene.constraints.size(); ++i) {
    if (is_diagonal[i]) continue;
    links.push_back({scene.constraints[i].a, scene.constraints[i].b});
    constraint.push_back(i);
  }
  YarnNumbers numbers{LinkNumbers(scene.constraints.size(), kNoNumber),
                      LinkNumbers(scene.constraints.size(), kNoNumber)};
  const WovenYarns woven = find_yarns(scene.positions, links);
  for (std::size_t y = 0; y < woven.yarns.size(); ++y) {
    for (const std::uint32_t link : woven.links_of(woven.yarns[y])) {
      numbers.yarns[constraint[link]] = number(y);
      numbers.families[constraint[link]] = number(woven.yarns[y].family);
    }
  }
  return numbers;
}

LinkNumbers fabric_colours(const SceneDescription& scene, const Model& model) {
  LinkNumbers colours(scene.membrane.size(), kNoNumber);
  if (model.membrane.size() == 0) return colours;
  const MembraneLayout& layout = model.small_steps().membrane;
  for (std::size_t batch = 0; batch < layout.batches.size(); ++batch) {
    const auto& [first, last, rope] = layout.batches[batch];
    for (std::size_t lane = first * kLanes; lane < last * kLanes; ++lane) {
      const std::uint32_t element = layout.element[lane];
      if (element != kNoIndex) colours[model.membrane.described[element]] = number(batch);
    }
  }
  return colours;
}

}  // namespace

void add_structure(Sections& sections, const SceneDescription& scene, const Model& model,
                   std::span<const std::array<std::uint32_t, 4>> cells) {
  LinkNumbers ends;
  for (const Constraint& c : scene.constraints) {
    ends.push_back(number(c.a));
    ends.push_back(number(c.b));
  }
  sections.add_numbers("link ends", ends);
  sections.add_numbers("link colours", link_colours(scene, model.constraints));
  const YarnNumbers yarns = link_yarns(scene, cells);
  sections.add_numbers("link yarns", yarns.yarns);
  sections.add_numbers("link families", yarns.families);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const MembraneElement& element : scene.membrane) triangles.push_back(element.particles);
  sections.add_triangles("fabric triangles", triangles);
  sections.add_numbers("fabric colours", fabric_colours(scene, model));
}

}  // namespace weft::tools
