/// The bytes of a state (SavedInput). Content comes without the fingerprint of its model.
#include "tests/fuzz/checks.h"
#include "tests/fuzz/saved_cloths.h"

namespace weft::fuzz {
namespace {

Bytes with_fingerprint(std::span<const std::byte> saved, std::span<const std::byte> content) {
  return joined(saved.subspan(kSealSize, kFingerprintSize), content);
}

}  // namespace
}  // namespace weft::fuzz

extern "C" int WEFT_FUZZ_TARGET(saved_state)(const std::uint8_t* data, std::size_t size) {
  using namespace weft;
  using namespace weft::fuzz;
  if (size == 0) return 0;
  SavedInput input = saved_input(data, size);
  Cloth cloth = saved_cloth(input.kind);
  const Bytes before = cloth.save_state();
  const Bytes content = with_fingerprint(before, input.rest);
  if (!input.is_whole) input.rest = content;
  const Bytes bytes = input.bytes([&] { return before; });
  if (const auto loaded = cloth.load_state(bytes); !loaded) {
    check_message(loaded.error());
    check(cloth.save_state() == before, "a state that is refused changes nothing");
    return 0;
  }
  note_accepted();
  use_loaded(cloth, input.kind);
  return 0;
}
