#include "engine/saving/sealed.h"

#include <algorithm>

#include "engine/saving/archive.h"
#include "engine/validation.h"

namespace weft {
namespace {

struct Seal {
  std::array<char, 8> mark{};
  std::uint32_t version = 0;
  std::uint64_t size = 0, checksum = 0;
};
constexpr std::size_t kSealSize = 8 + 4 + 8 + 8;

void visit_fields(Is<Seal> auto& seal, auto& archive) {
  auto& [mark, version, size, checksum] = seal;
  archive(mark, version, size, checksum);
}

}  // namespace

/// Each round maps different hashes to different ones, and different words likewise, so that one
/// word that is another one is another hash in the end.
std::uint64_t checksum(std::span<const std::byte> bytes) {
  constexpr std::uint64_t kPrime = 0x9e3779b97f4a7c15u;
  std::uint64_t hash = bytes.size();
  for (std::size_t i = 0; i < bytes.size(); i += 8) {
    std::uint64_t word = 0;
    if (bytes.size() - i >= 8) {
      ArchiveReader(bytes.subspan(i, 8))(word);
    } else {
      for (std::size_t k = i; k < bytes.size(); ++k)
        word |= std::to_integer<std::uint64_t>(bytes[k]) << (8 * (k - i));
    }
    hash = (hash ^ word) * kPrime;
    hash ^= hash >> 32;
  }
  return hash;
}

std::vector<std::byte> seal(const Kind& kind, std::span<const std::byte> content) {
  ArchiveWriter writer;
  writer(Seal{kind.mark, kind.version, content.size(), checksum(content)});
  std::vector<std::byte> bytes = std::move(writer).bytes();
  bytes.insert(bytes.end(), content.begin(), content.end());
  return bytes;
}

Result<std::span<const std::byte>> unseal(const Kind& kind, std::span<const std::byte> bytes) {
  const auto content = bytes.subspan(std::min(bytes.size(), kSealSize));
  Seal seal;
  ArchiveReader reader(bytes);
  reader(seal);
  if (!reader.is_good() || seal.mark != kind.mark)
    return refuse(kind.name, "is not one of weft's", std::to_string(bytes.size()) + " bytes");
  if (seal.version != kind.version) {
    return refuse(kind.name, "this library reads version " + std::to_string(kind.version),
                  "version " + std::to_string(seal.version));
  }
  if (seal.size != content.size()) {
    return refuse(kind.name, "must have " + std::to_string(seal.size) + " bytes of content",
                  std::to_string(content.size()));
  }
  if (seal.checksum != checksum(content))
    return refuse(kind.name, "is damaged, its checksum is another one",
                  std::to_string(bytes.size()) + " bytes");
  return content;
}

}  // namespace weft
