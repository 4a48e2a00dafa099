/// The files of --out. What is written follows from the ending, in any case of letters:
///   .obj   the last frame as a mesh (obj_mesh.h)
///   .pc2   the motion: the start and all frames (pc2_writer.h)
///   .glb   the same for glTF (gltf.h)
///   .pvd   the same for ParaView, a .vtu file for each frame beside it (vtk_series.h)
///   .html  a page that shows the motion in a browser (viewer/page.h)
///   .motion  what such a page shows, to make pages of (viewer/motion.h)
///   .json  the last state, as a scene to go on from (scene_file.h)
/// A name like frame_%04d.obj or state_%d.json is a file for the start, number 0, and one for each
/// frame.
#pragma once

#include <weft/weft.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/program/files/pending_file.h"
#include "tools/program/formats/gltf.h"
#include "tools/program/formats/pc2_writer.h"
#include "tools/program/options/scene_source.h"
#include "tools/program/run/vtk_series.h"
#include "tools/program/text/numbered_name.h"
#include "tools/program/viewer/motion.h"

namespace weft::tools {

class Outputs {
 public:
  /// Opens all files, so that a place that cannot be written is refused before the run. The source
  /// must outlive the outputs.
  static Result<Outputs> open(const std::vector<std::string>& paths, const SceneSource& source,
                              const std::shared_ptr<const Model>& model, const Settings& settings,
                              double dt);
  /// The state after a frame, counted from 1, so many seconds from the start.
  void add_frame(const Cloth& cloth, const StepReport& report, int frame, double elapsed);
  /// The last state, likewise.
  void add_last(const Cloth& cloth, double elapsed);
  /// Completes all files; until then none of them is under its name, but those of a series are.
  Result<void> finish();

 private:
  enum class Format { mesh, scene };
  struct Last {
    PendingFile file;
    Format format;
  };
  struct Shown {
    PendingFile file;
    bool is_page;
  };
  struct Series {
    NumberedName name;
    Format format;
  };
  explicit Outputs(const SceneSource& source) : source_(&source) {}
  Result<void> add(const std::string& path);
  Result<void> add_animated(const std::string& path);
  Result<void> add_vtk(const std::string& path);
  Result<void> add_shown(const std::string& path, bool is_page);
  Result<void> add_series(const NumberedName& name, Format format);
  Result<void> finish_shown();
  std::string text(Format format, const Cloth& cloth, double elapsed) const;

  const SceneSource* source_;
  std::vector<Pc2Writer> motions_;
  struct Animated {
    PendingFile file;
    GltfMotion motion;
  };
  std::vector<Animated> animated_;
  std::vector<VtkSeries> vtk_;
  std::vector<Shown> shown_;
  std::optional<MotionRecorder> recorder_;  ///< where something is shown
  std::vector<Last> lasts_;
  std::vector<Series> series_;
  Result<void> written_;  // of the series
};

}  // namespace weft::tools
