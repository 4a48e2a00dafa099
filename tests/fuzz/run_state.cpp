/// The file of --resume. The first byte says of which cloth it is, and whether the bytes come as
/// they are or as content that is sealed rightly.
#include "tools/run_state.h"

#include <algorithm>

#include "tests/fuzz/checks.h"
#include "tests/fuzz/saved_cloths.h"

namespace weft::fuzz {
namespace {

constexpr std::uint8_t kAsItIs = 0x80;

}  // namespace
}  // namespace weft::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace weft;
  using namespace weft::fuzz;
  if (size == 0) return 0;
  const auto content = std::as_bytes(std::span(data + 1, size - 1));
  const Bytes bytes = (data[0] & kAsItIs) != 0 ? Bytes(content.begin(), content.end())
                                               : sealed_like(tools::bytes_of({}), content);
  const auto state = tools::parse_run_state(bytes);
  if (!state) return check_message(state.error()), 0;
  check(tools::bytes_of(state.value()) == bytes, "a state of a run is written as the same bytes");
  const std::size_t kind = data[0] % kSavedCloths;
  Cloth cloth = saved_cloth(kind);
  const auto loaded = cloth.load_state(state.value().cloth);
  if (!loaded) return check_message(loaded.error()), 0;
  note_accepted();
  use_loaded(cloth, kind);
  return 0;
}
