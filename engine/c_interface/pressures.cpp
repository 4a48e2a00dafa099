#include "engine/c_interface/handles.h"
#include "engine/c_interface/pressure_structs.h"
#include "engine/c_interface/structs.h"

using namespace weft::c_interface;

weft_result weft_init_pressure(weft_pressure* pressure, size_t size) {
  return init_struct("pressure", pressure_of({}), pressure, size);
}

weft_result weft_set_pressure(weft_cloth* cloth, double pressure) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}}); !r) return r;
    return cloth->cloth.set_pressure(pressure);
  });
}

weft_result weft_set_pressures(weft_cloth* cloth, size_t count, const weft_pressure* pressures) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}}); !r) return r;
    const auto read = read_pressures(count, pressures);
    if (!read) return weft::Error{read.error()};
    return cloth->cloth.set_pressure(read.value());
  });
}

weft_result weft_read_pressures(const weft_cloth* cloth, size_t count, double* pressures,
                                double* volumes) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}}); !r) return r;
    const std::vector<weft::PressureNow> now = cloth->cloth.pressures();
    if (count != now.size()) {
      return weft::Error{"count: the cloth has " + std::to_string(now.size()) + " pressures (" +
                         std::to_string(count) + ")"};
    }
    if (count == 0) return {};
    if (auto r = given({{"pressures", pressures}}); !r) return r;
    for (std::size_t i = 0; i < count; ++i) {
      pressures[i] = now[i].pressure;
      if (volumes != nullptr) volumes[i] = now[i].volume;
    }
    return {};
  });
}
