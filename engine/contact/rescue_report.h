/// The failures that verification has found, and their outcome.
#pragma once

namespace weft {

struct RescueReport {
  int failures = 0;  // pairs that were caught
  int zones = 0;     // those of them that impacts did not stop
  int left = 0;      // triangles of the cloth that cross in the end, and particles inside
  int tangled = 0;   // pairs of triangles of the cloth that cross each other
  bool is_tangled_anew = false;  // in a frame that began without these
};

}  // namespace weft
