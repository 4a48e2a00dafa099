/// The files of --out. What is written follows from the ending, in any case of letters:
///   .obj   the last frame as a mesh (obj_mesh.h)
///   .pc2   the motion: the start and all frames (pc2_writer.h)
///   .json  the last state, as a scene to go on from (scene_file.h)
#pragma once

#include <weft/weft.h>

#include <string>
#include <vector>

#include "tools/pc2_writer.h"
#include "tools/pending_file.h"
#include "tools/scene_source.h"

namespace weft::tools {

class Outputs {
 public:
  /// Opens all files, so that a place that cannot be written is refused before the run. The source
  /// must outlive the outputs.
  static Result<Outputs> open(const std::vector<std::string>& paths, const SceneSource& source);
  /// The state after one more frame, and that after the last, so many seconds from the start.
  void add_frame(const Cloth& cloth);
  void add_last(const Cloth& cloth, double elapsed);
  /// Completes all files; until then none of them is under its name.
  Result<void> finish();

 private:
  explicit Outputs(const SceneSource& source) : source_(&source) {}
  Result<void> add(const std::string& path);

  const SceneSource* source_;
  std::vector<Pc2Writer> motions_;
  std::vector<PendingFile> meshes_;
  std::vector<PendingFile> scenes_;
};

}  // namespace weft::tools
