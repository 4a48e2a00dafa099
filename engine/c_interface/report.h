/// The report of a step as C has it.
#pragma once

#include <weft/cloth.h>
#include <weft/weft_c.h>

namespace weft::c_interface {

weft_report report_of(const StepReport& report);

}  // namespace weft::c_interface
