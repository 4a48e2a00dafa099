/// The file of --resume (SavedInput).
#include "tools/program/run/run_state.h"

#include <algorithm>

#include "tests/fuzz/checks.h"
#include "tests/fuzz/saved_cloths.h"

extern "C" int WEFT_FUZZ_TARGET(run_state)(const std::uint8_t* data, std::size_t size) {
  using namespace weft;
  using namespace weft::fuzz;
  if (size == 0) return 0;
  const SavedInput input = saved_input(data, size);
  const Bytes bytes = input.bytes([] { return tools::bytes_of({}); });
  const auto state = tools::parse_run_state(bytes);
  if (!state) return check_message(state.error()), 0;
  check(tools::bytes_of(state.value()) == bytes, "a state of a run is written as the same bytes");
  Cloth cloth = saved_cloth(input.kind);
  const auto loaded = cloth.load_state(state.value().cloth);
  if (!loaded) return check_message(loaded.error()), 0;
  note_accepted();
  use_loaded(cloth, input.kind);
  return 0;
}
