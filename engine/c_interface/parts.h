/// Parts of a scene in structs of C, field by field (weft/scene_fields.h); of their arrays nothing.
#pragma once

#include <weft/scene_fields.h>

#include <type_traits>

#include "engine/c_interface/arrays.h"

namespace weft::c_interface {

inline void read_value(double number, double& value) { value = number; }
inline void read_value(int number, bool& value) { value = number != 0; }
inline void read_value(const double (&numbers)[3], Vec3& value) { value = vector_of(numbers); }

inline void write_value(double value, double& number) { number = value; }
inline void write_value(std::size_t value, std::size_t& number) { number = value; }
inline void write_value(bool value, int& number) { number = value ? 1 : 0; }
inline void write_value(Vec3 value, double (&numbers)[3]) { write_vector(value, numbers); }

template <class Part, class Struct>
void read_part(const Struct& in, Part& part) {
  for_each_part_field<Part>([&]<class V, class InC>(const PartField<Part, V, InC>& field) {
    if constexpr (!std::is_null_pointer_v<InC>) read_value(in.*field.in_c, part.*field.member);
  });
}

template <class Part, class Struct>
void write_part(const Part& part, Struct& out) {
  for_each_part_field<Part>([&]<class V, class InC>(const PartField<Part, V, InC>& field) {
    if constexpr (!std::is_null_pointer_v<InC>) write_value(part.*field.member, out.*field.in_c);
  });
}

}  // namespace weft::c_interface
