/// Scenes, models and saved bytes in C.
#include "engine/c_interface/arrays.h"
#include "engine/c_interface/handles.h"
#include "engine/c_interface/parts.h"
#include "engine/c_interface/structs.h"

namespace weft::c_interface {
namespace {

weft_model_info info_of(const ModelInfo& info) {
  weft_model_info out{};
  out.size = sizeof out;
  write_part(info, out);
  return out;
}

}  // namespace
}  // namespace weft::c_interface

using namespace weft::c_interface;

weft_result weft_init_scene(weft_scene* scene, size_t size) {
  return init_struct("scene", default_scene(), scene, size);
}

weft_result weft_init_model_info(weft_model_info* info, size_t size) {
  return init_struct("info", info_of({}), info, size);
}

weft_result weft_build_model(const weft_scene* scene, weft_model** out) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"out", out}}); !r) return r;
    const auto description = read_scene(scene);
    if (!description) return weft::Error{description.error()};
    return hand_over(weft::build_model(description.value()), out);
  });
}

weft_result weft_describe(const weft_model* model, weft_model_info* info) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"model", model}}); !r) return r;
    if (auto r = check_struct("info", info); !r) return r;
    write_struct(info_of(weft::describe(*model->model)), info);
    return {};
  });
}

weft_result weft_save_model(const weft_model* model, weft_bytes** out) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"model", model}, {"out", out}}); !r) return r;
    *out = new weft_bytes{weft::save_model(*model->model)};
    return {};
  });
}

weft_result weft_load_model(const void* bytes, size_t size, weft_model** out) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"bytes", bytes}, {"out", out}}); !r) return r;
    return hand_over(weft::load_model({static_cast<const std::byte*>(bytes), size}), out);
  });
}

void weft_free_model(weft_model* model) { delete model; }
void weft_free_bytes(weft_bytes* bytes) { delete bytes; }

const void* weft_bytes_data(const weft_bytes* bytes) {
  return ask("bytes", bytes, [&]() -> const void* { return bytes->bytes.data(); });
}

size_t weft_bytes_size(const weft_bytes* bytes) {
  return ask("bytes", bytes, [&] { return bytes->bytes.size(); });
}
