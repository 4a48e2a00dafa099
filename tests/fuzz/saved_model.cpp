/// The bytes of a model (SavedInput).
#include "tests/fuzz/checks.h"
#include "tests/fuzz/saved_cloths.h"
#include "tests/fuzz/stepping.h"

namespace weft::fuzz {
namespace {

const Bytes& some_model() {
  static const Bytes bytes = save_model(*saved_cloth(0).model());
  return bytes;
}

}  // namespace
}  // namespace weft::fuzz

extern "C" int WEFT_FUZZ_TARGET(saved_model)(const std::uint8_t* data, std::size_t size) {
  using namespace weft;
  using namespace weft::fuzz;
  if (size == 0) return 0;
  const auto model = load_model(saved_input(data, size).bytes(some_model));
  if (!model) return check_message(model.error()), 0;
  const Bytes saved = save_model(*model.value());
  const auto again = load_model(saved);
  check(static_cast<bool>(again), "a model that was saved is loaded");
  check(save_model(*again.value()) == saved, "a model that is loaded is saved as the same bytes");
  auto cloth = Cloth::create(model.value(), brief_settings());
  if (!cloth) return check_message(cloth.error()), 0;
  note_accepted();
  step_twice(cloth.value());
  return 0;
}
