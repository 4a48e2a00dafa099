/// Shapes of bodies, prepared for contacts.
#pragma once

#include <weft/body.h>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "engine/bodies/body_moments.h"
#include "engine/bodies/mesh_shape.h"
#include "engine/gaps.h"
#include "engine/saving/archive.h"
#include "kernels/reference/forms.h"

namespace weft {

/// Where a form is, in coordinates of the body.
struct FormBounds {
  /// Balls of the radius around these hold all of it; where it has no end, all that has one.
  std::vector<kernels::Vector> corners{};
  double radius = 0;  // m
  /// By as many thicknesses a thickness makes it reach beyond that: faces that are moved out meet
  /// far beyond a sharp edge.
  double spread = 1;
  bool has_end = true;
};

/// The parts of a shape that is no mesh.
struct ShapeParts {
  std::unique_ptr<const reference::Form> form{};
  FormBounds bounds{};
  /// At a density of 1; of what has no volume none.
  std::optional<BodyMoments> moments{};
  /// The surface that it is for cloth whose gaps it fits through; null: it fits through none.
  std::unique_ptr<const MeshShape> thin{};
  Widths widths{};
};

/// A shape in coordinates of the body: a closed form or a mesh.
class BodyShape {
 public:
  explicit BodyShape(ShapeParts parts) : parts_(std::move(parts)) {}
  explicit BodyShape(MeshShape mesh) : mesh_(std::make_unique<const MeshShape>(std::move(mesh))) {}
  BodyShape(const BodyShape&) = delete;
  BodyShape& operator=(const BodyShape&) = delete;

  /// Null: it is none, but form().
  const MeshShape* mesh() const { return mesh_.get(); }
  /// Null: it is a mesh.
  const reference::Form* form() const { return parts_.form.get(); }
  const FormBounds& bounds() const { return parts_.bounds; }
  const std::optional<BodyMoments>& moments() const { return parts_.moments; }
  const MeshShape* thin() const { return parts_.thin.get(); }
  const Widths& widths() const { return parts_.widths; }
  /// The shape that it was built of.
  const ShapeDescription& description() const { return description_; }
  void describe(const ShapeDescription& description) { description_ = description; }

 private:
  ShapeParts parts_;
  std::unique_ptr<const MeshShape> mesh_;
  ShapeDescription description_;
};

using BuiltShape = Result<std::shared_ptr<BodyShape>>;

/// Null, or what the shape was built of.
void visit_fields(const std::shared_ptr<const BodyShape>& shape, ArchiveWriter& archive);
/// Builds it again. A shape that cannot be built is refused.
void visit_fields(std::shared_ptr<const BodyShape>& shape, ArchiveReader& archive);

}  // namespace weft
