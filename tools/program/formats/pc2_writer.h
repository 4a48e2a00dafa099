/// Point Cache 2: the motion of a mesh's vertices, as Blender's Mesh Cache modifier, 3ds Max and
/// others read it. All numbers are little-endian:
///
///   offset  type        value
///   0       char[12]    "POINTCACHE2\0"
///   12      int32       version, 1
///   16      int32       points: vertices per sample
///   20      float32     number of the first frame, 0
///   24      float32     frames per sample, 1
///   28      int32       samples
///   32      float32[3]  x y z of point 0 in sample 0, point 1, ...; then sample 1, ...
///
/// Sample 0 is the start and sample k the state after frame k. The points are the vertices of the
/// object "cloth" in the OBJ file that the same run writes, in its order. (Spheres are objects of
/// their own; in a scene of JSON their centres are vertices too, as all particles are.)
#pragma once

#include <weft/weft.h>

#include <span>
#include <string>

#include "tools/program/files/pending_file.h"

namespace weft::tools {

class Pc2Writer {
 public:
  static Result<Pc2Writer> open(const std::string& path);
  /// Streams one sample to the file. All samples have the same number of points.
  void add_sample(std::span<const Vec3> points);
  /// Completes the header; the file then appears under its name.
  Result<void> finish();

 private:
  explicit Pc2Writer(PendingFile file) : file_(std::move(file)) {}
  void write_header() const;

  PendingFile file_;
  std::int32_t points_ = 0;
  std::int32_t samples_ = 0;
};

}  // namespace weft::tools
