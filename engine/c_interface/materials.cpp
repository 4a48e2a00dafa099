#include "engine/c_interface/materials.h"

#include "engine/c_interface/structs.h"

namespace weft::c_interface {
namespace {

weft_material material_of(const Material& m) {
  return {.size = sizeof(weft_material),
          .density = m.density,
          .thickness = m.thickness,
          .warp = m.warp,
          .weft = m.weft,
          .shear = m.shear,
          .bending = m.bending,
          .damping_stretch = m.damping_stretch,
          .damping_bending = m.damping_bending,
          .damping_motion = m.damping_motion,
          .drag = m.drag,
          .lift = m.lift,
          .friction = m.friction,
          .ram = m.ram,
          .strength = m.strength,
          .bending_yield = m.bending_yield,
          .bending_hardening = m.bending_hardening,
          .bending_friction = m.bending_friction,
          .bending_slip = m.bending_slip};
}

}  // namespace

Result<Material> read_material(const weft_material* material) {
  const auto read = read_struct("material", material, material_of({}));
  if (!read) return Error{read.error()};
  const weft_material& m = read.value();
  return Material{.density = m.density,
                  .thickness = m.thickness,
                  .friction = m.friction,
                  .warp = m.warp,
                  .weft = m.weft,
                  .shear = m.shear,
                  .bending = m.bending,
                  .damping_stretch = m.damping_stretch,
                  .damping_bending = m.damping_bending,
                  .damping_motion = m.damping_motion,
                  .drag = m.drag,
                  .lift = m.lift,
                  .ram = m.ram,
                  .strength = m.strength,
                  .bending_yield = m.bending_yield,
                  .bending_hardening = m.bending_hardening,
                  .bending_friction = m.bending_friction,
                  .bending_slip = m.bending_slip};
}

}  // namespace weft::c_interface

using namespace weft::c_interface;

weft_result weft_init_material(weft_material* material, size_t size) {
  return init_struct("material", material_of({}), material, size);
}

weft_result weft_check_material(const weft_material* material) {
  return call([&]() -> weft::Result<void> {
    const auto read = read_material(material);
    if (!read) return weft::Error{read.error()};
    return weft::check_material(read.value());
  });
}

size_t weft_material_count(void) { return weft::materials().size(); }

const char* weft_material_name(size_t number) {
  return number < weft_material_count() ? weft::materials()[number].name.data() : nullptr;
}

const char* weft_material_source(size_t number) {
  return number < weft_material_count() ? weft::materials()[number].source.data() : nullptr;
}

weft_result weft_find_material(const char* name, weft_material* material) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"name", name}}); !r) return r;
    if (auto r = check_struct("material", material); !r) return r;
    const auto found = weft::find_material(name);
    if (!found) return weft::Error{found.error()};
    write_struct(material_of(found.value()), material);
    return {};
  });
}
