#include "engine/c_interface/pressure_structs.h"

#include "engine/c_interface/arrays.h"
#include "engine/c_interface/parts.h"
#include "engine/c_interface/structs.h"

namespace weft::c_interface {
namespace {

Result<Pressure> read_pressure(const std::string& name, const weft_pressure* pressure) {
  const auto read = read_struct(name, pressure, pressure_of({}));
  if (!read) return Error{read.error()};
  const weft_pressure& p = read.value();
  Arrays in;
  const auto triangles =
      in.needed<std::uint32_t>(name + ".triangles", p.triangles, p.triangle_count);
  if (!in.are_good()) return in.error();
  Pressure part{.triangles = list_of(triangles)};
  read_part(p, part);
  return part;
}

}  // namespace

weft_pressure pressure_of(const Pressure& part) {
  weft_pressure out{};
  out.size = sizeof out;
  out.triangle_count = part.triangles.size();
  out.triangles = part.triangles.data();
  write_part(part, out);
  return out;
}

Result<std::vector<Pressure>> read_pressures(std::size_t count, const weft_pressure* pressures) {
  std::vector<Pressure> list;
  if (count == 0) return list;
  if (auto r = check_struct("pressures[0]", pressures); !r) return Error{r.error()};
  const auto* bytes = reinterpret_cast<const std::byte*>(pressures);
  for (std::size_t i = 0; i < count; ++i) {
    const std::string name = "pressures[" + std::to_string(i) + "]";
    const auto* one = reinterpret_cast<const weft_pressure*>(bytes + i * pressures->size);
    if (one->size != pressures->size) {
      return Error{name + ".size: must be that of pressures[0] (" + std::to_string(one->size) +
                   ")"};
    }
    auto part = read_pressure(name, one);
    if (!part) return Error{part.error()};
    list.push_back(std::move(part).value());
  }
  return list;
}

}  // namespace weft::c_interface
