/// What a scene file says of fabric: triangles of it, bending elements, damping, air, pressures,
/// anchors and seams.
#pragma once

#include <weft/weft.h>

#include <string>

#include "tools/program/files/json_output.h"

namespace weft::tools {

/// These throw Refused (json_reading.h).
ConstraintKind read_kind(const Json& json, const std::string& place);
MembraneElement read_membrane(const Json& json, const std::string& place);
BendingElement read_bending(const Json& json, const std::string& place);
Damping read_damping(const Json& json, const std::string& place);
Air read_air(const Json& json, const std::string& place);
/// A cloth that says so touches itself, unless "on" is false.
SelfContact read_self_contact(const Json& json, const std::string& place);
Pressure read_pressure(const Json& json, const std::string& place);
Anchor read_anchor(const Json& json, const std::string& place);
Seam read_seam(const Json& json, const std::string& place);

std::string membrane_row(const MembraneElement& element);
std::string bending_row(const BendingElement& element);
std::string anchor_row(const Anchor& anchor);
std::string pressure_row(const Pressure& part);
std::string seam_row(const Seam& seam);
/// Whether they differ from what a description has by itself.
bool has_damping(const Damping& damping);
bool has_air(const Air& air);
std::string damping_text(const Damping& damping);
std::string air_text(const Air& air);
std::string self_contact_text(const SelfContact& contact);

}  // namespace weft::tools
