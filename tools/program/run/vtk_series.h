/// A run for ParaView: a .vtu file for the start and each frame beside a .pvd file that lists them.
#pragma once

#include <weft/weft.h>

#include <string>
#include <utility>
#include <vector>

#include "tools/program/files/pending_file.h"
#include "tools/program/formats/vtu.h"
#include "tools/program/measure/stretch.h"
#include "tools/program/options/scene_source.h"

namespace weft::tools {

/// Points are all particles. Cells are the triangles of fabric, or else those of the faces, then
/// the constraints as lines. Numbers that something has not are NaN.
///
///   of points   velocity      m/s
///               stretch       as StretchMeasure
///   of cells    strain        of a constraint
///               tension       N, of a spring
///               warp_strain, weft_strain      of a triangle of fabric
///               warp_tension, weft_tension    N/m, likewise: the stiffness times the strain
///               shear         the cosine of the angle of warp and weft
class VtkSeries {
 public:
  /// "motion.pvd" has files "motion_0000.vtu", ... beside it. Writes that of the start.
  static Result<VtkSeries> open(const std::string& path, const SceneSource& source);
  void add_frame(const Cloth& cloth, double elapsed);
  /// Completes the list; it then appears under its name.
  Result<void> finish();

 private:
  VtkSeries(const std::string& path, const SceneSource& source, PendingFile list);
  void add_sample(const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities,
                  double elapsed);
  VtuGrid grid_at(const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities) const;

  std::string stem_;
  const SceneSource* source_;
  PendingFile list_;
  StretchMeasure stretch_;
  std::vector<std::pair<double, std::string>> files_;
  Result<void> written_;
};

}  // namespace weft::tools
