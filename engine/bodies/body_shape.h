/// Shapes of bodies, prepared for contacts.
#pragma once

#include <weft/body.h>

#include <memory>
#include <utility>
#include <vector>

#include "engine/bodies/mesh_shape.h"
#include "engine/gaps.h"
#include "engine/saving/archive.h"
#include "kernels/reference/bodies.h"

namespace weft {

/// A shape in coordinates of the body: a plane, or the inside of several, or a capsule, or a mesh.
class BodyShape {
 public:
  BodyShape(std::vector<reference::Face> faces, std::vector<kernels::Vector> corners)
      : faces_(std::move(faces)),
        corners_(std::move(corners)),
        spread_(spread_of(faces_, corners_)) {
    solid_.faces = faces_;
  }
  explicit BodyShape(const reference::Solid& capsule);
  explicit BodyShape(MeshShape mesh) : mesh_(std::make_unique<const MeshShape>(std::move(mesh))) {}
  BodyShape(const BodyShape&) = delete;
  BodyShape& operator=(const BodyShape&) = delete;

  /// Null: it is none, but solid().
  const MeshShape* mesh() const { return mesh_.get(); }
  /// The surface that solid() is for cloth whose gaps it fits through; null: it is none.
  const MeshShape* thin() const { return thin_.get(); }
  const Widths& widths() const { return widths_; }
  void set_thin(MeshShape thin, const Widths& widths) {
    thin_ = std::make_unique<const MeshShape>(std::move(thin));
    widths_ = widths;
  }
  /// The shape that it was built of.
  const ShapeDescription& description() const { return description_; }
  void describe(const ShapeDescription& description) { description_ = description; }

  const reference::Solid& solid() const { return solid_; }
  /// A plane reaches to infinity.
  bool is_bounded() const { return !corners_.empty(); }
  /// Balls of radius() around these hold all of it.
  const std::vector<kernels::Vector>& corners() const { return corners_; }
  double radius() const { return radius_; }
  /// By as many thicknesses a thickness makes it reach beyond that: faces that are moved out meet
  /// far beyond a sharp edge.
  double spread() const { return spread_; }

 private:
  static double spread_of(const std::vector<reference::Face>& faces,
                          const std::vector<kernels::Vector>& corners);

  std::vector<reference::Face> faces_;
  std::vector<kernels::Vector> corners_;
  double radius_ = 0;
  double spread_ = 1;
  reference::Solid solid_;
  std::unique_ptr<const MeshShape> mesh_, thin_;
  Widths widths_;
  ShapeDescription description_;
};

/// Null, or what the shape was built of.
void visit_fields(const std::shared_ptr<const BodyShape>& shape, ArchiveWriter& archive);
/// Builds it again. A shape that cannot be built is refused.
void visit_fields(std::shared_ptr<const BodyShape>& shape, ArchiveReader& archive);

}  // namespace weft
