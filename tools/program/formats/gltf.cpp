#include "tools/program/formats/gltf.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <numbers>
#include <span>
#include <type_traits>

#include "tools/program/files/json_output.h"

namespace weft::tools {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

constexpr int kFloat = 5126, kUnsigned = 5125;      // component types
constexpr int kVertices = 34962, kIndices = 34963;  // targets of buffer views
constexpr int kPlain = 0;                           // a buffer view without a target
constexpr int kLines = 1, kTriangles = 4;           // modes

/// Numbers behind each other, and how the JSON finds them.
class Buffer {
 public:
  template <class Number>
  int add(std::span<const Number> numbers, const char* type, std::size_t count, int target) {
    Json view{{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", numbers.size_bytes()}};
    if (target != kPlain) view["target"] = target;
    views_.push_back(std::move(view));
    bytes_.append(reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes());
    accessors_.push_back({{"bufferView", views_.size() - 1},
                          {"componentType", std::is_same_v<Number, float> ? kFloat : kUnsigned},
                          {"count", count},
                          {"type", type}});
    return static_cast<int>(accessors_.size()) - 1;
  }
  int add_points(std::span<const float> numbers) {
    const int accessor = add(numbers, "VEC3", numbers.size() / 3, kVertices);
    bound(accessor, numbers, 3);
    return accessor;
  }
  /// The least and the largest of each component, as the format asks for.
  void bound(int accessor, std::span<const float> numbers, std::size_t components) {
    Json least = Json::array(), most = Json::array();
    for (std::size_t k = 0; k < components; ++k) {
      float low = numbers[k], high = numbers[k];
      for (std::size_t i = k; i < numbers.size(); i += components) {
        low = std::min(low, numbers[i]);
        high = std::max(high, numbers[i]);
      }
      least.push_back(low);
      most.push_back(high);
    }
    Json& entry = accessors_[static_cast<std::size_t>(accessor)];
    entry["min"] = std::move(least);
    entry["max"] = std::move(most);
  }
  void describe(Json& json) const {
    json["accessors"] = accessors_;
    json["bufferViews"] = views_;
    json["buffers"] = Json::array({Json{{"byteLength", bytes_.size()}}});
  }
  const std::string& bytes() const { return bytes_; }

 private:
  Json views_ = Json::array(), accessors_ = Json::array();
  std::string bytes_;
};

std::vector<std::uint32_t> corners_of(const Mesh& mesh) {
  std::vector<std::uint32_t> corners;
  for (const auto& triangle : triangles_of(mesh.faces))
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  return corners;
}

std::vector<std::uint32_t> line_ends_of(const Mesh& mesh) {
  std::vector<std::uint32_t> ends;
  for (const auto& line : mesh.lines) {
    for (std::size_t i = 1; i < line.size(); ++i) ends.insert(ends.end(), {line[i - 1], line[i]});
  }
  return ends;
}

/// At the time of a target its weight is 1, and all others are 0.
std::vector<float> weights_of(std::size_t samples) {
  const std::size_t targets = samples - 1;
  std::vector<float> weights(samples * targets);
  for (std::size_t t = 0; t < targets; ++t) weights[(t + 1) * targets + t] = 1;
  return weights;
}

void append_chunk(std::string& file, std::uint32_t kind, std::string content, char padding) {
  while (content.size() % 4 != 0) content += padding;
  for (const std::uint32_t number : {static_cast<std::uint32_t>(content.size()), kind})
    file.append(reinterpret_cast<const char*>(&number), sizeof number);
  file += content;
}

std::string glb_of(const std::string& json, const std::string& binary) {
  constexpr std::uint32_t kGltf = 0x46546c67, kVersion = 2, kJson = 0x4e4f534a,
                          kBinary = 0x004e4942;
  std::string chunks;
  append_chunk(chunks, kJson, json, ' ');
  append_chunk(chunks, kBinary, binary, '\0');
  std::string file;
  for (const std::uint32_t number :
       {kGltf, kVersion, static_cast<std::uint32_t>(12 + chunks.size())})
    file.append(reinterpret_cast<const char*>(&number), sizeof number);
  return file + chunks;
}

Json animation_of(Buffer& buffer, std::span<const float> times) {
  const int input = buffer.add(times, "SCALAR", times.size(), kPlain);
  buffer.bound(input, times, 1);
  const std::vector<float> weights = weights_of(times.size());
  const int output = buffer.add<float>(weights, "SCALAR", weights.size(), kPlain);
  Json animation{{"name", "motion"}};
  animation["samplers"] =
      Json::array({Json{{"input", input}, {"output", output}, {"interpolation", "LINEAR"}}});
  animation["channels"] =
      Json::array({Json{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}});
  return Json::array({std::move(animation)});
}

}  // namespace

void GltfMotion::add_sample(const std::vector<Vec3>& vertices, double seconds) {
  std::vector<float> numbers;
  numbers.reserve(3 * vertices.size());
  for (const auto& [x, y, z] : vertices) {
    for (const double coordinate : {x, y, z}) numbers.push_back(static_cast<float>(coordinate));
  }
  if (!samples_.empty()) {
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] -= samples_.front()[i];
  }
  times_.push_back(static_cast<float>(seconds));
  samples_.push_back(std::move(numbers));
}

Result<std::string> GltfMotion::bytes() const {
  constexpr std::size_t kMost = 0xf0000000;
  if (samples_.size() * samples_.front().size() * sizeof(float) > kMost)
    return Error{"a .glb file has no place for so many frames of so many vertices"};
  Buffer buffer;
  Json attributes{{"POSITION", buffer.add_points(samples_.front())}}, targets = Json::array();
  for (std::size_t t = 1; t < samples_.size(); ++t)
    targets.push_back({{"POSITION", buffer.add_points(samples_[t])}});
  Json primitives = Json::array();
  const auto add = [&](const std::vector<std::uint32_t>& indices, int mode) {
    if (indices.empty()) return;
    Json primitive{
        {"attributes", attributes},
        {"indices", buffer.add<std::uint32_t>(indices, "SCALAR", indices.size(), kIndices)},
        {"material", 0},
        {"mode", mode}};
    if (!targets.empty()) primitive["targets"] = targets;
    primitives.push_back(std::move(primitive));
  };
  add(corners_of(*mesh_), kTriangles);
  add(line_ends_of(*mesh_), kLines);
  Json json{{"asset", {{"version", "2.0"}, {"generator", "weft"}}}, {"scene", 0}};
  json["scenes"] = Json::array({Json{{"nodes", Json::array({0})}}});
  json["nodes"] = Json::array({Json{{"name", "cloth"}, {"mesh", 0}}});
  constexpr double kHalf = std::numbers::sqrt2 / 2;  // a quarter of a turn about x
  if (up_is_z_) json["nodes"][0]["rotation"] = {-kHalf, 0.0, 0.0, kHalf};
  json["meshes"] = Json::array({Json{{"name", "cloth"}, {"primitives", std::move(primitives)}}});
  json["materials"] = Json::array({Json{{"name", "cloth"}, {"doubleSided", true}}});
  json["materials"][0]["pbrMetallicRoughness"] = {{"baseColorFactor", {0.33, 0.07, 0.04, 1.0}},
                                                  {"metallicFactor", 0}};
  if (!targets.empty()) json["animations"] = animation_of(buffer, times_);
  buffer.describe(json);
  return glb_of(json.dump(), buffer.bytes());
}

}  // namespace weft::tools
