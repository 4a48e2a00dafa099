/// weft_report has the fields of StepReport, in the same order. So each field is written behind the
/// one before it, where a C compiler puts it.
#include "engine/c_interface/report.h"

#include <weft/report_fields.h>

#include <cstddef>
#include <cstring>
#include <type_traits>

namespace weft::c_interface {
namespace {

/// The type that C has for a field: int in place of bool and enumerations.
template <class T>
using InC = std::conditional_t<std::is_same_v<T, bool> || std::is_enum_v<T>, int, T>;
static_assert(sizeof(ContactMs) == sizeof(weft_contact_ms));

constexpr std::size_t aligned(std::size_t offset, std::size_t to) {
  return (offset + to - 1) / to * to;
}

/// Walks along a struct of C.
class Places {
 public:
  /// Where the next field is, of this type.
  template <class T>
  constexpr std::size_t next() {
    const std::size_t place = aligned(end_, alignof(T));
    end_ = place + sizeof(T);
    return place;
  }
  constexpr std::size_t end() const { return aligned(end_, alignof(weft_report)); }

 private:
  std::size_t end_ = sizeof(weft_report::size);
};

template <class T>
InC<T> in_c(const T& value) {
  if constexpr (std::is_same_v<T, InC<T>>)
    return value;
  else
    return static_cast<int>(value);
}

constexpr std::size_t size_of_all() {
  Places places;
  for_each_report_field([&]<class T>(const ReportField<T>&) { places.next<InC<T>>(); });
  return places.end();
}

static_assert(size_of_all() == sizeof(weft_report));

}  // namespace

weft_report report_of(const StepReport& report) {
  weft_report out{};
  out.size = sizeof out;
  Places places;
  for_each_report_field([&]<class T>(const ReportField<T>& field) {
    const InC<T> value = in_c(report.*field.member);
    std::memcpy(reinterpret_cast<std::byte*>(&out) + places.next<InC<T>>(), &value, sizeof value);
  });
  return out;
}

}  // namespace weft::c_interface
