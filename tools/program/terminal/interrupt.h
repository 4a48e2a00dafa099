/// SIGINT (Ctrl-C), SIGTERM, SIGHUP and SIGPIPE (nobody reads the output any more): nothing is left
/// half-written, and but for SIGPIPE nothing that was reached is lost.
#pragma once

namespace weft::tools {

/// A signal ends the program at once with 128 + its number: pending files are removed, and one line
/// says so. A file that grows beyond a limit is no signal, but fails to be written. Call it once,
/// before anything else.
void install_interrupt_handler();

/// While it lives, the first signal only asks for an end: whoever works frame by frame looks at
/// signal() between two frames. The second one ends the program at once.
class OrderlyInterrupt {
 public:
  OrderlyInterrupt();
  ~OrderlyInterrupt();
  OrderlyInterrupt(const OrderlyInterrupt&) = delete;
  OrderlyInterrupt& operator=(const OrderlyInterrupt&) = delete;

  static int signal();  ///< 0: none came
};

}  // namespace weft::tools
