/// A run as one file that a picture can be made of: where the cloth and its bodies were in each
/// frame, how far the cloth was stretched, where it touched bodies, and the figures of each report.
///
/// A file is sealed (engine/saving/sealed.h): a mark, a version, the number of bytes and a
/// checksum, 28 bytes in all. The content is the number of bytes of a text (4 bytes,
/// little-endian), the text, and the sections that it lists. The text is JSON;
/// tools/viewer/README.md says what is in it.
#pragma once

#include <weft/weft.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tools/program/files/json_output.h"
#include "tools/program/measure/stretch.h"
#include "tools/program/options/scene_source.h"
#include "tools/program/viewer/moving_points.h"
#include "tools/program/viewer/shown_bodies.h"

namespace weft::tools {

/// Gathers a run. The samples are the start and the state after each frame.
class MotionRecorder {
 public:
  /// The source must outlive the recorder. Adds the start.
  MotionRecorder(const SceneSource& source, std::shared_ptr<const Model> model,
                 const Settings& settings, double dt);
  MotionRecorder(MotionRecorder&&) noexcept;
  ~MotionRecorder();
  /// `elapsed` seconds after the start.
  void add_frame(const Cloth& cloth, const StepReport& report, double elapsed);
  /// The file.
  std::string bytes();

 private:
  struct Figures;
  /// cloth: null at the start.
  void add_sample(const std::vector<Vec3>& particles, double elapsed, const Cloth* cloth);
  void add_particles(const std::vector<Vec3>& particles, const std::vector<double>& stretch);
  void take_splits(const Cloth& cloth);
  void add_kept();
  void add_stretch(const std::vector<double>& stretch);
  void add_contacts(const Cloth& cloth);
  Json header(Sections& sections) const;

  const SceneSource* source_;
  std::shared_ptr<const Model> model_;
  double dt_;
  Settings settings_;  ///< as they were chosen in the end
  Vec3 origin_;
  double quantum_;          ///< m
  double stretch_quantum_;  ///< as a share
  MovingPoints points_;     ///< the particles
  ShownBodies bodies_;
  StretchMeasure stretch_;
  std::vector<std::int32_t> last_stretch_;
  std::string stretch_bytes_, contact_bytes_;
  std::unique_ptr<Figures> figures_;

  /// Of cloth that may tear: a file has the particles and triangles of the end from the start on.
  /// Where a particle is not split yet, both are in one place.
  struct Sample {
    std::vector<Vec3> particles;
    std::vector<double> stretch;
  };
  std::vector<Sample> kept_;
  std::vector<std::uint32_t> split_from_;  ///< of each particle that the scene does not describe
  std::vector<std::array<std::uint32_t, 3>> surface_;  ///< as torn; empty: as the mesh has it
};

/// An error if the bytes are no such file, or damaged.
Result<void> check_motion(std::string_view bytes);

}  // namespace weft::tools
