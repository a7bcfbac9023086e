// Reports with random bytes.
#pragma once

#include "wiimote_tracker_driver/protocol/report.h"

#include <random>

namespace wiimote_tracker {

/// A report of that id and size whose other bytes are random.
class Noise {
 public:
  protocol::Report report(int id, std::size_t size) {
    protocol::Report result;
    for (std::uint8_t& byte : result.bytes)
      byte = static_cast<std::uint8_t>(random_());
    result.bytes[0] = static_cast<std::uint8_t>(id);
    result.size = size;
    return result;
  }

  unsigned below(unsigned values) { return static_cast<unsigned>(random_() % values); }

 private:
  std::mt19937 random_{1};
};

}  // namespace wiimote_tracker
