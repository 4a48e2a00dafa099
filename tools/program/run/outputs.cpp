#include "tools/program/run/outputs.h"

#include <fmt/format.h>

#include "engine/model/model.h"
#include "tools/program/formats/obj_mesh.h"
#include "tools/program/formats/scene_file.h"
#include "tools/program/text/file_ending.h"
#include "tools/program/viewer/page.h"
#include "tools/scenes/body_moves.h"

namespace weft::tools {

Result<Outputs> Outputs::open(const std::vector<std::string>& paths, const SceneSource& source,
                              const std::shared_ptr<const Model>& model, const Settings& settings,
                              double dt) {
  Outputs outputs(source);
  for (const std::string& path : paths) {
    if (auto added = outputs.add(path); !added) {
      return Error{fmt::format("--out: {}", added.error())};
    }
  }
  if (!outputs.shown_.empty()) outputs.recorder_.emplace(source, model, settings, dt);
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
  if (ending == ".glb") return add_animated(path);
  if (ending == ".pvd") return add_vtk(path);
  if (ending == ".html" || ending == ".motion") return add_shown(path, ending == ".html");
  if (ending != ".obj" && ending != ".json") {
    return Error{
        fmt::format("'{}' does not end in .obj, .pc2, .glb, .pvd, .html, .motion or .json", path)};
  }
  const Format format = ending == ".obj" ? Format::mesh : Format::scene;
  if (const auto name = NumberedName::of(path)) return add_series(*name, format);
  auto file = PendingFile::open(path);
  if (!file) return Error{file.error()};
  lasts_.push_back({std::move(file.value()), format});
  return {};
}

Result<void> Outputs::add_animated(const std::string& path) {
  auto file = PendingFile::open(path);
  if (!file) return Error{file.error()};
  animated_.push_back({std::move(file.value()), {source_->mesh, source_->up == &Vec3::z}});
  animated_.back().motion.add_sample(source_->mesh.vertices, 0);
  return {};
}

Result<void> Outputs::add_vtk(const std::string& path) {
  auto series = VtkSeries::open(path, *source_);
  if (!series) return Error{series.error()};
  vtk_.push_back(std::move(series.value()));
  return {};
}

Result<void> Outputs::add_shown(const std::string& path, bool is_page) {
  auto file = PendingFile::open(path);
  if (!file) return Error{file.error()};
  shown_.push_back({std::move(file.value()), is_page});
  return {};
}

Result<void> Outputs::add_series(const NumberedName& name, Format format) {
  series_.push_back({name, format});
  const SceneDescription& scene = source_->description;
  return write_file(name.with(0),
                    format == Format::mesh
                        ? obj_text(source_->mesh, scene, scene.positions)
                        : scene_text(scene, source_->moves, particle_faces(source_->mesh),
                                     source_->bodies, source_->events, source_->rest_scale));
}

std::string Outputs::text(Format format, const Cloth& cloth, double elapsed) const {
  const SceneDescription& scene = source_->description;
  if (format == Format::mesh) return obj_text(source_->mesh, scene, particle_positions(cloth));
  RestScale rest_scale = present_scale(source_->rest_scale, elapsed);
  if (cloth.model()->tears > 0)  // the scene is as torn, and has its present shape at rest
    rest_scale = scale_over(rest_scale, scale_at(source_->rest_scale, elapsed));
  std::vector<SceneBody> bodies = present_bodies(source_->bodies, elapsed);
  take_free_bodies(cloth, bodies);
  return scene_text(present_scene(scene, cloth), present_moves(source_->moves, scene, elapsed),
                    particle_faces(source_->mesh), bodies, present_events(source_->events, elapsed),
                    rest_scale);
}

void Outputs::add_frame(const Cloth& cloth, const StepReport& report, int frame, double elapsed) {
  if (recorder_) recorder_->add_frame(cloth, report, elapsed);
  for (const Series& series : series_) {
    if (!written_) break;
    written_ = write_file(series.name.with(frame), text(series.format, cloth, elapsed));
  }
  for (VtkSeries& series : vtk_) series.add_frame(cloth, elapsed);
  if (motions_.empty() && animated_.empty()) return;
  const std::vector<Vec3> points = vertex_positions(source_->mesh, particle_positions(cloth));
  for (Pc2Writer& motion : motions_) motion.add_sample(points);
  for (Animated& animated : animated_) animated.motion.add_sample(points, elapsed);
}

void Outputs::add_last(const Cloth& cloth, double elapsed) {
  for (const Last& last : lasts_) last.file.write(text(last.format, cloth, elapsed));
}

Result<void> Outputs::finish_shown() {
  if (!recorder_) return {};
  const std::string motion = recorder_->bytes();
  for (Shown& shown : shown_) {
    shown.file.write(shown.is_page ? page_of({&motion, 1}) : motion);
    if (auto committed = shown.file.commit(); !committed) return committed;
  }
  return {};
}

Result<void> Outputs::finish() {
  if (!written_) return written_;
  for (Pc2Writer& motion : motions_) {
    if (auto finished = motion.finish(); !finished) return finished;
  }
  if (auto finished = finish_shown(); !finished) return finished;
  for (Animated& animated : animated_) {
    const auto bytes = animated.motion.bytes();
    if (!bytes) return Error{bytes.error()};
    animated.file.write(bytes.value());
    if (auto committed = animated.file.commit(); !committed) return committed;
  }
  for (VtkSeries& series : vtk_) {
    if (auto finished = series.finish(); !finished) return finished;
  }
  for (Last& last : lasts_) {
    if (auto committed = last.file.commit(); !committed) return committed;
  }
  return {};
}

}  // namespace weft::tools
