/// Bodies of the hard cases, and how deep particles are in them: by signed distances of their own.
#pragma once

#include <weft/body.h>

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "tools/studies/hard/oracle.h"

namespace weft::tools::hard {

/// The half spaces whose common part is a body, or a segment of balls; of a mesh nothing.
class Solid {
 public:
  explicit Solid(const ShapeDescription& shape);
  /// m, over the surface at a distance of `thickness`; negative: inside. y in coordinates of the
  /// body.
  double gap(Vec3 y, double thickness) const;

 private:
  struct HalfSpace {
    Vec3 normal{};
    double offset = 0;
  };
  std::vector<HalfSpace> halves_;  // empty: a capsule
  Capsule capsule_;
};

/// A body on its way.
struct TrialBody {
  TrialBody(const ShapeDescription& shape, double friction, std::function<Pose(double)> pose);

  Solid solid;
  std::optional<TriangleMesh> mesh;  ///< in place of the solid
  /// Where its vertices are, if they move; of a mesh.
  std::function<std::vector<Vec3>(double time)> vertices = {};
  std::shared_ptr<const BodyShape> shape;
  double thickness = 1e-3;  ///< m
  double yields = 0;        ///< m of it, to a body with which it shares the room between them
  double friction = 0.3;
  std::function<Pose(double time)> pose;
  int appears = 0;  ///< before this step
};

/// y such that the pose takes it to x.
Vec3 in_body(const Pose& pose, Vec3 x);

/// Not of meshes: m, the deepest that a particle which is free is under the surface at what is left
/// of the thickness.
double max_penetration(const SceneDescription& scene, const Snapshot& state, const TrialBody& body,
                       const Pose& pose);
/// Whether the straight way of a particle, as the body sees it, begins and ends outside and leads
/// through what is deeper than `depth`.
bool went_through(const Snapshot& before, const Snapshot& after, const TrialBody& body,
                  const Pose& from, const Pose& to, double depth);

}  // namespace weft::tools::hard
