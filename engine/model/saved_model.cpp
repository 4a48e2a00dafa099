#include "engine/model/saved_model.h"

#include <weft/weft.h>

#include <utility>

#include "engine/model/change.h"
#include "engine/model/model.h"
#include "engine/saving/fields.h"
#include "engine/saving/sealed.h"
#include "engine/validation.h"

namespace weft {
namespace {

/// The version changes with whatever is written here, and so with each field of an element.
constexpr Kind kModel{
    {'w', 'e', 'f', 't', 'm', 'o', 'd', 'l'}, "model", kListedInScenes + kListedInElements};

}  // namespace

std::uint64_t fingerprint(const Model& model) {
  ArchiveWriter archive;
  archive(description_of(model), model.ordering.slot_of);
  return checksum(std::move(archive).bytes());
}

std::vector<std::byte> save_model(const Model& model) {
  ArchiveWriter archive;
  archive(description_of(model));
  return seal(kModel, std::move(archive).bytes());
}

Result<std::shared_ptr<const Model>> load_model(std::span<const std::byte> bytes) {
  const auto content = unseal(kModel, bytes);
  if (!content) return Error{content.error()};
  SceneDescription description;
  ArchiveReader archive(content.value());
  archive(description);
  if (!archive.is_done()) return refuse("model", "holds what cannot be", "content");
  return build_model(description);
}

}  // namespace weft
