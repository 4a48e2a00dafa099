#include "engine/bodies/body_shape.h"

#include <utility>

#include "engine/saving/fields.h"

namespace weft {

void visit_fields(const std::shared_ptr<const BodyShape>& shape, ArchiveWriter& archive) {
  archive(shape != nullptr);
  if (shape != nullptr) archive(shape->description());
}

void visit_fields(std::shared_ptr<const BodyShape>& shape, ArchiveReader& archive) {
  bool is_there = false;
  archive(is_there);
  if (!is_there) return;
  ShapeDescription description;
  archive(description);
  if (!archive.is_good()) return;
  auto built = build_shape(description);
  if (!built) return archive.refuse();
  shape = std::move(built).value();
}

}  // namespace weft
