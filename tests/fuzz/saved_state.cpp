/// The bytes of a state. The first byte says of which cloth they are, and whether they come as they
/// are or as content that is sealed rightly.
#include "tests/fuzz/checks.h"
#include "tests/fuzz/saved_cloths.h"

namespace weft::fuzz {
namespace {

constexpr std::uint8_t kAsItIs = 0x80;

Bytes forged(const Cloth& cloth, std::span<const std::byte> content) {
  const Bytes saved = cloth.save_state();
  const auto fingerprint = std::span(saved).subspan(kSealSize, kFingerprintSize);
  return sealed_like(saved, joined(fingerprint, content));
}

}  // namespace
}  // namespace weft::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace weft;
  using namespace weft::fuzz;
  if (size == 0) return 0;
  const std::size_t kind = data[0] % kSavedCloths;
  const auto content = std::as_bytes(std::span(data + 1, size - 1));
  Cloth cloth = saved_cloth(kind);
  const Bytes before = cloth.save_state();
  const Bytes bytes =
      (data[0] & kAsItIs) != 0 ? Bytes(content.begin(), content.end()) : forged(cloth, content);
  if (const auto loaded = cloth.load_state(bytes); !loaded) {
    check_message(loaded.error());
    check(cloth.save_state() == before, "a state that is refused changes nothing");
    return 0;
  }
  note_accepted();
  use_loaded(cloth, kind);
  return 0;
}
