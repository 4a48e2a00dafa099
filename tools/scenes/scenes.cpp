#include "tools/scenes/scenes.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <utility>

namespace weft::scenes {
namespace {

constexpr int kLargestSize = 10'000;  // 10^8 particles

template <class Number>
std::string text(Number value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

template <class Number>
Error out_of_range(std::string_view option, std::string_view allowed, Number value) {
  return {std::string(option) + " must be " + std::string(allowed) + ", not " + text(value)};
}

Result<void> check_size(const BuiltIn& scene, int size) {
  if (size >= scene.smallest_size && size <= kLargestSize) return {};
  return refused("size", "from " + text(scene.smallest_size) + " to " + text(kLargestSize), size);
}

Result<Scene> make_checked(const BuiltIn& scene, const Options& options) {
  if (const auto checked = check_size(scene, options.size); !checked) return Error{checked.error()};
  Options all = options;
  if (scene.is_fabric && !all.material) all.material = find_material(kFabric).value();
  return scene.make(all);
}

std::string names() {
  std::string all;
  for (const BuiltIn& scene : list()) all += (all.empty() ? "" : ", ") + std::string(scene.name);
  return all;
}

}  // namespace

Error refused(std::string_view option, std::string_view allowed, double value) {
  return out_of_range(option, allowed, value);
}
Error refused(std::string_view option, std::string_view allowed, int value) {
  return out_of_range(option, allowed, value);
}

Result<void> check_mass(std::string_view option, double mass) {
  if (std::isfinite(mass) && mass > 0) return {};
  return refused(option, "positive and finite", mass);
}

const BuiltIn* find(std::string_view name) {
  const auto found = std::ranges::find(list(), name, &BuiltIn::name);
  return found == list().end() ? nullptr : &*found;
}

Result<Scene> make_scene(std::string_view name, const Options& options) {
  const BuiltIn* const scene = find(name);
  if (scene == nullptr)
    return Error{"unknown scene '" + std::string(name) + "'; known: " + names()};
  auto made = make_checked(*scene, options);
  if (!made) return Error{std::string(name) + ": " + made.error()};
  return made;
}

Result<SceneDescription> make(std::string_view name, const Options& options) {
  auto scene = make_scene(name, options);
  if (!scene) return Error{scene.error()};
  return std::move(scene.value().description);
}

}  // namespace weft::scenes
