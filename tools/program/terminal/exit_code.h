/// How the program ends.
#pragma once

#include <string_view>

namespace weft::tools {

inline constexpr int kDone = 0;
inline constexpr int kCaseFailed = 1;       ///< a hard case, or a closed form
inline constexpr int kRefused = 2;          ///< something given was refused
inline constexpr int kMissedTolerance = 3;  ///< some step did not reach its tolerance

/// As shells have it: 130 for SIGINT (Ctrl-C).
constexpr int interrupted_by(int signal) { return 128 + signal; }

/// One line on stderr. Returns kRefused.
int refuse(std::string_view message);

/// One line on stderr, with where and how that was first. Returns kMissedTolerance.
int missed_tolerance(std::string_view where);

}  // namespace weft::tools
