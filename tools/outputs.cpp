#include "tools/outputs.h"

#include <fmt/format.h>

#include "tools/file_ending.h"
#include "tools/obj_mesh.h"
#include "tools/scene_file.h"

namespace weft::tools {

Result<Outputs> Outputs::open(const std::vector<std::string>& paths, const SceneSource& source) {
  Outputs outputs(source);
  for (const std::string& path : paths) {
    if (auto added = outputs.add(path); !added) {
      return Error{fmt::format("--out: {}", added.error())};
    }
  }
  return outputs;
}

Result<void> Outputs::add(const std::string& path) {
  const auto ending = file_ending(path);
  if (ending == ".pc2") {
    auto motion = Pc2Writer::open(path);
    if (!motion) return Error{motion.error()};
    motion.value().add_sample(source_->mesh.vertices);
    motions_.push_back(std::move(motion.value()));
    return {};
  }
  if (ending != ".obj" && ending != ".json") {
    return Error{fmt::format("'{}' does not end in .obj, .pc2 or .json", path)};
  }
  auto file = PendingFile::open(path);
  if (!file) return Error{file.error()};
  (ending == ".obj" ? meshes_ : scenes_).push_back(std::move(file.value()));
  return {};
}

void Outputs::add_frame(const Cloth& cloth) {
  if (motions_.empty()) return;
  const std::vector<Vec3> points = vertex_positions(source_->mesh, cloth);
  for (Pc2Writer& motion : motions_) motion.add_sample(points);
}

void Outputs::add_last(const Cloth& cloth, double elapsed) {
  for (const PendingFile& mesh : meshes_) {
    mesh.write(obj_text(source_->mesh, source_->description, cloth));
  }
  for (const PendingFile& scene : scenes_) {
    scene.write(scene_text(present_scene(source_->description, cloth),
                           present_moves(source_->moves, source_->description, elapsed)));
  }
}

Result<void> Outputs::finish() {
  for (Pc2Writer& motion : motions_) {
    if (auto finished = motion.finish(); !finished) return finished;
  }
  for (auto* files : {&meshes_, &scenes_}) {
    for (PendingFile& file : *files) {
      if (auto committed = file.commit(); !committed) return committed;
    }
  }
  return {};
}

}  // namespace weft::tools
