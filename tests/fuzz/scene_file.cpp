/// The text of a scene file. What is accepted is written and read again, built, and stepped.
#include "tools/program/formats/scene_file.h"

#include "engine/saving/fields.h"
#include "tests/fuzz/checks.h"
#include "tests/fuzz/stepping.h"
#include "tools/scenes/anchor_moves.h"
#include "tools/scenes/body_moves.h"
#include "tools/scenes/events.h"

namespace weft::fuzz {
namespace {

using tools::SceneFile;

constexpr const char* kNoFolder = "/nowhere";

std::string scene_text_of(const SceneFile& file) {
  return tools::scene_text(file.description, file.moves, file.faces, file.bodies, file.events,
                           file.rest_scale);
}

std::vector<std::byte> bits_of(const SceneDescription& scene) {
  ArchiveWriter archive;
  archive(scene);
  return std::move(archive).bytes();
}

void check_survives_writing(const SceneFile& file) {
  const std::string text = scene_text_of(file);
  const auto again = tools::parse_scene(text, kNoFolder);
  check(static_cast<bool>(again), again ? "" : again.error());
  check(bits_of(again.value().description) == bits_of(file.description),
        "a description survives writing and reading again");
  check(scene_text_of(again.value()) == text, "what is read again is written alike");
}

void run(const SceneFile& file, Cloth& cloth) {
  const auto bodies = tools::MovedBodies::add(file.bodies, cloth);
  if (!bodies) return check_message(bodies.error());
  tools::MovedPins pins(file.moves, cloth);
  const tools::MovedAnchors anchors(file.moves, cloth);
  tools::Events events(file.events);
  tools::GrowingRest rest(file.rest_scale, cloth);
  for (const auto& done :
       {rest.grow(cloth, 0.1), pins.place(cloth), events.happen(0.1, cloth, pins),
        pins.send(cloth, 0.1), anchors.send(cloth, 0.1), bodies.value().send(cloth, 0.1)}) {
    if (!done) check_message(done.error());
  }
  step_twice(cloth);
  const SceneDescription present = tools::present_scene(file.description, cloth);
  std::vector<tools::SceneBody> present_bodies = tools::present_bodies(file.bodies, 0.1);
  tools::take_free_bodies(cloth, present_bodies);
  const SceneFile later{present,
                        tools::present_moves(file.moves, file.description, 0.1),
                        file.faces,
                        present_bodies,
                        tools::present_events(file.events, 0.1),
                        tools::present_scale(file.rest_scale, 0.1)};
  const auto read = tools::parse_scene(scene_text_of(later), kNoFolder);
  check(static_cast<bool>(read), read ? "" : read.error());
}

}  // namespace
}  // namespace weft::fuzz

extern "C" int WEFT_FUZZ_TARGET(scene_file)(const std::uint8_t* data, std::size_t size) {
  using namespace weft;
  using namespace weft::fuzz;
  const auto file = tools::parse_scene(fuzz::text_of(data, size), kNoFolder);
  if (!file) return check_message(file.error()), 0;
  const auto model = build_model(file.value().description);
  if (!model) return check_message(model.error()), 0;
  check_survives_writing(file.value());
  auto cloth = Cloth::create(model.value(), brief_settings());
  if (!cloth) return check_message(cloth.error()), 0;
  note_accepted();
  run(file.value(), cloth.value());
  return 0;
}
